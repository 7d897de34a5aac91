// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/model_difference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace kinemark::io::osim {
namespace {

using data::ModelDescription;
using Eigen::Vector3d;

/// One of everything that a description holds.
ModelDescription arm() {
  ModelDescription model{.name = "arm"};
  model.bodies = {{.name = "upper", .mass = 2.0}, {.name = "lower arm", .mass = 1.0}};
  model.coordinates = {{.name = "shoulder"}, {.name = "elbow"}};
  model.joints = {{.name = "shoulder_joint", .type = "CustomJoint", .child_body_idx = 0},
                  {.name = "elbow_joint", .type = "CustomJoint", .parent_body_idx = 0, .child_body_idx = 1}};
  for (int j = 0; j < 2; ++j)
    model.joints[static_cast<std::size_t>(j)].axes = {{.axis = Vector3d::UnitZ(), .coordinate_idx = j}};
  model.couplings = {{.name = "follows", .dependent_idx = 1, .independent_idx = 0}};
  model.point_constraints = {{.name = "loop", .body_a_idx = 0, .body_b_idx = 1}};
  model.markers = {{.name = "ELB", .body_idx = 1, .x_in_body = Vector3d(0.1, 0.2, 0.3)}};
  return model;
}

/// What is said of a change.
std::string after(const std::function<void(ModelDescription&)>& change) {
  ModelDescription changed = arm();
  change(changed);
  return difference_of(arm(), changed);
}

TEST(DifferenceOf, nothing_is_said_of_the_same_of_rounding_and_of_another_order) {
  EXPECT_EQ(difference_of(arm(), arm()), "");
  EXPECT_EQ(after([](auto& m) { m.markers[0].x_in_body.x() += 1e-10; }), "");
  EXPECT_EQ(after([](auto& m) { m.credits = "somebody"; }), "");
  EXPECT_EQ(after([](auto& m) { m.bodies[1].name = "lower_arm"; }), "") << "as OpenSim itself renames it";
  EXPECT_EQ(after([](auto& m) { std::swap(m.joints[0], m.joints[1]); }), "");
  EXPECT_EQ(after([](auto& m) {
              std::swap(m.bodies[0], m.bodies[1]);
              for (auto& joint : m.joints) {
                joint.child_body_idx = 1 - joint.child_body_idx;
                if (joint.parent_body_idx >= 0) joint.parent_body_idx = 1;
              }
              std::swap(m.point_constraints[0].body_a_idx, m.point_constraints[0].body_b_idx);
              m.markers[0].body_idx = 0;
            }),
            "");
}

TEST(DifferenceOf, the_first_part_that_differs_is_named) {
  EXPECT_EQ(after([](auto& m) { m.gravity.z() = 1.0; }), "gravity");
  EXPECT_EQ(after([](auto& m) { m.bodies[1].mass = 1.1; }), "body 'lower_arm'");
  EXPECT_EQ(after([](auto& m) { m.bodies[0].com_in_body.y() = 1e-8; }), "body 'upper'");
  EXPECT_EQ(after([](auto& m) { m.coordinates[0].locked = true; }), "coordinate 'shoulder'");
  EXPECT_EQ(after([](auto& m) { m.couplings[0].function = math::ScalarFunction::linear(2.0, 0.0); }),
            "coupling 'follows'");
  EXPECT_EQ(after([](auto& m) { m.point_constraints[0].point_in_b.x() = 0.1; }), "point constraint 'loop'");
  EXPECT_EQ(after([](auto& m) { m.markers[0].body_idx = data::kGround; }), "marker 'ELB'");
}

TEST(DifferenceOf, every_part_of_a_joint_counts) {
  const std::vector<std::function<void(data::JointDescription&)>> changes{
      [](auto& j) { j.parent_body_idx = data::kGround; },
      [](auto& j) { j.parent_from_joint.translation.x() = 0.01; },
      [](auto& j) { j.child_from_joint.rotation(0, 1) = 1e-6; },
      [](auto& j) { j.axes[0].axis = Vector3d::UnitX(); },
      [](auto& j) { j.axes[0].coordinate_idx = 0; },
      [](auto& j) { j.axes[0].function = math::ScalarFunction::linear(1.0, 1e-3); },
      [](auto& j) { j.axes[0].is_rotation = false; },
      [](auto& j) { j.axes.clear(); }};
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_EQ(after([&](auto& m) { changes[i](m.joints[1]); }), "joint 'elbow_joint'") << i;
}

TEST(DifferenceOf, parts_that_are_missing_or_too_many_count) {
  EXPECT_EQ(after([](auto& m) { m.markers.clear(); }), "marker 'ELB'");
  EXPECT_EQ(after([](auto& m) { m.markers.push_back({.name = "NEW"}); }), "the number of markers");
}

}  // namespace
}  // namespace kinemark::io::osim
