// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/segment_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/segments/testing/formulas.h"

namespace kinemark::analysis {
namespace {

using analysis::testing::of;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;
using State = data::SampleState;

// Two segments of three markers each, P1 to P3 and C1 to C3; the child's origin C1 is a point of the result.
SegmentDefinition two_segments() {
  SegmentDefinition d;
  const auto segment = [&](const std::string& name, const std::string& m) {
    d.segments.push_back({.name = name,
                          .origin = of(m + "1"),
                          .first = 2,
                          .first_along = of(m + "2 - " + m + "1"),
                          .second = 0,
                          .second_along = of(m + "3 - " + m + "1")});
  };
  segment("parent", "P");
  segment("child", "C");
  d.angles.push_back({.name = "joint",
                      .parent = "parent",
                      .child = "child",
                      .sequence = {1, 0, 2},
                      .components = {{{"flexion", 0}, {"adduction", 1, -1.0}, {"rotation", 2}}}});
  d.angles.push_back({.name = "turn",
                      .parent = "parent",
                      .child = "child",
                      .helical = true,
                      .components = {{{"x", 0}, {"y", 1}, {"z", 2}}}});
  d.values.push_back(
      {.name = "reach", .quantity = SubjectQuantity::length, .formula = of("distance(P1, C1)")});
  d.points.push_back({.name = "middle", .formula = of("mean(P1, C1)"), .written = true});
  return d;
}

Matrix3d about(const Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Vector3d angles_at(std::int64_t f) {
  const double t = 0.1 * static_cast<double>(f);
  return {0.5 + 0.6 * std::sin(t), 0.3 * std::cos(t), 0.2 * std::sin(2.0 * t)};
}
Matrix3d rotation_at(std::int64_t f) {
  const Vector3d a = angles_at(f);
  return about(Vector3d::UnitY(), a[0]) * about(Vector3d::UnitX(), a[1]) * about(Vector3d::UnitZ(), a[2]);
}

// A parent that tumbles and a child that hangs on it.
data::Trajectories movement(std::int64_t frames) {
  auto out = data::Trajectories::all_missing({"Ann:P1", "Ann:P2", "Ann:P3", "Ann:C1", "Ann:C2", "Ann:C3"},
                                             {.rate_hz = 100.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f) {
    const Matrix3d parent = about(Vector3d(1, 2, 3).normalized(), 0.05 * static_cast<double>(f));
    const Vector3d at(0.01 * static_cast<double>(f), 1.0, 0.5);
    const Matrix3d child = parent * rotation_at(f);
    const Vector3d hangs = at - parent * Vector3d(0, 0, 0.4);
    const std::array<Vector3d, 6> x{
        at,    at + parent * Vector3d(0, 0, 0.3),   at + parent * Vector3d(0.2, 0, 0.1),
        hangs, hangs + child * Vector3d(0, 0, 0.3), hangs + child * Vector3d(0.2, 0, 0.1)};
    for (std::int64_t m = 0; m < 6; ++m) {
      out.x(f, m) = x[static_cast<std::size_t>(m)];
      out.state[out.index(f, m)] = State::measured;
    }
  }
  return out;
}

TEST(SegmentMotion, GivesTheAnglesThatMadeTheMovement) {
  const auto markers = movement(60);
  const auto motion = compute_segments(two_segments(), {.markers = &markers});
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_TRUE(motion->warnings.empty());
  ASSERT_EQ(motion->angles.size(), 2U);
  for (std::int64_t f = 0; f < 60; ++f) {
    const auto i = static_cast<std::size_t>(3 * f);
    const Vector3d truth = angles_at(f);
    EXPECT_NEAR(motion->angles[0].value[i], truth[0], 1e-9);
    EXPECT_NEAR(motion->angles[0].value[i + 1], -truth[1], 1e-9);
    EXPECT_NEAR(motion->angles[0].value[i + 2], truth[2], 1e-9);
    const Eigen::AngleAxisd turn(rotation_at(f));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(motion->angles[1].value[i + static_cast<std::size_t>(k)], turn.angle() * turn.axis()[k],
                  1e-9);
    EXPECT_NEAR(motion->values[0].value[static_cast<std::size_t>(f)], 0.4, 1e-9);
    EXPECT_LT((motion->points.x(f, 0) - 0.5 * (markers.x(f, 0) + markers.x(f, 3))).norm(), 1e-12);
    EXPECT_EQ(motion->points.state[motion->points.index(f, 0)], State::model_filled);
  }
  EXPECT_TRUE(motion->points.validate());
}

TEST(SegmentMotion, MissesWhatNeedsAMissingMarker) {
  auto markers = movement(20);
  markers.set_missing(5, 4);
  markers.state[markers.index(6, 5)] = State::interpolated;
  markers.set_missing(7, 0);
  const auto motion = compute_segments(two_segments(), {.markers = &markers});
  ASSERT_TRUE(motion);
  const auto& joint = motion->angles[0];
  EXPECT_EQ(joint.state[4], State::measured);
  EXPECT_EQ(joint.state[5], State::missing);
  EXPECT_TRUE(std::isnan(joint.value[15]) && std::isnan(joint.sd[15]));
  EXPECT_EQ(joint.state[6], State::interpolated);
  EXPECT_TRUE(std::isfinite(joint.value[18]));
  EXPECT_TRUE(std::isfinite(motion->values[0].value[5])) << "the marker is not needed";
  EXPECT_FALSE(motion->points.present(7, 0));
}

TEST(SegmentMotion, SaysWhatItLacksAndComputesTheRest) {
  auto markers = movement(10);
  markers.names[4] = "Ann:CC2";
  const auto motion = compute_segments(two_segments(), {.markers = &markers});
  ASSERT_TRUE(motion);
  EXPECT_TRUE(motion->angles.empty());
  EXPECT_EQ(motion->values.size(), 1U);
  EXPECT_THAT(motion->warnings, Contains(HasSubstr("Not computed: joint, turn; there is no marker 'C2'")));
  markers = movement(1);
  markers.names[4] = "C2";
  markers.set_missing(0, 4);
  EXPECT_THAT(compute_segments(two_segments(), {.markers = &markers})->warnings,
              Contains(HasSubstr("joint, turn; there is no sample of marker 'C2'.")));
  markers.names = {"a", "b", "c", "d", "e", "f"};
  const auto none = compute_segments(two_segments(), {.markers = &markers});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_THAT(none.error().message, HasSubstr("nothing can be computed: Not computed: "));
}

TEST(SegmentMotion, HasTheDeviationsThatNoiseMakes) {
  constexpr double sd = 0.002;
  constexpr std::int64_t frames = 2000;
  const auto clean = movement(1);
  auto noisy = data::Trajectories::all_missing(clean.names, {.rate_hz = 100.0, .frames = frames});
  Random random(31, 1);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      noisy.x(f, m) = clean.x(0, m) + sd * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
      noisy.state[noisy.index(f, m)] = State::measured;
    }
  auto d = two_segments();
  d.points.push_back({.name = "centre", .formula = of("chord(C3, C2, P1, 0.06)"), .written = true});
  const auto truth = compute_segments(d, {.markers = &clean}, {.noise_sd_m = sd});
  const auto motion = compute_segments(d, {.markers = &noisy}, {.noise_sd_m = sd});
  ASSERT_TRUE(truth && motion);
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t k = 0; k < 3; ++k) {
      double squares = 0.0, stated = 0.0;
      for (std::size_t i = k; i < motion->angles[a].value.size(); i += 3) {
        squares += std::pow(motion->angles[a].value[i] - truth->angles[a].value[k], 2);
        stated += std::pow(motion->angles[a].sd[i], 2);
      }
      EXPECT_NEAR(std::sqrt(squares / stated), 1.0, 0.05) << a << k;
    }
  for (std::int64_t p = 0; p < motion->points.markers(); ++p) {
    double squares = 0.0, stated = 0.0;
    for (std::int64_t f = 0; f < frames; ++f) {
      squares += (motion->points.x(f, p) - truth->points.x(0, p)).squaredNorm();
      const double* c = &motion->points.covariance[6 * motion->points.index(f, p)];
      stated += c[0] + c[3] + c[5];
    }
    EXPECT_NEAR(std::sqrt(squares / stated), 1.0, 0.05) << motion->points.names[static_cast<std::size_t>(p)];
  }
}

// Noise of neighbouring samples alike has next to nothing in their differences.
TEST(SegmentMotion, NoiseThatIsCorrelatedIsInTheDeviations) {
  constexpr std::int64_t frames = 600;
  const auto clean = movement(frames);
  auto noisy = clean;
  Random random(33, 1);
  constexpr double sd = 0.001, rho = 0.8;
  for (std::int64_t m = 0; m < 6; ++m) {
    Vector3d e = Vector3d::Zero();
    for (std::int64_t f = 0; f < frames; ++f) {
      e = rho * e +
          std::sqrt(1.0 - rho * rho) * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
      noisy.x(f, m) += sd * e;
    }
  }
  const auto truth = compute_segments(two_segments(), {.markers = &clean}, {.deviations = false});
  const auto motion = compute_segments(two_segments(), {.markers = &noisy});
  ASSERT_TRUE(truth && motion);
  ASSERT_TRUE(motion->noise);
  EXPECT_FALSE(truth->noise);
  double squares = 0.0, stated = 0.0;
  for (std::size_t i = 0; i < motion->angles[0].value.size(); ++i) {
    squares += std::pow(motion->angles[0].value[i] - truth->angles[0].value[i], 2);
    stated += std::pow(motion->angles[0].sd[i], 2);
  }
  EXPECT_NEAR(std::sqrt(stated / squares), 1.0, 0.25);
  const auto handed = compute_segments(two_segments(), {.markers = &noisy, .noise = &*motion->noise});
  ASSERT_TRUE(handed);
  EXPECT_EQ(handed->angles[0].sd[300], motion->angles[0].sd[300]);
}

TEST(SegmentMotion, TakesTheMarkersCovarianceOrFindsTheirNoise) {
  auto markers = movement(300);
  Random random(32, 1);
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t m = 0; m < 6; ++m)
      markers.x(f, m) += 0.001 * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
  const auto rms = [](const Array<double>& sd) {
    double squares = 0.0;
    for (const double s : sd) squares += s * s;
    return std::sqrt(squares / static_cast<double>(sd.size()));
  };
  const auto given = compute_segments(two_segments(), {.markers = &markers}, {.noise_sd_m = 0.001});
  const auto found = compute_segments(two_segments(), {.markers = &markers});
  markers.covariance.assign(6 * markers.state.size(), 0.0);
  for (std::size_t i = 0; i < markers.state.size(); ++i)
    for (const std::size_t k : {0U, 3U, 5U}) markers.covariance[6 * i + k] = 1e-6;
  const auto carried = compute_segments(two_segments(), {.markers = &markers});
  const double truth = rms(given->angles[0].sd);
  EXPECT_NEAR(rms(found->angles[0].sd) / truth, 1.0, 0.1);
  EXPECT_NEAR(rms(carried->angles[0].sd) / truth, 1.0, 1e-9);
}

TEST(SegmentMotion, HoldsALandmarkOfAnotherTrialAndMeasuresInTheStaticOne) {
  auto d = two_segments();
  d.landmarks.push_back(
      {.name = "epicondyle", .segment = "child", .formula = of("TIP"), .trial = "pointer", .written = true});
  d.parameters.push_back(
      {.name = "zero", .quantity = SubjectQuantity::angle, .measured = of("y(cardan_yxz(parent, child))")});
  d.values.push_back({.name = "from_zero",
                      .quantity = SubjectQuantity::angle,
                      .formula = of("y(cardan_yxz(parent, child)) - zero")});
  auto shown = movement(5);
  shown.names.emplace_back("TIP");
  auto pointer = data::Trajectories::all_missing(shown.names, shown.time);
  for (std::int64_t f = 0; f < 5; ++f) {
    for (std::int64_t m = 0; m < 6; ++m) pointer.x(f, m) = movement(5).x(f, m);
    const Vector3d z = (pointer.x(f, 4) - pointer.x(f, 3)).normalized();
    pointer.x(f, 6) = pointer.x(f, 3) + 0.05 * z;
    for (std::int64_t m = 0; m < 7; ++m) pointer.state[pointer.index(f, m)] = State::measured;
  }
  const auto markers = movement(30);
  const auto still = movement(1);
  const auto motion =
      compute_segments(d, {.markers = &markers, .static_trial = &still, .trials = {{"pointer", &pointer}}});
  ASSERT_TRUE(motion) << motion.error().message;
  const auto p = motion->points.find("epicondyle");
  ASSERT_GE(p, 0);
  for (std::int64_t f = 0; f < 30; ++f) {
    const Vector3d z = (markers.x(f, 4) - markers.x(f, 3)).normalized();
    EXPECT_LT((motion->points.x(f, p) - markers.x(f, 3) - 0.05 * z).norm(), 1e-9);
    EXPECT_NEAR(motion->values[1].value[static_cast<std::size_t>(f)], angles_at(f)[0] - angles_at(0)[0],
                1e-9);
  }
  EXPECT_THAT(motion->warnings, ::testing::Each(::testing::Not(HasSubstr("' of the trial '"))));
  EXPECT_THAT(motion->warnings, ::testing::Each(::testing::Not(HasSubstr("Not computed:"))));
  const auto without = compute_segments(d, {.markers = &markers});
  EXPECT_THAT(without->warnings, Contains(HasSubstr("no landmark 'epicondyle' of the trial 'pointer'")));
  EXPECT_THAT(without->warnings, Contains(HasSubstr("from_zero; there is no value of 'zero'")));
}

TEST(SegmentMotion, ChoosesTheFirstValueOfAParameter) {
  SegmentDefinition d;
  d.parameters.push_back({.name = "late", .formula = of("2 * LegLength")});
  d.parameters.push_back({.name = "LegLength",
                          .also = {"LeftLegLength"},
                          .quantity = SubjectQuantity::length,
                          .formula = of("0.5"),
                          .zero_is_unknown = true,
                          .formula_sd = of("0.01 * 1")});
  d.values.push_back({.name = "twice", .formula = of("late")});
  const auto markers = movement(3);
  const auto value = [&](const SegmentInput& input) {
    return compute_segments(d, input).value().values[0].value[0];
  };
  EXPECT_DOUBLE_EQ(value({.markers = &markers}), 1.0);
  EXPECT_DOUBLE_EQ(
      value({.markers = &markers, .known = {{"LeftLegLength", 0.0, "a"}, {"LegLength", 0.7, "b"}}}), 1.4);
  const SegmentInput both{
      .markers = &markers, .given = {{"LegLength", 0.9, "--subject"}}, .known = {{"LegLength", 0.7, "b"}}};
  EXPECT_DOUBLE_EQ(value(both), 1.8);
  const auto motion = compute_segments(d, both);
  EXPECT_THAT(motion->parameters,
              Contains(::testing::AllOf(::testing::Field(&UsedParameter::name, "LegLength"),
                                        ::testing::Field(&UsedParameter::from, "--subject"),
                                        ::testing::Field(&UsedParameter::sd, 0.01))));
}

TEST(SegmentMotion, SaysGimbalLock) {
  SegmentDefinition d;
  d.segments.push_back({.name = "s",
                        .origin = of("A"),
                        .first = 0,
                        .first_along = of("B - A"),
                        .second = 1,
                        .second_along = of("C - A")});
  d.angles.push_back({.name = "a",
                      .parent = "lab",
                      .child = "s",
                      .sequence = {1, 0, 2},
                      .components = {{{"one", 0}, {"two", 1}, {"three", 2}}}});
  auto markers = data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 100.0, .frames = 90});
  for (std::int64_t f = 0; f < 90; ++f) {
    const Matrix3d r = about(Vector3d::UnitX(), (static_cast<double>(f) + 0.5) * std::numbers::pi / 180.0);
    const std::array<Vector3d, 3> x{Vector3d(0, 0, 0), r.col(0), r.col(1)};
    for (std::int64_t m = 0; m < 3; ++m) {
      markers.x(f, m) = x[static_cast<std::size_t>(m)];
      markers.state[markers.index(f, m)] = State::measured;
    }
  }
  const auto near = compute_segments(d, {.markers = &markers});
  ASSERT_TRUE(near);
  EXPECT_THAT(near->warnings, Contains(HasSubstr("a: two is within 5 deg of gimbal lock in 5 of 90 frames: "
                                                 "the other two angles say little there.")));
  auto far = markers;
  far.time.frames = 80;
  far.x_in_world.resize(80 * 9);
  far.state.resize(240);
  EXPECT_TRUE(compute_segments(d, {.markers = &far})->warnings.empty());
}

