// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/internal/joint_mechanics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/index.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector3d;

constexpr std::int64_t kChainFrames = 80;
constexpr double kChainRate_hz = 100.0, kUpper_kg = 3.0, kLower_kg = 2.0, kLink_m = 0.4;

Formula formula(const std::string& text) { return parse_formula(text).value(); }

// Two rods that hang one on the other and swing in one plane: hip H, knee K, ankle A, and S beside H.
SegmentDefinition two_rods() {
  SegmentDefinition d;
  const auto rod = [&](const std::string& name, const std::string& low, const std::string& high,
                       double mass) {
    d.segments.push_back({.name = name,
                          .origin = formula(low),
                          .first = 2,
                          .first_along = formula(high + " - " + low),
                          .second = 1,
                          .second_along = formula("S - H")});
    const auto radius = formula("0.4 / sqrt(12)");
    d.bodies.push_back({.name = name,
                        .segment = name,
                        .mass = formula(std::to_string(mass)),
                        .centre = formula("mean(" + low + ", " + high + ")"),
                        .gyration = {radius, radius, formula("0")},
                        .floor = {},
                        .ground_reaction = {}});
  };
  rod("upper", "K", "H", kUpper_kg);
  rod("lower", "A", "K", kLower_kg);
  d.values.push_back({.name = "height", .quantity = SubjectQuantity::length, .formula = formula("z(A)")});
  const std::array<SegmentDefinition::AxisComponent, 3> axes{{{"x", 0}, {"y", 1}, {"z", 2}}};
  d.joints.push_back({.name = "Knee",
                      .centre = formula("K"),
                      .parent = "upper",
                      .child = "lower",
                      .bodies = {"lower"},
                      .per = formula("1"),
                      .moment = axes,
                      .force = axes});
  d.joints.push_back({.name = "Hip",
                      .centre = formula("H"),
                      .parent = "lab",
                      .child = "upper",
                      .bodies = {"upper", "lower"},
                      .per = formula("10"),
                      .moment = axes,
                      .force = axes});
  return d;
}

double upper_angle(double t) { return 0.5 * std::sin(4.0 * t); }
double lower_angle(double t) { return 0.3 - 0.6 * std::cos(5.0 * t); }

