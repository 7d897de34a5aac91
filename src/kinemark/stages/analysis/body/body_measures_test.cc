// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/body_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/body/body_definitions.h"

namespace kinemark::analysis {
namespace {

using data::IntervalKind;
using data::Measure;
using data::Quantity;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kHertz = 100.0, kTurn = 2.0 * std::numbers::pi;
constexpr double kHip = 0.4, kKnee = 0.6, kFrequency = 1.0;

Status nothing(BodySeries&) { return {}; }

/// A hip and a knee that swing, the knee a quarter of a turn later, and a slide that drifts.
BodyRecord swinging(double sd, std::uint64_t seed, std::int64_t frames = 416) {
  BodyRecord record;
  record.time = {.rate_hz = kHertz, .frames = frames};
  record.names = {"hip_l", "knee_l", "slide"};
  record.is_rotation = {true, true, false};
  record.measured = {true, true, true};
  record.driven = {true, true, false};
  record.is_root = {false, false, true};
  record.mass_kg = 50.0;
  record.q.resize(frames, 3);
  record.determined = Eigen::MatrixX<bool>::Constant(frames, 3, true);
  record.torque_known = record.determined;
  Random random(seed, 0);
  for (std::int64_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / kHertz;
    record.q(f, 0) = 0.1 + kHip * std::cos(kTurn * kFrequency * t) + sd * random.gaussian();
    record.q(f, 1) = kKnee * std::cos(kTurn * (kFrequency * t - 0.25)) + sd * random.gaussian();
    record.q(f, 2) = 0.3 * t + 0.01 * sd * random.gaussian();
  }
  return record;
}

/// tau = 20 dq/dt: all work is positive.
Status damper(BodySeries& series) {
  series.tau = 20.0 * series.v;
  return {};
}

const Measure& find(const BodyMeasures& measures, const std::string& id, const std::string& subject,
                    const std::string& region = "") {
  static const Measure none{};
  for (const auto& m : measures.measures)
    if (m.id == id && m.subject == subject && m.region == region) return m;
  ADD_FAILURE() << id << " of " << subject << " is not there";
  return none;
}

TEST(BodyMeasures, DefinitionsAreUniqueAndSourced) {
  std::set<std::string_view> ids;
  for (const auto& definition : body_definitions()) {
    EXPECT_TRUE(ids.insert(definition.what.id).second) << definition.what.id;
    EXPECT_FALSE(definition.what.title.empty() || definition.what.formula.empty());
    EXPECT_EQ(find_body_definition(definition.what.id), &definition);
    EXPECT_TRUE(definition.formula != nullptr || definition.curve != nullptr) << definition.what.id;
  }
  EXPECT_EQ(find_body_definition("joint_rang"), nullptr);
}

TEST(BodyMeasures, ClosedFormsOfASwingWithoutNoise) {
  const auto record = swinging(0.0, 1);
  const auto out =
      measure_body(record, damper,
                   {.pairs = {{0, 1}}, .stretches = {{.name = "s", .first = 8, .count = 400}}, .refits = 0})
          .value();
  const double w = kTurn * kFrequency;
  EXPECT_NEAR(find(out, "joint_range", "hip_l", "s").value, 2.0 * kHip, 1e-3);
  EXPECT_NEAR(find(out, "joint_maximum", "hip_l", "s").value, 0.1 + kHip, 1e-3);
  EXPECT_NEAR(find(out, "joint_minimum", "hip_l", "s").value, 0.1 - kHip, 1e-3);
  EXPECT_NEAR(std::fmod(find(out, "joint_maximum_time", "hip_l", "s").value, 1.0), 0.92, 1e-9);
  EXPECT_NEAR(find(out, "joint_mean", "hip_l", "s").value, 0.1, 1e-6);
  EXPECT_NEAR(find(out, "joint_peak_velocity", "knee_l", "s").value, kKnee * w, 2e-3 * kKnee * w);
  EXPECT_NEAR(find(out, "joint_peak_acceleration", "knee_l", "s").value, kKnee * w * w, 2e-3 * kKnee * w * w);
  EXPECT_NEAR(find(out, "joint_range", "slide", "s").value, 0.3 * 3.99, 1e-9);
  EXPECT_EQ(find(out, "joint_range", "slide", "s").quantity, Quantity::length);
  EXPECT_EQ(find(out, "joint_peak_velocity", "slide", "s").quantity, Quantity::speed);
  // 20 v^2 over 3.99 s of a mean of 20 (0.4 w)^2 / 2.
  const double mean = 10.0 * kHip * kHip * w * w;
  EXPECT_NEAR(find(out, "joint_work_positive", "hip_l", "s").value, 4.0 * mean, 0.01 * mean * 4.0);
  EXPECT_NEAR(find(out, "joint_work_negative", "hip_l", "s").value, 0.0, 1e-12);
  EXPECT_NEAR(find(out, "joint_work_net", "hip_l", "s").value,
              find(out, "joint_work_positive", "hip_l", "s").value, 1e-9);
  EXPECT_NEAR(find(out, "joint_power_maximum", "hip_l", "s").value, 20.0 * kHip * kHip * w * w, 0.1);
  EXPECT_NEAR(find(out, "relative_phase", "hip_l and knee_l", "s").value, kTurn / 4.0, 0.01);
  EXPECT_NEAR(find(out, "phase_locking", "hip_l and knee_l", "s").value, 1.0, 1e-4);
  EXPECT_NEAR(find(out, "coupling_lag", "hip_l and knee_l", "s").value, 0.25, 5e-3);
  EXPECT_TRUE(std::ranges::none_of(out.measures, [](const Measure& m) {
    return m.id == "joint_work_net" && m.subject == "slide";
  })) << "what pushes a root is no joint's torque";
  for (const auto& m : out.measures) EXPECT_TRUE(m.validate()) << m.id;
}

TEST(BodyMeasures, NoiseIsTakenOffAndTheIntervalHoldsTheTruth) {
  const double sd = 0.02;
  const double peak = kKnee * kTurn * kFrequency;
  int range_in = 0, peak_in = 0;
  double bias = 0.0, raw = 0.0;
  constexpr int kTrials = 8;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto record = swinging(sd, 100 + static_cast<std::uint64_t>(trial));
    const auto out =
        measure_body(record, nothing, {.measures = {"joint_range", "joint_peak_velocity"}, .refits = 39})
            .value();
    const auto& range = find(out, "joint_range", "knee_l");
    const auto& speed = find(out, "joint_peak_velocity", "knee_l");
    ASSERT_EQ(range.interval.kind, IntervalKind::two_sided) << range.remark;
    range_in += range.interval.low <= 2.0 * kKnee && 2.0 * kKnee <= range.interval.high;
    peak_in += speed.interval.low <= peak && peak <= speed.interval.high;
    bias += (range.value - 2.0 * kKnee) / kTrials;
    raw += (record.q.col(1).maxCoeff() - record.q.col(1).minCoeff() - 2.0 * kKnee) / kTrials;
    EXPECT_THAT(range.method, HasSubstr("39 refits"));
  }
  EXPECT_GE(range_in, 6);
  EXPECT_GE(peak_in, 6);
  EXPECT_LT(std::abs(bias), 0.2 * raw);
}

TEST(BodyMeasures, TheSameSeedGivesTheSameBitsForAnyNumberOfThreads) {
  const auto record = swinging(0.02, 3);
  const BodyMeasureOptions one{.measures = {"joint_range"}, .refits = 39};
  auto two = one;
  two.threads = 2;
  const auto a = measure_body(record, nothing, one).value(), b = measure_body(record, nothing, two).value();
  for (std::size_t i = 0; i < a.measures.size(); ++i)
    EXPECT_EQ(a.measures[i].interval.low, b.measures[i].interval.low);
}

TEST(BodyMeasures, AStatedDeviationWidensTheInterval) {
  auto record = swinging(0.005, 3);
  const BodyMeasureOptions options{.measures = {"joint_maximum"}, .coordinates = {1}, .refits = 59};
  const auto alone = measure_body(record, nothing, options).value();
  record.q_sd = Eigen::MatrixXd::Constant(416, 3, 0.05);
  const auto stated = measure_body(record, nothing, options).value();
  ASSERT_EQ(stated.measures.size(), 1u);
  EXPECT_GT(stated.measures[0].sd, 4.0 * alone.measures[0].sd);
  record.q_sd.setConstant(0.001);
  EXPECT_THAT(measure_body(record, nothing, options).value().notes,
              Contains(HasSubstr("more than 15 % more from each other than their deviations tell")));
}

TEST(BodyMeasures, WhatIsNotDeterminedIsNotSaid) {
  auto record = swinging(0.01, 5);
  for (int f = 100; f < 150; ++f) record.determined(f, 0) = false;
  for (int f = 120; f < 130; ++f) record.torque_known(f, 1) = false;
  for (int f = 0; f < 416; ++f) record.determined(f, 2) = f < 10;
  const auto out =
      measure_body(record, damper,
                   {.measures = {"joint_range", "joint_work_net"},
                    .stretches = {{.name = "all", .count = 416}, {.name = "gap", .first = 105, .count = 30}},
                    .refits = 39})
          .value();
  EXPECT_THAT(
      out.notes,
      Contains(HasSubstr("fewer than 30 of their samples are determined or no smoother fits them: slide")));
  const auto& range = find(out, "joint_range", "hip_l", "all");
  EXPECT_TRUE(std::isfinite(range.value));
  EXPECT_EQ(range.interval.kind, IntervalKind::none);
  EXPECT_THAT(range.remark, HasSubstr("what happened in 0.5 s without data is not known"));
  EXPECT_NEAR(range.share_not_measured, 50.0 / 400.0, 1e-9);
  EXPECT_TRUE(std::isnan(find(out, "joint_range", "hip_l", "gap").value));
  EXPECT_EQ(find(out, "joint_range", "hip_l", "gap").remark, "nothing fixes it in this span");
  EXPECT_THAT(find(out, "joint_work_net", "knee_l", "all").remark,
              HasSubstr("the torque is not determined in 3 % of the span"));
  EXPECT_EQ(find(out, "joint_range", "knee_l", "all").interval.kind, IntervalKind::two_sided);
}

TEST(BodyMeasures, WithoutAnyErrorThereIsNoInterval) {
  auto record = swinging(0.0, 5);
  for (int f = 0; f < 416; ++f) record.q(f, 2) = 0.25 * f;
  const auto out =
      measure_body(record, nothing, {.measures = {"joint_range"}, .coordinates = {2}, .refits = 39}).value();
  EXPECT_THAT(out.measures.at(0).remark, HasSubstr("no deviation is stated, and the samples show no noise"));
  auto still = swinging(0.01, 5);
  Random random(8, 0);
  for (int f = 0; f < 416; ++f) still.q(f, 0) = 0.01 * random.gaussian();
  const auto noise =
      measure_body(still, nothing, {.measures = {"joint_range"}, .coordinates = {0}, .refits = 39}).value();
  EXPECT_THAT(noise.measures.at(0).remark, HasSubstr("it moves by less than half of its errors"));
}

TEST(BodyMeasures, ReasonsAreSaidWhereTheyAreSoAlone) {
  const auto record = swinging(0.01, 5);
  const auto plain = measure_body(record, nothing, {.measures = {"joint_range"}, .refits = 0}).value();
  EXPECT_THAT(find(plain, "joint_range", "hip_l").remark, HasSubstr("no interval was asked for"));
  const auto out =
      measure_body(record, damper,
                   {.measures = {"joint_range", "joint_work_net", "joint_maximum_time"}, .refits = 39})
          .value();
  for (const auto& note : out.notes) {
    EXPECT_THAT(note, Not(HasSubstr("fewer than 30 of their samples are determined")));
    EXPECT_THAT(note, Not(HasSubstr("more than 15 % more from each other than their deviations tell")));
  }
  for (const std::string id : {"joint_range", "joint_work_net"}) {
    const auto& m = find(out, id, "hip_l");
    EXPECT_THAT(m.remark, Not(HasSubstr("no interval was asked for"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("nothing fixes it in this span"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("the torque is not determined in"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("the torque is not known throughout"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("s without data is not known"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("no interval: no deviation is stated"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("it moves by less than half of its errors"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("no interval: too many of the refits do not determine it"))) << id;
    EXPECT_THAT(m.remark, Not(HasSubstr("the interval is too wide to support a claim"))) << id;
  }
}

TEST(BodyMeasures, AnInstantHasAnIntervalWhereItStandsOut) {
  const auto record = swinging(0.01, 5);
  const auto out = measure_body(record, nothing,
                                {.measures = {"joint_maximum_time"},
                                 .stretches = {{.name = "cycles", .first = 10, .count = 400},
                                               {.name = "one", .first = 60, .count = 80},
                                               {.name = "rise", .first = 110, .count = 40}},
                                 .refits = 39})
                       .value();
  const auto& many = find(out, "joint_maximum_time", "knee_l", "cycles");
  EXPECT_EQ(many.interval.kind, IntervalKind::none);
  EXPECT_THAT(many.remark, HasSubstr("other instants are nearly as extreme")) << "each cycle has its peak";
  const auto& one = find(out, "joint_maximum_time", "knee_l", "one");
  EXPECT_EQ(one.interval.kind, IntervalKind::two_sided) << one.remark;
  EXPECT_THAT(one.remark, Not(HasSubstr("other instants are nearly as extreme")));
  EXPECT_THAT(one.remark, Not(HasSubstr("it is at an end of the span")));
  const auto& slide = find(out, "joint_maximum_time", "slide", "cycles");
  EXPECT_THAT(slide.remark, HasSubstr("it is at an end of the span")) << "it only ever rises";
}

TEST(BodyMeasures, ATimeOnAPlateauIsNotGiven) {
  auto record = swinging(0.0, 5);
  Random random(23, 0);
  for (int f = 0; f < 416; ++f) {
    const double t = std::clamp(f / kHertz - 2.2, 0.0, 0.8);
    record.q(f, 1) = 0.5 * t * t * (2.4 - 2.0 * t) + 0.01 * random.gaussian();
  }
  const auto out =
      measure_body(record, nothing, {.measures = {"joint_maximum_time"}, .coordinates = {1}, .refits = 39})
          .value();
  EXPECT_EQ(out.measures.at(0).interval.kind, IntervalKind::none);
  EXPECT_THAT(out.measures[0].remark, HasSubstr("other instants are nearly as extreme"));
}

TEST(BodyMeasures, ALagHasAnIntervalWhereNoOtherIsAsGood) {
  const BodyMeasureOptions options{.measures = {"coupling_lag"}, .pairs = {{0, 1}}, .refits = 39};
  auto record = swinging(0.005, 5);
  for (int f = 0; f < 416; ++f) {  // single movements, that of the knee 0.1 s later
    const auto move = [](double t) { return 0.5 * std::tanh(4.0 * (t - 2.0)); };
    record.q(f, 0) += move(f / kHertz) - kHip * std::cos(kTurn * kFrequency * f / kHertz);
    record.q(f, 1) = 0.01 * (record.q(f, 1) - 0.5) + move(f / kHertz - 0.1);
  }
  const auto out = measure_body(record, nothing, options).value();
  EXPECT_TRUE(std::isfinite(out.measures.at(0).value));
  auto skin = swinging(0.005, 5);
  skin.q_sd = Eigen::MatrixXd::Constant(416, 3, 0.1);
  const auto rival = measure_body(skin, nothing, options).value();
  EXPECT_EQ(rival.measures.at(0).interval.kind, IntervalKind::none) << "half a turn away it is as good";
}

TEST(BodyMeasures, TheRangeOfACoordinateThatRestsForAWhileHasBothEnds) {
  int inside = 0;
  constexpr int kTrials = 10;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto record = swinging(0.0, 5);
    Random random(21 + static_cast<std::uint64_t>(trial), 0);
    for (int f = 0; f < 416; ++f) {
      const double t = std::clamp(f / kHertz - 1.5, 0.0, 1.0);
      record.q(f, 1) = 0.5 * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t) + 0.01 * random.gaussian();
    }
    const BodyMeasureOptions options{.measures = {"joint_range"}, .coordinates = {1}, .refits = 39};
    const auto out = measure_body(record, nothing, options).value();
    ASSERT_EQ(out.measures.at(0).interval.kind, IntervalKind::two_sided);
    inside += out.measures[0].interval.low <= 0.5 && 0.5 <= out.measures[0].interval.high;
  }
  EXPECT_GE(inside, 8);
}

TEST(BodyMeasures, APairOneOfWhichRestsHasNoPhase) {
  auto record = swinging(0.0, 5);
  record.q.col(1).setConstant(0.3);
  const BodyMeasureOptions options{.measures = {"relative_phase"}, .pairs = {{0, 1}}, .refits = 0};
  const auto still = measure_body(record, nothing, options).value();
  EXPECT_THAT(still.measures.at(0).remark, HasSubstr("one of the two does not move"));
  const auto moving = measure_body(swinging(0.0, 5), nothing, options).value();
  EXPECT_THAT(moving.measures.at(0).remark, Not(HasSubstr("one of the two does not move")));
}

TEST(BodyMeasures, OnlyWhatWasSmoothedIsSaidToBe) {
  const BodyMeasureOptions options{.measures = {"relative_phase"}, .pairs = {{0, 1}}, .refits = 0};
  EXPECT_EQ(measure_body(swinging(0.01, 5), nothing, options).value().measures.at(0).method,
            "each coordinate smoothed by itself");
  EXPECT_THAT(measure_body(swinging(0.0, 5), nothing, options).value().measures.at(0).method,
              Not(HasSubstr("each coordinate smoothed by itself")));
}

TEST(BodyMeasures, AWorkThatComesAndGoesIsTooWideAClaim) {
  const auto spring = [](BodySeries& series) -> Status {
    series.tau = -20.0 * series.q;
    return {};
  };
  const auto out = measure_body(swinging(0.01, 5), spring,
                                {.measures = {"joint_work_net"}, .coordinates = {0}, .refits = 39})
                       .value();
  EXPECT_THAT(out.measures.at(0).remark, HasSubstr("the interval is too wide to support a claim"));
}

TEST(BodyMeasures, NoIntervalWhereRefitsDoNotDetermineIt) {
  int calls = 0;
  const auto tires = [&calls](BodySeries&) -> Status {
    if (++calls > 20) return fail(Code::bad_input, "no more");
    return {};
  };
  const auto out = measure_body(swinging(0.01, 5), tires,
                                {.measures = {"joint_range"}, .coordinates = {0}, .refits = 39, .threads = 1})
                       .value();
  EXPECT_EQ(out.measures.at(0).remark, "no interval: too many of the refits do not determine it");
  EXPECT_EQ(out.measures.at(0).interval.kind, IntervalKind::none);
}

/// A mass centre 1 m above feet that rest, which travels along x; `feet` and its momentum may be unknown.
Mechanics upright(double speed, bool feet = true, bool momentum = true) {
  return [=](BodySeries& series) -> Status {
    const auto frames = series.q.rows();
    series.centre.setZero(frames, 3);
    series.centre.col(1).setOnes();
    series.centre_velocity.setZero(frames, 3);
    series.centre_velocity.col(0).setConstant(speed);
    if (momentum) series.momentum = Eigen::VectorXd::LinSpaced(frames, 0.0, 1.0).replicate(1, 3);
    if (feet)
      for (auto& outline : series.outline) outline.assign(1, Eigen::MatrixX3d::Zero(frames, 3));
    return {};
  };
}

TEST(BodyMeasures, ALateralMarginNeedsAWalkerAndAFootThatStands) {
  const BodyMeasureOptions options{.measures = {"margin_lateral"}, .refits = 0};
  const auto record = swinging(0.01, 5);
  const auto rests = measure_body(record, upright(0.0), options).value();
  ASSERT_EQ(rests.measures.size(), 2U);
  EXPECT_EQ(rests.measures[0].remark, "the foot does not stand, or the body does not travel at 0.2 m/s");
  const auto walks = measure_body(record, upright(1.0), options).value();
  EXPECT_TRUE(std::isfinite(walks.measures.at(0).value));
  EXPECT_THAT(walks.measures[0].remark, Not(HasSubstr("the foot does not stand, or the body does not")));
}

TEST(BodyMeasures, AMomentumIsComparedWithWhatIsKnown) {
  const BodyMeasureOptions options{.measures = {"angular_momentum_range_x"}, .normalized = true, .refits = 0};
  const auto record = swinging(0.01, 5);
  const auto airborne = measure_body(record, upright(1.0, false), options).value();
  EXPECT_EQ(airborne.measures.at(0).remark, "what it is compared with is not known");
  const auto whole = measure_body(record, upright(1.0), options).value();
  EXPECT_TRUE(std::isfinite(whole.measures.at(0).value));
  EXPECT_THAT(whole.measures[0].remark, Not(HasSubstr("the motion of the mass centre is not known")));
  const auto unknown = measure_body(record, upright(1.0, true, false), options).value();
  EXPECT_EQ(unknown.measures.at(0).remark, "the motion of the mass centre is not known throughout");
  EXPECT_THAT(unknown.measures[0].remark, Not(HasSubstr("what it is compared with is not known")));
}

TEST(BodyMeasures, WhatMovesTheBodyUnseenIsNamed) {
  const BodyMeasureOptions options{.measures = {"com_speed"}, .refits = 0};
  auto record = swinging(0.01, 5);
  EXPECT_THAT(measure_body(record, upright(1.0), options).value().measures.at(0).remark,
              Not(HasSubstr("held where nothing fixes them: ")));
  for (int f = 100; f < 150; ++f) record.determined(f, 1) = false;
  EXPECT_THAT(measure_body(record, upright(1.0), options).value().measures.at(0).remark,
              HasSubstr("held where nothing fixes them: knee_l"));
}

TEST(BodyMeasures, KineticsPerMass) {
  const auto record = swinging(0.0, 1);
  const BodyMeasureOptions plain{
      .measures = {"joint_work_net", "joint_moment_maximum"}, .coordinates = {0}, .refits = 0};
  auto per_mass = plain;
  per_mass.normalized = true;
  const auto a = measure_body(record, damper, plain).value(),
             b = measure_body(record, damper, per_mass).value();
  EXPECT_NEAR(a.measures[0].value, 50.0 * b.measures[0].value, 1e-9);
  EXPECT_EQ(b.measures[0].quantity, Quantity::moment_per_mass);
  EXPECT_EQ(b.measures[1].quantity, Quantity::energy_per_mass);
}

TEST(BodyMeasures, CyclesOfOneSideAreOfItsCoordinates) {
  const auto record = swinging(0.01, 2);
  const auto out =
      measure_body(record, nothing,
                   {.measures = {"joint_range"},
                    .stretches = {{.name = "R 1", .context = "Right", .cycle = 0, .first = 50, .count = 100},
                                  {.name = "L 1", .context = "Left", .cycle = 0, .first = 100, .count = 100}},
                    .refits = 0})
          .value();
  ASSERT_EQ(out.measures.size(), 4u);
  EXPECT_EQ(out.measures[0].subject, "slide");
  EXPECT_EQ(find(out, "joint_range", "hip_l", "L 1").context, "Left");
  EXPECT_EQ(find(out, "joint_range", "hip_l", "L 1").cycle, 0);
}

TEST(BodyMeasures, RefusesWhatCannotBeMeasured) {
  const auto record = swinging(0.01, 2);
  EXPECT_THAT(measure_body(record, nothing, {.measures = {"joint_rang"}}).error().message,
              HasSubstr("there is no measure 'joint_rang'"));
  EXPECT_THAT(measure_body(record, nothing, {.measures = {"phase_locking"}}).error().message,
              HasSubstr("name them with --couple A,B"));
  EXPECT_EQ(measure_body(record, nothing, {.refits = 10}).error().code, Code::usage);
  EXPECT_THAT(measure_body(record, nothing, {.refits = 99, .level = 0.99}).error().message,
              HasSubstr("at least 199 for intervals of level 0.99"));
  EXPECT_EQ(measure_body(record, nothing, {.level = 1.0}).error().code, Code::usage);
  EXPECT_THAT(
      measure_body(record, nothing, {.stretches = {{.name = "x", .first = 0, .count = 9}}}).error().message,
      HasSubstr("span 'x' has fewer than 5 frames"));
  EXPECT_THAT(measure_body(swinging(0.01, 2, 20), nothing, {}).error().message,
              HasSubstr("the motion has 20 frames; 30 or more are needed"));
  auto locked = record;
  locked.measured.assign(3, false);
  EXPECT_THAT(measure_body(locked, nothing, {}).error().message, HasSubstr("no coordinate is free to move"));
  const auto failing = [](BodySeries&) -> Status { return fail(Code::bad_input, "no mass"); };
  EXPECT_EQ(measure_body(record, failing, {}).error().message, "no mass");
}

TEST(BodyMeasures, SidesOfNames) {
  EXPECT_EQ(side_of_name("knee_angle_r"), "Right");
  EXPECT_EQ(side_of_name("hip_flexion_l"), "Left");
  EXPECT_EQ(side_of_name("pelvis_tilt"), "");
}

}  // namespace
}  // namespace kinemark::analysis
