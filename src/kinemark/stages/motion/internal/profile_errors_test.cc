// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/profile_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/testing/planar_arm.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kSd_m = 0.005;

/// A marker on each body: `upper_lever_m` beside the shoulder, 0.3 m beside the elbow.
data::ModelDescription arm_with_lever(double upper_lever_m) {
  return testing_body::planar_arm({0.3, 0.0, 0.0},
                                  {{.name = "U", .body_idx = 0, .x_in_body = {upper_lever_m, 0.0, 0.0}},
                                   {.name = "H", .body_idx = 1, .x_in_body = {0.3, 0.0, 0.0}}});
}

/// What is added to the variances of shoulder and elbow with markers where the model has them at `pose`.
Eigen::VectorXd lacks(double upper_lever_m, const Eigen::Vector2d& pose, const Eigen::Vector2d& seen) {
  const auto model = model::Model::compile(arm_with_lever(upper_lever_m)).value();
  auto all = data::Trajectories::all_missing({"U", "H"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1});
  model::Workspace w(model);
  const Eigen::VectorXd x = model::state_from_coordinates(model, pose);
  model::kinematics(model, w, x);
  for (int m = 0; m < 2; ++m) {
    all.x(0, m) = w.marker.col(m);
    all.state[all.index(0, m)] = data::SampleState::measured;
  }
  const auto problem = make_problem(model, all, {}).value();
  ProfileErrors profile(problem);
  Eigen::VectorXd variance = Eigen::Vector2d::Zero();
  profile.add(x, w.marker, seen / (kSd_m * kSd_m), Eigen::Vector2d::Ones() / (kSd_m * kSd_m),
              Eigen::Matrix2d::Identity(), variance);
  return variance;
}

TEST(ProfileErrors, AddNothingWhereNoMarkerIsLostOrLeversAreLong) {
  EXPECT_EQ(lacks(0.01, {0.4, 1.0}, {1.0, 1.0}), Eigen::VectorXd(Eigen::Vector2d::Zero()));
  EXPECT_EQ(lacks(0.3, {0.4, 1.0}, {1.0, 0.0})[0], 0.0);
}

TEST(ProfileErrors, OfOneHingeAreThoseOfItsChord) {
  // Chi-square rises by (2 r sin(a / 2) / sd)^2 as the marker goes along its chord; the linear deviation is
  // sd / r.
  const double r = 0.01, farthest = 1.5;
  const double rise = std::pow(2.0 * r * std::sin(0.5 * farthest) / kSd_m, 2);
  const auto added = lacks(r, {0.4, 1.0}, {1.0, 0.0});
  EXPECT_NEAR(added[0], farthest * farthest / rise - std::pow(kSd_m / r, 2), 2e-3);
  EXPECT_GT(added[0], 0.04);
  EXPECT_EQ(added[1], 0.0) << "no marker moves with the elbow: it is open, and nothing follows it";
}

TEST(ProfileErrors, OfAnArmThatNoiseBentReachItsMirrorPose) {
  // The hand alone, 0.6 m from the shoulder but for a flexion of 0.2 rad: to first order the elbow is known
  // to 0.17 rad. The arm may be straight, or bent to the other side, and the shoulder follows by half of it.
  const double flexion = 0.2, linear = kSd_m / (0.3 * std::sin(0.5 * flexion));
  const auto added = lacks(0.3, {0.4, flexion}, {0.0, 1.0});
  EXPECT_GE(std::sqrt(added[1] + linear * linear), 2.0 * flexion - 0.02) << "the mirror pose fits as well";
  EXPECT_GE(std::sqrt(added[0] + 0.25 * linear * linear), flexion - 0.02);
}

/// Two arms side by side, a marker 10 mm beside each shoulder and 0.3 m beside each elbow; all is seen as the
/// model has it at `pose`, but the second hand by `beyond_m` out of reach. What is added without the marker
/// of each upper arm, the second one's by request.
Eigen::VectorXd lacks_of_two_arms(double beyond_m, bool second_upper_is_seen) {
  auto m = arm_with_lever(0.01);
  const auto second = arm_with_lever(0.01);
  for (const auto& body : second.bodies) m.bodies.push_back(body);
  for (auto coordinate : second.coordinates) {
    coordinate.name += "_2";
    m.coordinates.push_back(coordinate);
  }
  for (auto joint : second.joints) {
    joint.name += "_2";
    if (joint.parent_body_idx >= 0) joint.parent_body_idx += 2;
    joint.child_body_idx += 2;
    for (auto& axis : joint.axes) axis.coordinate_idx += 2;
    m.joints.push_back(joint);
  }
  m.bodies[2].name = "upper_2";
  m.bodies[3].name = "fore_2";
  for (auto marker : second.markers) {
    marker.name += "2";
    marker.body_idx += 2;
    m.markers.push_back(marker);
  }
  const auto model = model::Model::compile(m).value();
  auto all =
      data::Trajectories::all_missing({"U", "H", "U2", "H2"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1});
  model::Workspace w(model);
  const Eigen::VectorXd x = model::state_from_coordinates(model, Eigen::Vector4d(0.4, 1.0, 0.3, 0.02));
  model::kinematics(model, w, x);
  Eigen::Matrix3Xd y = w.marker;
  y.col(3) *= 1.0 + beyond_m / y.col(3).norm();
  for (int i = 0; i < 4; ++i) {
    all.x(0, i) = y.col(i);
    all.state[all.index(0, i)] = data::SampleState::measured;
  }
  const auto problem = make_problem(model, all, {}).value();
  ProfileErrors profile(problem);
  Eigen::VectorXd variance = Eigen::Vector4d::Zero();
  const Eigen::Vector4d seen(1.0, 0.0, second_upper_is_seen ? 1.0 : 0.0, 1.0);
  profile.add(x, y, seen / (kSd_m * kSd_m), Eigen::Vector4d::Ones() / (kSd_m * kSd_m),
              Eigen::Matrix4d::Identity(), variance);
  return variance;
}

TEST(ProfileErrors, ALimbThatSwingsToAndFroHidesNoOther) {
  // The second arm is stretched towards a hand out of its reach: to first order nothing holds its elbow, and
  // full steps overshoot for ever. What the first one lacks has nothing to do with it.
  const double alone = lacks(0.01, {0.4, 1.0}, {1.0, 0.0})[0];
  ASSERT_GT(alone, 0.04);
  for (const bool seen : {true, false})
    for (const double beyond_m : {0.0, 0.02, 0.1}) {
      const auto added = lacks_of_two_arms(beyond_m, seen);
      EXPECT_NEAR(added[0], alone, 2e-3) << beyond_m;
    }
}

}  // namespace
}  // namespace kinemark::motion::internal