TEST(SegmentMotion, KnowsTheWayForwardAndUp) {
  SegmentDefinition d;
  d.segments.push_back({.name = "s",
                        .origin = of("A"),
                        .first = 0,
                        .first_along = of("B - A"),
                        .second = 1,
                        .second_along = of("C - A")});
  d.angles.push_back({.name = "a",
                      .parent = "progression",
                      .child = "s",
                      .sequence = {1, 0, 2},
                      .components = {{{"one", 0}, {"two", 1}, {"three", 2}}}});
  d.progression.emplace(of("A"), of("s.x"));
  const auto heading = [&](const Vector3d& way, const Vector3d& facing, const Vector3d& up) {
    auto markers = data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = 100.0, .frames = 2});
    for (std::int64_t f = 0; f < 2; ++f) {
      const Vector3d a = static_cast<double>(f) * way;
      const std::array<Vector3d, 3> x{a, a + facing, a + up.cross(facing)};
      for (std::int64_t m = 0; m < 3; ++m) {
        markers.x(f, m) = x[static_cast<std::size_t>(m)];
        markers.state[markers.index(f, m)] = State::measured;
      }
    }
    return compute_segments(d, {.markers = &markers}, {.up = up}).value().angles[0].value[2];
  };
  const auto z = Vector3d::UnitZ(), y = Vector3d::UnitY(), x = Vector3d::UnitX();
  EXPECT_NEAR(heading(-2.0 * y + 0.5 * x, -y, z), 0.0, 1e-9);
  EXPECT_NEAR(heading(2.0 * x, y, z), 0.5 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(heading(0.1 * x, y, z), 0.0, 1e-9) << "it stands: where it faces";
  EXPECT_NEAR(heading(2.0 * z, z, y), 0.0, 1e-9);
}

