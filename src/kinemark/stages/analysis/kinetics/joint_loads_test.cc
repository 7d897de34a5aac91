// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/joint_loads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using State = data::SampleState;

constexpr double kSwingRate_hz = 100.0, kMass = 2.0, kLength = 0.4, kHeight = 1.0, kSwingGravity = 9.81;
constexpr std::int64_t kSwingFrames = 300;

Formula of(const std::string& text) { return parse_formula(text).value(); }

double angle_at(std::int64_t f) { return 0.6 * std::sin(4.0 * static_cast<double>(f) / kSwingRate_hz); }

// A shank that swings about a knee which stands still; its end E is what touches the floor.
SegmentDefinition swinging_shank() {
  SegmentDefinition d;
  const auto segment = [&](const std::string& name, const std::string& from, const std::string& to,
                           const std::string& side) {
    d.segments.push_back({.name = name,
                          .origin = of(from),
                          .first = 2,
                          .first_along = of(to + " - " + from),
                          .second = 1,
                          .second_along = of(side + " - " + from)});
  };
  segment("thigh", "K", "T", "S");
  segment("shank", "E", "K", "F");
  d.values.push_back({.name = "height", .quantity = SubjectQuantity::length, .formula = of("z(E)")});
  d.bodies.push_back({.name = "Shank",
                      .segment = "shank",
                      .mass = of("2"),
                      .centre = of("0.5 * (K + E)"),
                      .gyration = {of("distance(K, E) / sqrt(12)"), of("distance(K, E) / sqrt(12)"), of("0")},
                      .floor = {of("E")},
                      .ground_reaction = "Ground"});
  d.joints.push_back({.name = "Knee",
                      .centre = of("K"),
                      .parent = "thigh",
                      .child = "shank",
                      .bodies = {"Shank"},
                      .per = of("2"),
                      .moment = {{{"extension", 1, -1.0}, {"varus", 0, 1.0}, {"rotation", 2, 1.0}}},
                      .force = {{{"anterior", 0, 1.0}, {"left", 1, 1.0}, {"tension", 2, 1.0}}}});
  return d;
}

data::Trajectories swing(double noise_m, std::uint64_t seed) {
  auto out = data::Trajectories::all_missing({"K", "T", "S", "E", "F"},
                                             {.rate_hz = kSwingRate_hz, .frames = kSwingFrames});
  Random random(seed, 0);
  for (std::int64_t f = 0; f < kSwingFrames; ++f) {
    const Matrix3d r = Eigen::AngleAxisd(angle_at(f), Vector3d::UnitY()).toRotationMatrix();
    const Vector3d knee(0.0, 0.0, kHeight);
    const std::array<Vector3d, 5> x{knee, knee + Vector3d(0, 0, 0.4), knee + Vector3d(0, 0.1, 0),
                                    knee + r * Vector3d(0, 0, -kLength),
                                    knee + r * Vector3d(0, 0.1, -kLength)};
    for (std::int64_t m = 0; m < 5; ++m) {
      out.x(f, m) = x[at(m)] + noise_m * Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
      out.state[out.index(f, m)] = State::measured;
    }
  }
  return out;
}

// The muscles' moment that makes a rod swing so, over its mass; positive extends (forwards, about -y).
double extension_at(std::int64_t f) {
  const double a = angle_at(f), second = -16.0 * a;
  return -(kSwingGravity * 0.5 * kLength * std::sin(a) + kLength * kLength / 3.0 * second);
}

data::Wrenches idle_plate() {
  data::Wrenches out{.time = {.rate_hz = kSwingRate_hz, .frames = kSwingFrames}, .items = {}};
  data::Wrench plate{.name = "plate 1", .body = {}, .force = {}, .moment = {}, .point = {}};
  for (auto* values : {&plate.force, &plate.moment, &plate.point}) values->assign(at(3 * kSwingFrames), 0.0);
  out.items.push_back(std::move(plate));
  return out;
}

const SegmentSeries& series(const JointLoads& loads, const std::string& name) {
  return *std::ranges::find(loads.series, name, &SegmentSeries::name);
}

JointLoads loads_of(const data::Trajectories& markers, const data::Wrenches& plates,
                    const JointLoadOptions& options) {
  const SegmentInput input{.markers = &markers};
  const auto found = find_joint_loads(swinging_shank(), input, plates, options);
  EXPECT_TRUE(found) << found.error().message;
  return *found;
}

// At its turns the shank's end is slower than a foot that swings: it would count as standing.
bool moves(std::int64_t f) { return std::abs(std::cos(4.0 * static_cast<double>(f) / kSwingRate_hz)) > 0.5; }

