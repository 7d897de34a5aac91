// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/forces/force_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using data::IntervalKind;
using data::Measure;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kPlates_hz = 200.0;

/// A plate with z up: `load`, force along y, centre of pressure, white noise on forces and places.
template <class Load, class Along, class Place>
data::Wrench plate_of(std::int64_t frames, const Load& load, const Along& along, const Place& place,
                      double noise_n, double noise_m, std::uint64_t seed, std::string name = "plate 1") {
  Random random(seed, 0);
  data::Wrench out{.name = std::move(name)};
  for (std::int64_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / kPlates_hz;
    const Eigen::Vector2d x = place(t);
    const double push = load(t), draw[3] = {random.gaussian(), random.gaussian(), random.gaussian()};
    for (const double v : {noise_n * draw[0], along(t) + noise_n * draw[1], push + noise_n * draw[2]})
      out.force.push_back(v);
    for (int i = 0; i < 3; ++i) out.moment.push_back(0.0);
    for (const double v : {x.x() + noise_m * random.gaussian(), x.y() + noise_m * random.gaussian(), 0.0})
      out.point.push_back(v);
  }
  return out;
}

constexpr double kStep_s = 0.7;
double step_load(double t) {
  const double u = std::numbers::pi * (t - 0.5) / kStep_s;
  return u < 0.0 || u > std::numbers::pi ? 0.0 : 800.0 * std::sin(u) + 300.0 * std::sin(3.0 * u);
}
double step_along(double t) {
  const double u = 2.0 * std::numbers::pi * (t - 0.5) / kStep_s;
  return u < 0.0 || u > 2.0 * std::numbers::pi ? 0.0 : -120.0 * std::sin(u);
}

data::Wrenches walk(double noise_n, std::uint64_t seed) {
  return {.time = {.rate_hz = kPlates_hz, .frames = 400},
          .items = {plate_of(
              400, step_load, step_along, [](double t) { return Eigen::Vector2d(0.1, 0.3 * (t - 0.5)); },
              noise_n, 0.001, seed)}};
}

data::Wrenches stand(double noise_m, std::uint64_t seed) {
  const auto place = [](double t) {
    return Eigen::Vector2d(0.01 * std::cos(2.0 * std::numbers::pi * 0.5 * t),
                           0.005 * std::sin(2.0 * std::numbers::pi * 0.5 * t));
  };
  const auto half = [](double) { return 350.0; };
  const auto none = [](double) { return 0.0; };
  return {.time = {.rate_hz = kPlates_hz, .frames = 2032},
          .items = {plate_of(2032, half, none, place, 0.5, noise_m, seed),
                    plate_of(2032, half, none, place, 0.5, noise_m, seed + 1000, "plate 2")}};
}

const Measure& got(const ForceMeasures& out, const std::string& id) {
  static const Measure none{};
  for (const auto& m : out.measures)
    if (m.id == id) return m;
  ADD_FAILURE() << id << " is not there";
  return none;
}

TEST(ForceMeasures, DefinitionsAreUnique) {
  std::set<std::string_view> ids;
  for (const auto& definition : force_definitions()) {
    EXPECT_TRUE(ids.insert(definition.what.id).second);
    EXPECT_EQ(find_force_definition(definition.what.id), &definition);
  }
  EXPECT_EQ(find_force_definition("grf"), nullptr);
}

TEST(ForceMeasures, AStepByClosedForms) {
  const auto out = measure_forces(walk(0.0, 1), {.refits = 0}).value();
  const double s = std::sqrt(17.0 / 36.0), hump = 1700.0 * s - 1200.0 * s * s * s;
  EXPECT_NEAR(got(out, "grf_first_peak").value, hump, 3.0);
  EXPECT_NEAR(got(out, "grf_valley").value, 500.0, 3.0);
  EXPECT_NEAR(got(out, "grf_peak").value, hump, 3.0);
  // Integral of 800 sin u + 300 sin 3u over 0.7 s: 0.7 / pi (1600 + 200).
  EXPECT_NEAR(got(out, "grf_impulse").value, 0.7 / std::numbers::pi * 1800.0, 1.0);
  EXPECT_NEAR(got(out, "grf_braking_impulse").value, -120.0 * 0.7 / std::numbers::pi, 0.5);
  EXPECT_NEAR(got(out, "grf_propulsion_impulse").value, 120.0 * 0.7 / std::numbers::pi, 0.5);
  EXPECT_NEAR(got(out, "grf_contact_time").value, kStep_s, 0.011);
  EXPECT_EQ(got(out, "grf_peak").subject, "plate 1");
  EXPECT_EQ(got(out, "grf_peak").cycle, 0);
  EXPECT_TRUE(std::ranges::none_of(out.measures, [](const Measure& m) { return m.id == "cop_path"; }));
}

