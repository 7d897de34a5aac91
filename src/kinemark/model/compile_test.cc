// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"

namespace kinemark::model {
namespace {

using testing::random_tree;

// One body with six axes on the ground, each turn and shift about the axis `order` names, `sign` on its
// direction.
data::ModelDescription floating(const std::array<int, 3>& order, const std::array<double, 3>& sign) {
  data::ModelDescription d;
  d.bodies.push_back({.name = "pelvis", .mass = 1.0});
  data::JointDescription joint{.name = "root", .type = "CustomJoint"};
  joint.parent_from_joint.translation = {0.1, 0.2, 0.3};
  joint.child_from_joint.translation = {-0.3, 0.1, 0.0};
  for (const bool rotation : {true, false})
    for (std::size_t i = 0; i < 3; ++i) {
      data::AxisDescription axis;
      axis.is_rotation = rotation;
      axis.axis = sign[i] * Vector3d::Unit(order[i]);
      axis.coordinate_idx = static_cast<int>(d.coordinates.size());
      d.coordinates.push_back({.name = (rotation ? "r" : "t") + std::to_string(i), .is_rotation = rotation});
      joint.axes.push_back(axis);
    }
  d.joints.push_back(joint);
  d.markers.push_back({.name = "m", .body_idx = 0, .x_in_body = {0.3, -0.1, 0.2}});
  return d;
}

TEST(Compile, FindsAFreeRootInEveryOrderAndSign) {
  std::array<int, 3> order{0, 1, 2};
  int tried = 0;
  do {
    for (int signs = 0; signs < 8; ++signs, ++tried) {
      const auto description =
          floating(order, {signs & 1 ? -1.0 : 1.0, signs & 2 ? -1.0 : 1.0, signs & 4 ? -1.0 : 1.0});
      const Model free = Model::compile(description).value();
      const Model euler = Model::compile(description, {.free_roots = false}).value();
      ASSERT_EQ(free.free_joints().size(), 1u);
      EXPECT_EQ(free.state_count(), 7);
      EXPECT_EQ(free.speed_count(), 6);
      EXPECT_EQ(euler.state_count(), 6);
      VectorXd q(6), back;
      q << 0.4, -0.9, 1.3, 0.5, -0.6, 0.7;
      Workspace wf(free), we(euler);
      kinematics(free, wf, state_from_coordinates(free, q));
      kinematics(euler, we, state_from_coordinates(euler, q));
      EXPECT_LT((wf.marker - we.marker).norm(), 1e-14);
      coordinates_from_state(free, state_from_coordinates(free, q), q, back);
      EXPECT_LT((back - q).norm(), 1e-14);
    }
  } while (std::ranges::next_permutation(order).found);
  EXPECT_EQ(tried, 48);
}

TEST(Compile, KeepsARootThatIsNotFree) {
  const auto free_joints = [](const data::ModelDescription& d) {
    return Model::compile(d).value().free_joints().size();
  };
  const auto plain = floating({2, 0, 1}, {1, 1, 1});
  ASSERT_EQ(free_joints(plain), 1u);
  auto d = plain;
  d.coordinates[1].locked = true;
  EXPECT_EQ(free_joints(d), 0u) << "locked";
  d = plain;
  d.joints[0].axes[0].function = math::ScalarFunction::linear(2.0, 0.0);
  EXPECT_EQ(free_joints(d), 0u) << "geared";
  d = plain;
  d.joints[0].axes[1].axis = {0.1, 1.0, 0.0};
  EXPECT_EQ(free_joints(d), 0u) << "oblique";
  d = plain;
  d.joints[0].axes[5].coordinate_idx = 4;
  EXPECT_EQ(free_joints(d), 0u) << "two axes, one coordinate";
  d = plain;
  d.couplings.push_back({.name = "c", .dependent_idx = 3, .independent_idx = 0});
  EXPECT_EQ(free_joints(d), 0u) << "coupled";
  d = plain;
  d.joints[0].axes.pop_back();
  EXPECT_EQ(free_joints(d), 0u) << "five axes";
}

TEST(Compile, PutsParentsFirstAndKeepsTheCorrespondence) {
  const auto description = random_tree(7);
  const Model model = Model::compile(description).value();
  ASSERT_EQ(model.bodies().size(), description.bodies.size());
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    const auto& body = model.bodies()[b];
    EXPECT_LT(body.parent, static_cast<int>(b));
    EXPECT_EQ(model.body_of(body.description_idx), static_cast<int>(b));
    EXPECT_EQ(body.mass, description.bodies[static_cast<std::size_t>(body.description_idx)].mass);
  }
  EXPECT_EQ(model.body_of(data::kGround), data::kGround);
}

TEST(Compile, GivesNoSpeedToCoupledOrIdleCoordinates) {
  const Model model = Model::compile(random_tree(1)).value();
  const auto& d = model.description();
  for (const char* name : {"idle", "idle_slave", "patella", "chain1", "chain2"})
    EXPECT_EQ(model.coordinates()[static_cast<std::size_t>(d.find_coordinate(name))].speed_idx, -1) << name;
  // Six of the free root, a0 a1 a2 knee two0 two1 pin last slide.
  EXPECT_EQ(model.speed_count(), 15);
  EXPECT_EQ(model.state_count(), 16);
}

TEST(Compile, OrdersCoordinatesSourcesFirst) {
  const Model model = Model::compile(random_tree(1)).value();
  std::vector<bool> done(static_cast<std::size_t>(model.coordinate_count()), false);
  for (const int c : model.coordinate_order()) {
    const int source = model.coordinates()[static_cast<std::size_t>(c)].source;
    EXPECT_TRUE(source < 0 || done[static_cast<std::size_t>(source)]);
    done[static_cast<std::size_t>(c)] = true;
  }
  EXPECT_TRUE(std::ranges::all_of(done, [](bool b) { return b; }));
}

TEST(Compile, DefaultStateHasTheDefaultValues) {
  const Model model = Model::compile(random_tree(5)).value();
  VectorXd q;
  coordinates_from_state(model, model.default_state(), VectorXd::Zero(model.coordinate_count()), q);
  for (int c = 0; c < model.coordinate_count(); ++c) {
    if (model.coordinates()[static_cast<std::size_t>(c)].source >= 0) continue;
    EXPECT_NEAR(q[c], model.description().coordinates[static_cast<std::size_t>(c)].default_value, 1e-13);
  }
}

TEST(Compile, PassesOnWhatValidateSays) {
  auto d = random_tree(0);
  d.joints.pop_back();
  const auto status = d.validate();
  const auto model = Model::compile(d);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().message, status.error().message);
}

}  // namespace
}  // namespace kinemark::model
