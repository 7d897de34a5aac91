// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/profile_errors.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

/// Pelvis on a ball joint at the origin, thigh on one 0.18 m from it, knee 0.4 m further: three coordinates
/// of back and hip, and the knee's. Markers: on the pelvis, in the knee, 0.15 m down the shank.
model::Model leg() {
  data::ModelDescription m;
  m.name = "leg";
  const std::vector<Eigen::Vector3d> xyz = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                            Eigen::Vector3d::UnitZ()};
  const auto joint = [&](const char* name, int parent, const Eigen::Vector3d& at,
                         const std::vector<Eigen::Vector3d>& axes) {
    data::JointDescription joint{.name = name, .parent_body_idx = parent, .child_body_idx = parent + 1};
    joint.parent_from_joint = {Eigen::Matrix3d::Identity(), at};
    for (const auto& axis : axes) {
      m.coordinates.push_back({.name = fmt::format("{}_{}", name, joint.axes.size())});
      joint.axes.push_back(
          {.is_rotation = true, .axis = axis, .coordinate_idx = static_cast<int>(m.coordinates.size()) - 1});
    }
    m.bodies.push_back({.name = name, .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity() * 0.01});
    m.joints.push_back(joint);
  };
  joint("back", -1, Eigen::Vector3d::Zero(), xyz);
  joint("hip", 0, {0.177, 0.0, 0.0}, xyz);
  joint("knee", 1, {0.4, 0.0, 0.0}, {Eigen::Vector3d::UnitZ()});
  m.markers = {{.name = "P", .body_idx = 0, .x_in_body = {0.1, 0.1, 0.1}},
               {.name = "K", .body_idx = 1, .x_in_body = {0.4, 0.0, 0.0}},
               {.name = "S", .body_idx = 2, .x_in_body = {0.151, 0.0, 0.0}}};
  return model::Model::compile(m).value();
}

TEST(ProfileErrors, AKneeThatTurnsBackAlongWhatIsOpenIsNotKnownToADegree) {
  // Back, hip, knee and shank lie in one plane, back to knee nearly straight, and only knee and shank are
  // seen: the knee's angle is at its largest, and first order knows it to less than a degree. What is held of
  // back and hip is made up for by the rest of them, and shows nothing.
  const auto model = leg();
  auto all = data::Trajectories::all_missing({"P", "K", "S"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1});
  model::Workspace w(model);
  Eigen::VectorXd pose = Eigen::VectorXd::Zero(7);
  pose << 0.0, 0.0, 0.17, 0.0, 0.0, -0.14, 1.57;
  const Eigen::VectorXd x = model::state_from_coordinates(model, pose);
  model::kinematics(model, w, x);
  for (int i = 0; i < 3; ++i) {
    all.x(0, i) = w.marker.col(i);
    all.state[all.index(0, i)] = data::SampleState::measured;
  }
  const auto problem = make_problem(model, all, {}).value();
  ProfileErrors profile(problem);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(7);
  profile.add(x, w.marker, Eigen::Vector3d(0.0, 1.0, 1.0) / 1e-6, Eigen::Vector3d::Ones() / 1e-6,
              Eigen::MatrixXd::Identity(7, 7), variance);
  EXPECT_GT(std::sqrt(variance[6]), 0.08);
}

}  // namespace
}  // namespace kinemark::motion::internal