data::Trajectories chain() {
  auto out = data::Trajectories::all_missing({"H", "K", "A", "S"},
                                             {.rate_hz = kChainRate_hz, .frames = kChainFrames});
  for (std::int64_t f = 0; f < kChainFrames; ++f) {
    const double t = static_cast<double>(f) / kChainRate_hz;
    const auto down = [](double angle) { return Vector3d(-std::sin(angle), 0.0, -std::cos(angle)); };
    const Vector3d hip(0.2, 0.1, 1.1), knee = hip + kLink_m * down(upper_angle(t));
    const std::array<Vector3d, 4> x{hip, knee, knee + kLink_m * down(lower_angle(t)),
                                    hip + Vector3d(0, 0.1, 0)};
    for (std::int64_t m = 0; m < 4; ++m) {
      out.x(f, m) = x[at(m)];
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

/// Moment about y that the hip's muscles need, by Lagrange's equations of the double pendulum.
double hip_moment(double t) {
  const double a = upper_angle(t), b = lower_angle(t);
  const double a2 = -16.0 * a, b1 = 3.0 * std::sin(5.0 * t), b2 = 15.0 * std::cos(5.0 * t);
  const double a1 = 2.0 * std::cos(4.0 * t);
  const double l = kLink_m, g = 9.81, half = 0.5 * kLower_kg * l * l;
  const double upper = (kUpper_kg / 3.0 + kLower_kg) * l * l * a2 +
                       half * (std::cos(a - b) * b2 + std::sin(a - b) * b1 * b1) +
                       (0.5 * kUpper_kg + kLower_kg) * g * l * std::sin(a);
  const double lower = kLower_kg / 3.0 * l * l * b2 +
                       half * (std::cos(a - b) * a2 - std::sin(a - b) * a1 * a1) +
                       0.5 * kLower_kg * g * l * std::sin(b);
  return upper + lower;
}

class TwoRods : public testing::Test {
 protected:
  TwoRods()
      : outputs_(d_), tracks_(FormulaTracks::create(d_, {.markers = &markers_}, {}, outputs_.list).value()) {}

  SegmentDefinition d_ = two_rods();
  data::Trajectories markers_ = chain();
  LoadOutputs outputs_;
  FormulaTracks tracks_;
  JointLoadOptions options_;
};

TEST_F(TwoRods, HipBearsWhatLagrangesEquationsSay) {
  const JointMechanics mechanics(d_, tracks_, outputs_, options_);
  ASSERT_TRUE(mechanics.has_joint(0));
  ASSERT_TRUE(mechanics.has_joint(1));
  EXPECT_FALSE(mechanics.has_foot(0));
  const auto values = mechanics.values_of(markers_);
  const auto loads = mechanics.loads_of(1, values, {nullptr, nullptr}, kChainRate_hz);
  EXPECT_EQ(mechanics.per(1, values), 10.0);
  for (std::int64_t f = 4; f < kChainFrames - 4; ++f) {
    const double t = static_cast<double>(f) / kChainRate_hz;
    EXPECT_NEAR(loads(f, 4), hip_moment(t) / 10.0, 1e-6) << f;
    EXPECT_NEAR(loads(f, 3), 0.0, 1e-9);
    EXPECT_NEAR(loads(f, 6), hip_moment(t) / 10.0 * 2.0 * std::cos(4.0 * t), 1e-5) << f;
  }
  EXPECT_TRUE(std::isnan(loads(3, 4)));
}

// Powers of both joints are the rate of the rods' energy.
TEST_F(TwoRods, PowersAreTheRateOfEnergy) {
  const JointMechanics mechanics(d_, tracks_, outputs_, options_);
  const auto values = mechanics.values_of(markers_);
  const auto knee = mechanics.loads_of(0, values, {nullptr, nullptr}, kChainRate_hz);
  const auto hip = mechanics.loads_of(1, values, {nullptr, nullptr}, kChainRate_hz);
  const auto energy = [](double t) {
    const double a = upper_angle(t), b = lower_angle(t), l = kLink_m, g = 9.81;
    const double a1 = 2.0 * std::cos(4.0 * t), b1 = 3.0 * std::sin(5.0 * t);
    return 0.5 * (kUpper_kg / 3.0 + kLower_kg) * l * l * a1 * a1 + 0.5 * kLower_kg / 3.0 * l * l * b1 * b1 +
           0.5 * kLower_kg * l * l * std::cos(a - b) * a1 * b1 -
           (0.5 * kUpper_kg + kLower_kg) * g * l * std::cos(a) - 0.5 * kLower_kg * g * l * std::cos(b);
  };
  for (std::int64_t f = 4; f < kChainFrames - 4; ++f) {
    const double t = static_cast<double>(f) / kChainRate_hz, h = 1e-4;
    EXPECT_NEAR(knee(f, 6) + 10.0 * hip(f, 6), (energy(t + h) - energy(t - h)) / (2.0 * h), 1e-4) << f;
  }
}

TEST_F(TwoRods, FloorUnderTheLowerRodIsBorneByBothJoints) {
  const JointMechanics mechanics(d_, tracks_, outputs_, options_);
  const auto values = mechanics.values_of(markers_);
  WrenchTrack push = WrenchTrack::zero(kChainFrames);
  push.force.col(2).setConstant(100.0);
  push.moment.col(1).setConstant(-100.0 * 0.5);  // at x = 0.5
  const std::vector<const WrenchTrack*> none{nullptr, nullptr}, some{nullptr, &push};
  for (const std::size_t joint : {0U, 1U}) {
    const Eigen::MatrixXd difference = mechanics.loads_of(joint, values, some, kChainRate_hz) -
                                       mechanics.loads_of(joint, values, none, kChainRate_hz);
    const double per = joint == 0 ? 1.0 : 10.0;
    const Vector3d centre = markers_.x(40, joint == 0 ? 1 : 0);
    EXPECT_NEAR(difference(40, 4), 100.0 * (0.5 - centre.x()) / per, 1e-9);
    EXPECT_NEAR(difference.row(40).head(3).norm(), 100.0 / per, 1e-9);
  }
}

TEST_F(TwoRods, JointWithoutItsBodyIsNotThere) {
  d_.parameters.push_back({.name = "Unknown", .quantity = SubjectQuantity::mass});
  d_.bodies[1].mass = formula("Unknown * 2");
  const LoadOutputs outputs(d_);
  const auto tracks = FormulaTracks::create(d_, {.markers = &markers_}, {}, outputs.list);
  ASSERT_TRUE(tracks);
  const JointMechanics mechanics(d_, *tracks, outputs, options_);
  EXPECT_FALSE(mechanics.has_joint(0));
  EXPECT_FALSE(mechanics.has_joint(1));
  EXPECT_EQ(mechanics.index_of_body("lower"), 1U);
}

}  // namespace
}  // namespace kinemark::analysis::internal