TEST(ForceMeasures, IntervalsOfAStepHoldTheTruth) {
  const double s = std::sqrt(17.0 / 36.0), hump = 1700.0 * s - 1200.0 * s * s * s;
  int peak = 0, impulse = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto out = measure_forces(walk(4.0, seed), {.refits = 39}).value();
    const auto &p = got(out, "grf_first_peak"), &i = got(out, "grf_impulse");
    ASSERT_EQ(p.interval.kind, IntervalKind::two_sided) << p.remark;
    peak += p.interval.low <= hump && hump <= p.interval.high;
    const double whole = 0.7 / std::numbers::pi * 1800.0;
    impulse += i.interval.low - 0.3 <= whole && whole <= i.interval.high + 0.3;  // below 20 N nothing counts
    EXPECT_TRUE(i.validate());
  }
  EXPECT_GE(peak, 6);
  EXPECT_GE(impulse, 6);
}

TEST(ForceMeasures, WhereNoisePutsTheEndsOfAContactIsInItsIntervals) {
  const auto truth = measure_forces(walk(0.0, 1), {.measures = {"grf_impulse"}, .refits = 0}).value();
  int inside = 0;
  constexpr int kTrials = 16;
  for (int k = 0; k < kTrials; ++k) {
    const auto out = measure_forces(walk(3.0, 70 + static_cast<std::uint64_t>(k)),
                                    {.measures = {"grf_impulse"}, .refits = 59})
                         .value();
    const auto& m = out.measures.at(0);
    ASSERT_EQ(m.interval.kind, IntervalKind::two_sided);
    inside += m.interval.low <= truth.measures.at(0).value && truth.measures.at(0).value <= m.interval.high;
  }
  EXPECT_GE(inside, 13);
}

TEST(ForceMeasures, TheFootIsThatOfThePlatesEvent) {
  const std::vector<data::GaitEvent> events{{.side = data::Side::right,
                                             .what = data::FootEvent::strike,
                                             .time_s = 0.51,
                                             .source = data::EventSource::plate,
                                             .method = "plate 1"}};
  const auto out = measure_forces(walk(0.0, 1), {.events = events, .refits = 0}).value();
  EXPECT_EQ(got(out, "grf_peak").context, "Right");
}

TEST(ForceMeasures, SwayByClosedFormsAndWithItsNoiseTakenOff) {
  const auto exact = measure_forces(stand(0.0, 1), {.refits = 0}).value();
  // Ten seconds are five turns of an ellipse of 10 and 5 mm: 48.44 mm each.
  EXPECT_NEAR(got(exact, "cop_path").value, 4.9975 * 0.04844, 5e-4);
  EXPECT_NEAR(got(exact, "cop_range_first").value, 0.02, 1e-5);
  EXPECT_NEAR(got(exact, "cop_range_second").value, 0.01, 1e-5);
  EXPECT_NEAR(got(exact, "cop_ellipse_area").value, 2.0 * std::numbers::pi * 3.0 * 0.5 * 0.01 * 0.005, 5e-6);
  const double truth = got(exact, "cop_path").value;
  const auto noisy = measure_forces(stand(0.0005, 2), {.refits = 39}).value();
  const auto& path = got(noisy, "cop_path");
  EXPECT_NEAR(path.value, truth, 0.02 * truth) << "of the raw path the noise makes three times as much";
  EXPECT_LE(path.interval.low, truth);
  EXPECT_GE(path.interval.high, truth);
  EXPECT_EQ(path.subject, "centre of pressure");
}

TEST(ForceMeasures, AStepThatIsWholeIsNotSaidToBeCut) {
  const auto notes = measure_forces(walk(0.0, 1), {}).value().notes;
  EXPECT_THAT(
      notes,
      Not(Contains(HasSubstr("cut by an end of the recording or of what is known of it, not measured"))));
}

TEST(ForceMeasures, WhatIsNotThereIsSaid) {
  auto cut = walk(0.0, 1);
  cut.time.frames = 180;  // within the step
  auto& plate = cut.items[0];
  for (auto* values : {&plate.force, &plate.moment, &plate.point}) values->resize(3 * 180);
  EXPECT_THAT(
      measure_forces(cut, {}).error().message,
      HasSubstr("plate 1: 1 step cut by an end of the recording or of what is known of it, not measured"));
  auto empty = walk(0.0, 1);
  std::ranges::fill(empty.items[0].force, 0.0);
  EXPECT_THAT(measure_forces(empty, {}).error().message, HasSubstr("nobody steps wholly on a plate"));
  const auto out =
      measure_forces(walk(0.0, 1), {.measures = {"grf_peak"},
                                    .regions = {{.name = "a", .first_frame = 0, .last_frame = 399}},
                                    .refits = 0})
          .value();
  ASSERT_EQ(out.measures.size(), 1u);
  EXPECT_EQ(out.measures[0].region, "a");
}