TEST(SegmentMotion, HasTheSameBitsForAnyNumberOfThreads) {
  const auto markers = movement(100);
  const auto one =
      compute_segments(two_segments(), {.markers = &markers}, {.noise_sd_m = 0.001, .threads = 1});
  const auto four =
      compute_segments(two_segments(), {.markers = &markers}, {.noise_sd_m = 0.001, .threads = 4});
  EXPECT_EQ(one->angles[0].value, four->angles[0].value);
  EXPECT_EQ(one->angles[0].sd, four->angles[0].sd);
  EXPECT_EQ(one->points.covariance, four->points.covariance);
}

TEST(SegmentMotion, RefusesOptionsAndDefinitionsThatMakeNoSense) {
  const auto markers = movement(3);
  EXPECT_EQ(compute_segments(two_segments(), {.markers = &markers}, {.noise_sd_m = -1.0}).error().code,
            Code::usage);
  EXPECT_EQ(compute_segments(two_segments(), {.markers = &markers}, {.up = {0, 0, 2}}).error().code,
            Code::usage);
  auto d = two_segments();
  d.angles[0].child = "nobody";
  EXPECT_THAT(compute_segments(d, {.markers = &markers}).error().message,
              HasSubstr("no segment is called 'nobody'"));
  d = two_segments();
  for (int i = 0; i < 60; ++i)
    d.parameters.push_back({.name = "p" + std::to_string(i), .formula = of("1 + p" + std::to_string(i + 1))});
  EXPECT_THAT(compute_segments(d, {.markers = &markers}).error().message, HasSubstr("parameter in a row"));
  d = two_segments();
  std::string terms;
  for (int i = 0; i < 600; ++i) terms += "+pi";
  for (int i = 0; i < 40; ++i)
    d.parameters.push_back(
        {.name = "p" + std::to_string(i), .formula = of("p" + std::to_string(i + 1) + terms)});
  EXPECT_THAT(compute_segments(d, {.markers = &markers}).error().message, HasSubstr("1200 levels deep"));
  d = two_segments();
  d.values[0].formula = of("distance(P1, 3)");
  EXPECT_THAT(compute_segments(d, {.markers = &markers}).error().message,
              HasSubstr("value reach: distance() does not take"));
}

