// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// models/macaque_arm.osim: it is what its script writes, and it wears the simulated sleeve.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/math/euler.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/simulation/limb.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::filesystem::path path() { return testing_support::project_folder() / "models" / "macaque_arm.osim"; }

TEST(MacaqueFile, IsWhatTheScriptWrites) {
  const testing_support::ScratchFolder scratch;
  const auto script = testing_support::project_folder() / "tools" / "macaque_model.py";
  const std::string command =
      "python3 -B '" + script.string() + "' '" + (scratch / "macaque_arm.osim").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  EXPECT_EQ(io::read_text(path()).value(), io::read_text(scratch / "macaque_arm.osim").value())
      << "run tools/macaque_model.py and commit what it writes";
}

TEST(MacaqueArm, IsAnArmOfSevenFreedoms) {
  const auto description = io::read_osim(path()).value();
  EXPECT_TRUE(description.warnings.empty());
  const auto arm = model::Model::compile(description).value();
  EXPECT_EQ(arm.speed_count(), 7);
  EXPECT_EQ(arm.marker_count(), 16);
  double mass = 0.0;
  for (const auto& body : description.bodies) mass += body.mass;
  EXPECT_NEAR(mass, 0.48, 0.02);  // kg
  for (const char* name : {"shoulder_adduction", "shoulder_flexion", "shoulder_rotation", "elbow_flexion",
                           "pronation", "wrist_flexion", "wrist_deviation"})
    EXPECT_GE(description.find_coordinate(name), 0) << name;
}

/// Segment axes (z along the bone away from the shoulder, x the hinge) in those of the model's bodies.
Matrix3d body_from_segment() {
  Matrix3d out;
  out << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  return out;
}

/// Pose of a segment from its true markers.
Matrix3d world_from_body(const LimbRecording& limb, std::int64_t frame, int segment) {
  const Eigen::Map<const Eigen::Matrix3Xd> x(limb.x_true.data() + 3 * (16 * frame + 8 * segment), 3, 8);
  const Eigen::Matrix4d pose = Eigen::umeyama(limb.x_in_segment[static_cast<std::size_t>(segment)], x, false);
  return pose.topLeftCorner<3, 3>() * body_from_segment().transpose();
}

TEST(MacaqueArm, WearsTheSleeveInEveryFrame) {
  SleeveOptions options;
  options.duration_s = 20.0;
  const auto limb = simulate_sleeve(options).value();
  const auto description = io::read_osim(path()).value();
  const auto arm = model::Model::compile(description).value();
  model::Workspace w(arm);
  Matrix3d axes = Matrix3d::Identity();
  axes.col(1) = -Vector3d::UnitY();
  const auto set = [&](Eigen::VectorXd& q, const char* name, double value) {
    const auto c = static_cast<std::size_t>(description.find_coordinate(name));
    q[static_cast<Eigen::Index>(c)] = value;
    EXPECT_GE(value, description.coordinates[c].range_min) << name;
    EXPECT_LE(value, description.coordinates[c].range_max) << name;
  };
  Vector3d shoulder = Vector3d::Zero();
  for (std::int64_t f = 0; f < limb.markers.frames(); f += 7) {
    const Matrix3d upper = world_from_body(limb, f, 0), lower = world_from_body(limb, f, 1);
    shoulder = math::to_angles_about(axes, upper, shoulder);
    // Hinge first, then the rotation about the forearm.
    const Matrix3d elbow = upper.transpose() * lower;
    const double flexion = std::acos(std::clamp(elbow(2, 2), -1.0, 1.0));
    const Matrix3d rotation = math::axis_angle(-Vector3d::UnitY(), flexion).transpose() * elbow;
    Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
    set(q, "shoulder_adduction", shoulder[0]);
    set(q, "shoulder_flexion", shoulder[1]);
    set(q, "shoulder_rotation", shoulder[2]);
    set(q, "elbow_flexion", flexion);
    set(q, "pronation", std::atan2(rotation(1, 0), rotation(0, 0)));
    model::kinematics(arm, w, model::state_from_coordinates(arm, q));
    for (std::size_t i = 0; i < description.markers.size(); ++i) {
      const auto& name = description.markers[i].name;
      const auto& marker = arm.markers()[i];
      const auto m = limb.markers.find(name);
      ASSERT_GE(m, 0);
      const Vector3d truth = Eigen::Map<const Vector3d>(limb.x_true.data() + 3 * limb.markers.index(f, m));
      EXPECT_LT((model::point_in_world(w, marker.body, marker.x_in_body) - truth).norm(), 1e-9)
          << name << " in frame " << f;
    }
  }
}

}  // namespace
}  // namespace kinemark::simulation