TEST(JointLoads, SwingingRodHasTheMomentOfItsEquation) {
  const auto markers = swing(0.0, 1);
  const auto found = loads_of(markers, idle_plate(), {.refits = 0});
  const auto& moment = series(found, "KneeMoment");
  EXPECT_THAT(moment.labels, ElementsAre("extension", "varus", "rotation"));
  EXPECT_EQ(moment.unit, "N m/kg");
  const auto& power = series(found, "KneePower");
  for (std::int64_t f = 4; f < kSwingFrames - 4; ++f) {
    if (!moves(f)) continue;
    ASSERT_EQ(moment.state[at(f)], State::measured) << f;
    EXPECT_NEAR(moment.value[at(3 * f)], extension_at(f), 1e-7) << f;
    EXPECT_NEAR(moment.value[at(3 * f + 1)], 0.0, 1e-9);
    const double rate = 2.4 * std::cos(4.0 * static_cast<double>(f) / kSwingRate_hz);
    EXPECT_NEAR(power.value[at(f)], -extension_at(f) * rate, 1e-6) << f;
    EXPECT_TRUE(std::isnan(moment.sd[at(3 * f)]));
  }
  EXPECT_EQ(moment.state[3], State::missing);
  EXPECT_TRUE(std::isnan(moment.value[9]));
}

TEST(JointLoads, DeviationsCoverNoise) {
  std::int64_t inside = 0, all = 0;
  for (std::uint64_t seed = 501; seed <= 520; ++seed) {
    const auto found = loads_of(swing(0.001, seed), idle_plate(), {.refits = 60, .seed = seed});
    const auto& moment = series(found, "KneeMoment");
    for (std::int64_t f = 4; f < kSwingFrames - 4; ++f) {
      if (moment.state[at(f)] == State::missing) continue;
      inside += std::abs(moment.value[at(3 * f)] - extension_at(f)) < 1.96 * moment.sd[at(3 * f)];
      ++all;
    }
  }
  const double share = static_cast<double>(inside) / static_cast<double>(all);
  EXPECT_GT(share, 0.90) << all;
  EXPECT_LT(share, 0.985) << all;
}

TEST(JointLoads, RefitsAreTheSameForAnyNumberOfThreads) {
  const auto markers = swing(0.001, 3);
  JointLoadOptions one{.refits = 20}, two{.refits = 20};
  two.segments.threads = 2;
  const auto a = loads_of(markers, idle_plate(), one), b = loads_of(markers, idle_plate(), two);
  std::int64_t compared = 0;
  for (std::int64_t f = 4; f < kSwingFrames - 4; ++f) {
    if (!moves(f)) continue;
    EXPECT_EQ(series(a, "KneeMoment").sd[at(3 * f)], series(b, "KneeMoment").sd[at(3 * f)]);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(JointLoads, GapIsMissingAndItsNeighboursAreInterpolated) {
  auto markers = swing(0.0, 1);
  for (std::int64_t f = 20; f < 25; ++f) {
    markers.state[markers.index(f, 3)] = State::missing;
    markers.x(f, 3).setConstant(kNaN);
  }
  const auto found = loads_of(markers, idle_plate(), {.refits = 0});
  const auto& moment = series(found, "KneeMoment");
  EXPECT_EQ(moment.state[15], State::measured);
  EXPECT_EQ(moment.state[17], State::interpolated);
  EXPECT_EQ(moment.state[22], State::missing);
  EXPECT_EQ(moment.state[27], State::interpolated);
  EXPECT_NEAR(moment.value[3 * 17], extension_at(17), 1e-3);
}

TEST(JointLoads, StandingLegHoldsThePlatesForce) {
  auto markers = swing(0.0, 1);
  for (std::int64_t f = 0; f < kSwingFrames; ++f)
    for (std::int64_t m = 0; m < 5; ++m) markers.x(f, m) = Vector3d(markers.x(0, m));
  auto plates = idle_plate();
  for (std::int64_t f = 40; f < 260; ++f) {
    Eigen::Map<Vector3d>(plates.items[0].force.data() + 3 * f) = Vector3d(0.0, 0.0, 100.0);
    Eigen::Map<Vector3d>(plates.items[0].point.data() + 3 * f) = Vector3d(0.05, 0.0, kHeight - kLength);
  }
  const auto found = loads_of(markers, plates, {.refits = 0});
  const auto& moment = series(found, "KneeMoment");
  // 100 N in front of a knee extend it: muscles flex against them.
  EXPECT_NEAR(moment.value[3 * 150], -100.0 * 0.05 / kMass, 1e-9);
  EXPECT_NEAR(series(found, "KneeForce").value[3 * 150 + 2], kSwingGravity - 100.0 / kMass, 1e-9);
  EXPECT_NEAR(series(found, "Ground").value[3 * 150 + 2], 50.0, 1e-12);
  EXPECT_EQ(moment.state[20], State::missing);  // on the floor, and the plate bears nothing
  ASSERT_EQ(found.steps.size(), 1U);
  EXPECT_EQ(found.steps[0].plate, "plate 1");
  EXPECT_NEAR(found.steps[0].begin_s, 0.4, 1e-12);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("Shank: on the floor without a plate")));
}