const UsedParameter* used(const SegmentMotion& motion, const std::string& name) {
  for (const auto& one : motion.parameters)
    if (one.name == name) return &one;
  return nullptr;
}

SegmentDefinition with_parameters(std::vector<SegmentDefinition::Parameter> parameters,
                                  const std::vector<std::string>& values) {
  auto d = two_segments();
  d.parameters = std::move(parameters);
  for (const auto& value : values)
    d.values.push_back({.name = "of " + value, .quantity = SubjectQuantity::length, .formula = of(value)});
  return d;
}

// An offset that the static trial measures with an assumed size takes back its error.
TEST(SegmentMotion, AnAssumedMeasureIsOneErrorOfAllThatFollowsFromIt) {
  const auto d = with_parameters(
      {{.name = "size",
        .quantity = SubjectQuantity::length,
        .formula = of("0.014"),
        .assumed_sd = of("0.002")},
       {.name = "offset", .quantity = SubjectQuantity::length, .measured = of("distance(P1, P2) - size")}},
      {"size", "offset + size", "offset - size"});
  const auto markers = movement(20);
  const auto motion =
      compute_segments(d, {.markers = &markers, .static_trial = &markers}, {.noise_sd_m = 1e-9});
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_TRUE(used(*motion, "size")->assumed && used(*motion, "size")->constant);
  EXPECT_EQ(used(*motion, "size")->from, "assumed");
  EXPECT_NEAR(motion->values[1].sd[7], 0.002, 1e-9);
  EXPECT_NEAR(motion->values[1].constant_sd[7], 0.002, 1e-9);
  EXPECT_NEAR(motion->values[2].sd[7], 0.0, 1e-6) << "what one adds the other takes";
  EXPECT_NEAR(motion->values[3].sd[7], 0.004, 1e-6);
  const auto exact = compute_segments(
      d, {.markers = &markers, .static_trial = &markers, .given = {{"size", 0.016, "somebody"}}});
  EXPECT_FALSE(used(*exact, "size")->assumed);
  EXPECT_NEAR(exact->values[1].constant_sd[7], 0.0, 1e-12);
  const auto stated = compute_segments(
      d, {.markers = &markers, .static_trial = &markers, .given = {{"size", 0.016, "somebody", 0.001}}});
  EXPECT_NEAR(stated->values[1].constant_sd[7], 0.001, 1e-9);
  const auto without = compute_segments(d, {.markers = &markers}, {.deviations = false});
  EXPECT_EQ(without->values[1].sd[7], 0.0);
}

