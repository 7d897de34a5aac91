// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/simple_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

using data::AxisDescription;
using data::CoordinateDescription;
using data::ModelDescription;
using Eigen::Vector3d;
using math::ScalarFunction;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

/// A chain of bodies "b0", "b1", ... each on the one before, by joints "j0", "j1", ...
void add_body(ModelDescription& model, std::vector<AxisDescription> axes) {
  const int n = static_cast<int>(model.bodies.size());
  model.bodies.push_back({.name = "b" + std::to_string(n), .mass = 1.0});
  model.joints.push_back({.name = "j" + std::to_string(n),
                          .type = "CustomJoint",
                          .parent_body_idx = n - 1,
                          .child_body_idx = n,
                          .axes = std::move(axes)});
}

AxisDescription turn(int coordinate, ScalarFunction function = ScalarFunction::linear(1.0, 0.0)) {
  return {.axis = Vector3d::UnitZ(), .coordinate_idx = coordinate, .function = std::move(function)};
}

AxisDescription slide(int coordinate, ScalarFunction function = ScalarFunction::linear(1.0, 0.0)) {
  return {.is_rotation = false, .coordinate_idx = coordinate, .function = std::move(function)};
}

CoordinateDescription hinge(const char* name, double low = -1.0, double high = 1.0) {
  return {.name = name, .range_min = low, .range_max = high};
}

/// Where a chain has its body, by the joints' values in their order.
math::SE3 placed(const SimpleChain& chain, const std::vector<double>& values) {
  math::SE3 pose = chain.parent_from_chain;
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const auto& joint = chain.joints[i];
    pose = pose * (joint.is_rotation ? math::SE3{.rotation = math::axis_angle(joint.axis, values.at(i))}
                                     : math::SE3{.translation = joint.axis * values.at(i)});
  }
  return pose * chain.chain_from_body;
}