// The laboratory's axes are anybody's choice: y up, as cameras and OpenSim have it.
TEST(JointLoads, AnotherVerticalGivesTheSame) {
  const auto upright = swing(0.0, 1);
  auto turned = upright;
  const Matrix3d turn = Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  for (std::int64_t f = 0; f < kSwingFrames; ++f)
    for (std::int64_t m = 0; m < 5; ++m) turned.x(f, m) = turn * Vector3d(upright.x(f, m));
  const auto loaded = [](const Matrix3d& r) {
    auto plates = idle_plate();
    for (std::int64_t f = 40; f < 260; ++f) {
      Eigen::Map<Vector3d>(plates.items[0].force.data() + 3 * f) = r * Vector3d(5.0, 2.0, 100.0);
      Eigen::Map<Vector3d>(plates.items[0].moment.data() + 3 * f) = r * Vector3d(0.0, 0.0, 3.0);
      Eigen::Map<Vector3d>(plates.items[0].point.data() + 3 * f) = r * Vector3d(0.05, 0.0, kHeight - kLength);
    }
    return plates;
  };
  JointLoadOptions sideways{.refits = 0};
  sideways.segments.up = (turn * Vector3d::UnitZ()).array().round();
  const auto a = loads_of(upright, loaded(Matrix3d::Identity()), {.refits = 0});
  const auto b = loads_of(turned, loaded(turn), sideways);
  for (const auto* name : {"KneeMoment", "KneeForce", "KneePower"}) {
    const auto &one = series(a, name), &other = series(b, name);
    ASSERT_EQ(one.value.size(), other.value.size());
    EXPECT_EQ(std::vector(one.state.begin(), one.state.end()),
              std::vector(other.state.begin(), other.state.end()));
    for (std::size_t i = 0; i < one.value.size(); ++i)
      if (std::isfinite(one.value[i])) {
        EXPECT_NEAR(one.value[i], other.value[i], 1e-9) << name << i;
      }
  }
}

TEST(JointLoads, NoiseOfThePlateIsInTheDeviations) {
  auto markers = swing(0.0, 1);
  for (std::int64_t f = 0; f < kSwingFrames; ++f)
    for (std::int64_t m = 0; m < 5; ++m) markers.x(f, m) = Vector3d(markers.x(0, m));
  auto plates = idle_plate();
  Random random(77, 0);
  for (std::int64_t f = 40; f < 260; ++f) {
    Eigen::Map<Vector3d>(plates.items[0].force.data() + 3 * f) =
        Vector3d(2.0 * random.gaussian(), 2.0 * random.gaussian(), 100.0 + 2.0 * random.gaussian());
    Eigen::Map<Vector3d>(plates.items[0].point.data() + 3 * f) = Vector3d(0.05, 0.0, kHeight - kLength);
  }
  const auto found = loads_of(markers, plates, {.refits = 99});
  const auto& force = series(found, "KneeForce");
  double squares = 0.0;
  for (std::int64_t f = 100; f < 200; ++f) squares += force.sd[at(3 * f + 2)] * force.sd[at(3 * f + 2)];
  EXPECT_NEAR(std::sqrt(squares / 100.0), 2.0 / kMass, 0.2);
}

TEST(JointLoads, ScaleWithTheMassByWhichTheyAreDivided) {
  auto definition = swinging_shank();
  const auto markers = swing(0.0, 1);
  const auto plates = idle_plate();
  const auto of_mass = [&](const std::string& per) {
    definition.joints[0].per = of(per);
    return find_joint_loads(definition, {.markers = &markers}, plates, {.refits = 0}).value();
  };
  const auto one = of_mass("1"), ten = of_mass("10");
  for (std::int64_t f = 4; f < kSwingFrames - 4; f += 7) {
    if (!moves(f)) continue;
    EXPECT_NEAR(series(one, "KneeMoment").value[at(3 * f)], 10.0 * series(ten, "KneeMoment").value[at(3 * f)],
                1e-12);
    EXPECT_NEAR(series(one, "KneePower").value[at(f)], 10.0 * series(ten, "KneePower").value[at(f)], 1e-12);
  }
}

TEST(JointLoads, WhatIsNotThereIsNamedOnce) {
  auto definition = swinging_shank();
  definition.bodies[0].mass = of("Bodymass * 0.03");
  definition.parameters.push_back({.name = "Bodymass", .quantity = SubjectQuantity::mass});
  const auto markers = swing(0.0, 1);
  const auto plates = idle_plate();
  const auto found = find_joint_loads(definition, {.markers = &markers}, plates, {.refits = 0});
  ASSERT_TRUE(found);
  EXPECT_THAT(found->series, IsEmpty());
  EXPECT_THAT(found->warnings, ElementsAre("Not computed: KneeMoment; there is no value of 'Bodymass'."));
}

TEST(JointLoads, WithoutPlatesThereAreNone) {
  const auto markers = swing(0.0, 1);
  const auto found = find_joint_loads(swinging_shank(), {.markers = &markers}, {});
  ASSERT_TRUE(found);
  EXPECT_THAT(found->series, IsEmpty());
  EXPECT_THAT(found->warnings, IsEmpty());
}

TEST(JointLoads, RefusesFewRefits) {
  EXPECT_EQ(JointLoadOptions{.refits = 3}.check().error().message, "3 refits: expected 0 or at least 20");
  EXPECT_FALSE((JointLoadOptions{.gravity = -1.0}.check()));
}

}  // namespace
}  // namespace kinemark::analysis