TEST(SegmentMotion, TakesASmallerStepWhereGeometryAllowsNoLargerOne) {
  const auto d = with_parameters({{.name = "size",
                                   .quantity = SubjectQuantity::length,
                                   .formula = of("0.01"),
                                   .assumed_sd = of("0.02")}},
                                 {"sqrt(size)"});
  const auto markers = movement(3);
  const auto motion = compute_segments(d, {.markers = &markers}, {.noise_sd_m = 1e-9});
  ASSERT_TRUE(motion);
  EXPECT_GT(motion->values[1].sd[1], 0.09) << "0.02 / (2 sqrt(0.01)), and more by its curvature";
  EXPECT_LT(motion->values[1].sd[1], 0.5);
}

TEST(SegmentMotion, OutputsInTheFileTellWhatNobodyStates) {
  const auto d = with_parameters({{.name = "size",
                                   .quantity = SubjectQuantity::length,
                                   .formula = of("0.1"),
                                   .assumed_sd = of("0.002"),
                                   .shown = {of("distance(P1, P2)"), of("distance(P1, OUT)")}}},
                                 {"size"});
  const auto markers = movement(20);
  const double shown = (markers.x(0, 1) - markers.x(0, 0)).norm();
  const auto motion = compute_segments(d, {.markers = &markers});
  EXPECT_NEAR(used(*motion, "size")->value, shown, 1e-12) << "a formula without its point says nothing";
  EXPECT_EQ(used(*motion, "size")->sd, 0.002);
  const auto stated = compute_segments(d, {.markers = &markers, .known = {{"size", 0.12, "a file"}}});
  EXPECT_EQ(used(*stated, "size")->value, 0.12) << "what a file states counts before";
  const auto list = shown_parameters(d, {.markers = &markers, .known = {{"size", 0.12, "a file"}}});
  ASSERT_TRUE(list);
  ASSERT_EQ(list->size(), 1U);
  EXPECT_NEAR(list->front().value, shown, 1e-12);
  EXPECT_EQ(list->front().used, 0.12);
  EXPECT_EQ(list->front().formulas, 1);
  EXPECT_LT(list->front().spread, 1e-9);
  // Two formulas that disagree are of another model.
  const auto torn = compute_segments(d, {.markers = &markers, .aliases = {{"OUT", "C2"}}});
  EXPECT_EQ(used(*torn, "size")->value, 0.1);
  EXPECT_EQ(used(*torn, "size")->from, "assumed");
}