TEST(SimpleTreeOf, AWeldIsAChainWithoutJointsWhereTheModelHasTheBody) {
  ModelDescription model;
  add_body(model, {});
  auto& weld = model.joints[0];
  weld.parent_from_joint = {math::axis_angle(Vector3d::UnitZ(), kPi / 2.0), {1.0, 0.0, 0.0}};
  weld.child_from_joint = {.translation = {0.0, 2.0, 0.0}};
  const auto tree = simplify(model, 4);
  ASSERT_EQ(tree.chains.size(), 1u);
  EXPECT_THAT(tree.chains[0].joints, IsEmpty());
  EXPECT_EQ(tree.chains[0].parent_body_idx, data::kGround);
  // The body's origin is 2 m below the joint in its own y, which is the world's -x after the quarter turn.
  EXPECT_LT((placed(tree.chains[0], {}).translation - Vector3d(3.0, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_THAT(tree.lost, IsEmpty());
}

TEST(SimpleTreeOf, ParentsComeFirstWhateverTheOrderOfTheJoints) {
  ModelDescription model;
  for (int i = 0; i < 4; ++i) add_body(model, {});
  std::ranges::reverse(model.joints);
  std::vector<int> order;
  for (const auto& chain : simplify(model, 4).chains) order.push_back(chain.body_idx);
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3));
}

TEST(SimpleTreeOf, OffsetsAndSignsOfALineGoIntoTheFrameAndTheAxis) {
  ModelDescription model;
  model.coordinates = {hinge("q"), hinge("x")};
  model.coordinates[1].is_rotation = false;
  add_body(model, {turn(0, ScalarFunction::linear(-1.0, 0.3)), slide(1, ScalarFunction::linear(1.0, 0.2))});
  const auto tree = simplify(model, 4);
  ASSERT_EQ(tree.chains[0].joints.size(), 2u);
  EXPECT_EQ(tree.chains[0].joints[0].name, "x") << "translations come first";
  EXPECT_EQ(tree.chains[0].joints[1].name, "q");
  const auto pose = placed(tree.chains[0], {0.5, 0.7});
  EXPECT_LT((pose.translation - Vector3d(0.7, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_TRUE(pose.rotation.isApprox(math::axis_angle(Vector3d::UnitZ(), 0.3 - 0.7), 1e-14));
  EXPECT_THAT(tree.lost, IsEmpty());
  EXPECT_THAT(tree.couplings, IsEmpty());
}

TEST(SimpleTreeOf, AConstantTurnBetweenTwoHingesTurnsTheSecondAxis) {
  ModelDescription model;
  model.coordinates = {hinge("first"), hinge("second")};
  auto fixed = turn(-1, ScalarFunction::constant(kPi / 2.0));
  auto second = turn(1);
  second.axis = Vector3d(5.0, 0.0, 0.0);  // of no unit length
  add_body(model, {turn(0), fixed, second});
  const auto chain = simplify(model, 4).chains.at(0);
  ASSERT_EQ(chain.joints.size(), 2u);
  EXPECT_LT((chain.joints[1].axis - Vector3d::UnitY()).norm(), 1e-15);
  const Eigen::Matrix3d expected =
      math::axis_angle(Vector3d::UnitZ(), 0.4 + kPi / 2.0) * math::axis_angle(Vector3d::UnitX(), -0.6);
  EXPECT_TRUE(placed(chain, {0.4, -0.6}).rotation.isApprox(expected, 1e-14));
}

TEST(SimpleTreeOf, ACoordinateThatDrivesTwoJointsLeadsTheSecond) {
  ModelDescription model;
  model.coordinates = {hinge("spine")};
  model.coordinates[0].default_value = 0.25;
  add_body(model, {turn(0)});
  add_body(model, {turn(0, ScalarFunction::linear(2.0, 0.1))});
  const auto tree = simplify(model, 1);
  EXPECT_EQ(tree.chains[0].joints.at(0).name, "spine");
  EXPECT_EQ(tree.chains[0].joints[0].coordinate_idx, 0);
  const auto& second = tree.chains[1].joints.at(0);
  EXPECT_EQ(second.name, "j1_1");
  EXPECT_EQ(second.coordinate_idx, -1);
  EXPECT_DOUBLE_EQ(second.default_value, 0.6);
  ASSERT_EQ(tree.couplings.size(), 1u);
  EXPECT_EQ(tree.couplings[0].dependent, "j1_1");
  EXPECT_EQ(tree.couplings[0].independent, "spine");
  EXPECT_THAT(tree.couplings[0].function.coefficients, ElementsAre(0.1, 2.0));
  EXPECT_THAT(tree.lost, IsEmpty());
}

TEST(SimpleTreeOf, TheNameOfAFollowerIsNoOtherJoints) {
  ModelDescription model;
  model.coordinates = {hinge("q"), hinge("j1_1")};
  add_body(model, {turn(0), turn(1)});
  add_body(model, {turn(0)});
  EXPECT_EQ(simplify(model, 4).chains[1].joints.at(0).name, "j1_1_");
}

/// "b0" turns by "lead", "b1" by "second", which follows by `function`.
ModelDescription coupled(ScalarFunction function) {
  ModelDescription model;
  model.coordinates = {hinge("lead"), hinge("second")};
  model.coordinates[0].default_value = 0.5;
  add_body(model, {turn(0)});
  add_body(model, {turn(1)});
  model.couplings.push_back(
      {.name = "c", .dependent_idx = 1, .independent_idx = 0, .function = std::move(function)});
  return model;
}

TEST(SimpleTreeOf, ACoupledCoordinateKeepsItsOwnJoint) {
  const auto tree = simplify(coupled(ScalarFunction::linear(-0.5, 0.2)), 1);
  const auto& joint = tree.chains[1].joints.at(0);
  EXPECT_EQ(joint.name, "second");
  EXPECT_EQ(joint.coordinate_idx, 1);
  EXPECT_DOUBLE_EQ(joint.default_value, -0.05) << "it is where it follows, not at its own default";
  ASSERT_EQ(tree.couplings.size(), 1u);
  EXPECT_EQ(tree.couplings[0].dependent, "second");
  EXPECT_THAT(tree.couplings[0].function.coefficients, ElementsAre(0.2, -0.5));
  EXPECT_THAT(tree.lost, IsEmpty());
}

TEST(SimpleTreeOf, ACurvedCouplingSaysItsErrorInDegrees) {
  const auto model = coupled(ScalarFunction::polynomial({0.0, 0.0, 0.1}));
  EXPECT_THAT(simplify(model, 2).lost, IsEmpty());
  // The best line to 0.1 x^2 on -1..1 is 0.05, off by 0.05 rad.
  EXPECT_THAT(
      simplify(model, 1).lost,
      ElementsAre("coordinate 'second' follows 'lead' by a polynomial of degree 1, at most 2.86 deg off"));
}

TEST(SimpleTreeOf, ACoordinateFollowsThroughOneThatHasNoJoint) {
  auto model = coupled(ScalarFunction::linear(2.0, 0.1));
  // "second" has no joint of its own; "third" follows it, and a slide moves by it.
  model.coordinates.push_back(hinge("third"));
  model.joints[1].axes = {turn(2), slide(1, ScalarFunction::linear(0.1, 0.0))};
  model.couplings.push_back(
      {.name = "d", .dependent_idx = 2, .independent_idx = 1, .function = ScalarFunction::linear(3.0, 0.0)});
  const auto tree = simplify(model, 1);
  EXPECT_THAT(tree.lost, IsEmpty());
  ASSERT_EQ(tree.couplings.size(), 2u);
  EXPECT_EQ(tree.couplings[0].dependent, "j1_2");
  EXPECT_NEAR(tree.couplings[0].function(0.7), 0.1 * (2.0 * 0.7 + 0.1), 1e-12);
  EXPECT_EQ(tree.couplings[1].dependent, "third");
  EXPECT_EQ(tree.couplings[1].independent, "lead");
  EXPECT_NEAR(tree.couplings[1].function(0.7), 3.0 * (2.0 * 0.7 + 0.1), 1e-12);
}

TEST(SimpleTreeOf, WhatFollowsALockedCoordinateIsStillToo) {
  auto model = coupled(ScalarFunction::linear(1.0, 0.25));
  model.coordinates[0].locked = true;
  const auto tree = simplify(model, 4);
  EXPECT_THAT(tree.couplings, IsEmpty());
  EXPECT_THAT(tree.chains[1].joints, IsEmpty());
  EXPECT_TRUE(placed(tree.chains[1], {}).rotation.isApprox(math::axis_angle(Vector3d::UnitZ(), 0.75), 1e-14));
  EXPECT_THAT(tree.lost, IsEmpty());
}

TEST(SimpleTreeOf, ALockedCoordinateIsHeldAtItsDefault) {
  ModelDescription model;
  model.coordinates = {hinge("knee")};
  model.coordinates[0].locked = true;
  model.coordinates[0].default_value = 0.8;
  const auto square = ScalarFunction::polynomial({0.0, 0.0, 0.5});
  add_body(model, {turn(0), slide(0, square)});
  const auto tree = simplify(model, 1);
  EXPECT_THAT(tree.chains[0].joints, IsEmpty());
  const auto pose = placed(tree.chains[0], {});
  EXPECT_LT((pose.translation - Vector3d(0.32, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_TRUE(pose.rotation.isApprox(math::axis_angle(Vector3d::UnitZ(), 0.8), 1e-14));
  EXPECT_THAT(tree.lost, IsEmpty());
}

TEST(SimpleTreeOf, AFollowerOfACoordinateWithoutJointSaysThatItIsFree) {
  auto model = coupled(ScalarFunction::linear(1.0, 0.0));
  model.joints[0].axes.clear();
  const auto tree = simplify(model, 4);
  EXPECT_THAT(tree.couplings, IsEmpty());
  EXPECT_THAT(tree.lost,
              ElementsAre(HasSubstr("'second' follows 'lead', which has no joint of its own, and is free")));
}

TEST(SimpleTreeOf, AMotionThatNoJointMakesIsHeldAndSaid) {
  ModelDescription model;
  model.coordinates = {hinge("a", 0.0, 2.0)};
  add_body(model, {turn(0, ScalarFunction::linear(0.5, 0.0))});
  const auto tree = simplify(model, 4);
  EXPECT_THAT(tree.chains[0].joints, IsEmpty());
  // A turn of 0.5 a, and a is up to 2 rad.
  EXPECT_THAT(tree.lost,
              ElementsAre(HasSubstr("joint 'j0': its rotation 1, which no joint of one axis makes, is held "
                                    "where the default posture has it: at most 57.3 deg off")));
}

TEST(SimpleTreeOf, ACoordinateWithoutLimitsIsFittedHalfATurnToBothSides) {
  ModelDescription model;
  model.coordinates = {{.name = "free"}};
  add_body(model, {turn(0), slide(0, ScalarFunction::polynomial({0.0, 0.0, 0.01}))});
  // The best line to 0.01 x^2 on -pi..pi is off by 0.01 pi^2 / 2 = 49.3 mm.
  EXPECT_THAT(simplify(model, 1).lost, ElementsAre(HasSubstr("at most 49.3 mm off")));
}

TEST(SimpleTreeOf, ClosedLoopsAreNamedTogether) {
  ModelDescription model;
  add_body(model, {});
  model.point_constraints = {{.name = "left", .body_b_idx = 0}, {.name = "right", .body_b_idx = 0}};
  EXPECT_THAT(simplify(model, 4).lost, ElementsAre("2 closed loops are left open: left, right"));
}

}  // namespace
}  // namespace kinemark::io