/// A step with that load whose centre of pressure runs at `speed`, m/s.
template <class Load>
ForceMeasures step_of(const Load& load, double speed, double noise_n, std::vector<std::string> measures,
                      std::int64_t refits = 0) {
  const data::Wrenches plates{
      .time = {.rate_hz = kPlates_hz, .frames = 400},
      .items = {plate_of(
          400, load, step_along, [=](double t) { return Eigen::Vector2d(0.1, speed * (t - 0.5)); }, noise_n,
          0.0, 3)}};
  return measure_forces(plates, {.measures = std::move(measures), .refits = refits}).value();
}

/// Two humps, the deeper the valley between them the larger `depth`.
auto humps(double depth) {
  return [=](double t) {
    const double u = std::numbers::pi * (t - 0.5) / kStep_s;
    return u < 0.0 || u > std::numbers::pi ? 0.0 : 800.0 * (std::sin(u) + depth * std::sin(3.0 * u));
  };
}

TEST(ForceMeasures, AStepWithoutAValueSaysWhy) {
  const std::vector<std::string> asked{"grf_braking_impulse", "grf_loading_rate", "grf_valley"};
  const auto block = [](double t) { return t < 0.5 || t > 1.2 ? 0.0 : 600.0; };
  const auto abrupt = step_of(block, 0.0, 0.0, asked);
  EXPECT_EQ(got(abrupt, "grf_braking_impulse").remark,
            "no direction of travel: the centre of pressure runs by less than 20 mm or is not known");
  EXPECT_EQ(got(abrupt, "grf_loading_rate").remark,
            "the load is above a fifth of its peak from the first frame on");
  EXPECT_EQ(got(step_of(humps(0.0), 0.3, 0.0, asked), "grf_valley").remark, "the load has no two humps");
  const auto good = step_of(step_load, 0.3, 0.0, asked);
  EXPECT_THAT(got(good, "grf_braking_impulse").remark, Not(HasSubstr("no direction of travel: the centre")));
  EXPECT_THAT(got(good, "grf_loading_rate").remark, Not(HasSubstr("the load is above a fifth of its peak")));
  EXPECT_THAT(got(good, "grf_valley").remark, Not(HasSubstr("the load has no two humps")));
}

/// Both plates' centres of pressure at one place.
data::Wrenches still() {
  auto out = stand(0.0, 1);
  for (auto& plate : out.items)
    for (std::size_t i = 0; i < plate.point.size(); ++i) plate.point[i] = i % 3 == 0 ? 0.25 : 0.0;
  return out;
}

TEST(ForceMeasures, SwayThatIsNoneHasNoFrequency) {
  const ForceMeasureOptions options{.measures = {"cop_mean_frequency"}, .refits = 0};
  EXPECT_EQ(got(measure_forces(still(), options).value(), "cop_mean_frequency").remark,
            "the centre of pressure does not move");
  EXPECT_THAT(got(measure_forces(stand(0.0, 1), options).value(), "cop_mean_frequency").remark,
              Not(HasSubstr("the centre of pressure does not move")));
}

TEST(ForceMeasures, ReasonsForNoIntervalAreThoseOfTheStep) {
  const std::vector<std::string> asked{"grf_valley"};
  EXPECT_EQ(got(step_of(step_load, 0.3, 4.0, asked), "grf_valley").remark, "no interval was asked for");
  EXPECT_EQ(got(measure_forces(still(), {.measures = {"cop_path"}, .refits = 39}).value(), "cop_path").remark,
            "no interval: the samples show no noise");
  const std::string noisy = got(step_of(step_load, 0.3, 4.0, asked, 39), "grf_valley").remark;
  EXPECT_THAT(noisy, Not(HasSubstr("no interval was asked for")));
  EXPECT_THAT(noisy, Not(HasSubstr("no interval: the samples show no noise")));
  EXPECT_THAT(noisy, Not(HasSubstr("too many of the refits do not determine it")));
  // Humps so low that noise makes them or takes them away.
  const std::string flat = got(step_of(humps(0.176), 0.3, 40.0, asked, 39), "grf_valley").remark;
  EXPECT_EQ(flat, "no interval: too many of the refits do not determine it");
}

}  // namespace
}  // namespace kinemark::analysis