TEST(SegmentMotion, AChoiceIsTheOneWithWhichTheStaticTrialGivesWhatFilesHold) {
  const auto d =
      with_parameters({{.name = "flat", .formula = of("1"), .choices = {1.0, 0.0}, .chosen_by = {"offset"}},
                       {.name = "offset",
                        .quantity = SubjectQuantity::length,
                        .measured = of("distance(P1, P2) + flat * 0.1")}},
                      {"offset"});
  const auto markers = movement(1);
  const double plain = (markers.x(0, 1) - markers.x(0, 0)).norm();
  const auto choice = [&](std::vector<SubjectValue> known) {
    const auto motion =
        compute_segments(d, {.markers = &markers, .static_trial = &markers, .known = std::move(known)});
    return *used(*motion, "flat");
  };
  EXPECT_EQ(choice({{"offset", plain, "a file"}}).value, 0.0);
  EXPECT_EQ(choice({{"offset", plain, "a file"}}).from, "offsets in a file");
  EXPECT_EQ(choice({{"offset", plain + 0.1, "a file"}}).value, 1.0);
  EXPECT_TRUE(choice({{"offset", plain + 0.05, "a file"}}).assumed) << "neither";
  EXPECT_TRUE(choice({}).assumed);
}

}  // namespace
}  // namespace kinemark::analysis
