// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/robot/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <pugixml.hpp>

#include "kinemark/io/robot/legal_names.h"
#include "kinemark/io/robot/polynomial_fit.h"
#include "kinemark/io/robot/simple_tree.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using math::ScalarFunction;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A body on the ground that a coordinate turns, with a second motion by a function of the same coordinate.
data::ModelDescription two_motions(ScalarFunction second) {
  data::ModelDescription model{.name = "two"};
  model.bodies.push_back({.name = "shank",
                          .mass = 2.0,
                          .com_in_body = {0, -0.1, 0},
                          .inertia_about_com = Eigen::Vector3d(1, 2, 2.5).asDiagonal()});
  model.coordinates.push_back({.name = "knee", .range_min = -1.0, .range_max = 2.0, .clamped = true});
  data::JointDescription joint{.name = "hinge", .type = "CustomJoint"};
  joint.axes.push_back({.axis = {0, 0, 1}, .coordinate_idx = 0});
  joint.axes.push_back({.is_rotation = false, .coordinate_idx = 0, .function = std::move(second)});
  model.joints.push_back(joint);
  model.markers.push_back({.name = "M <1> & \"x\"", .body_idx = 0, .x_in_body = {0.1, 0.2, 0.3}});
  return model;
}

TEST(PolynomialFit, FindsAPolynomialOfItsDegree) {
  const auto fit = fit_polynomial([](double x) { return 1.0 - 2.0 * x + 0.5 * x * x * x; }, -1.0, 3.0, 4);
  ASSERT_EQ(fit.coefficients.size(), 5u);
  const std::vector<double> truth{1.0, -2.0, 0.0, 0.5, 0.0};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(fit.coefficients[k], truth[k], 1e-12);
  EXPECT_LT(fit.largest_error, 1e-12);
}

TEST(PolynomialFit, SaysHowFarALineIsFromASquare) {
  // The best line to x^2 on -1..1 is the constant 1/2, off by 1/2.
  EXPECT_NEAR(fit_polynomial([](double x) { return x * x; }, -1.0, 1.0, 1).largest_error, 0.5, 1e-9);
}

TEST(SimpleTree, ALineFollowsExactlyAndACurveSaysItsError) {
  const auto line = simplify(two_motions(ScalarFunction::linear(0.1, 0.02)), 4);
  ASSERT_EQ(line.couplings.size(), 1u);
  EXPECT_EQ(line.couplings[0].independent, "knee");
  EXPECT_NEAR(line.couplings[0].function(1.5), 0.17, 1e-15);
  EXPECT_THAT(line.lost, IsEmpty());
  const auto square = ScalarFunction::polynomial({0.0, 0.0, 0.01});
  EXPECT_THAT(simplify(two_motions(square), 4).lost, IsEmpty());
  // The best line to 0.01 x^2 over a range of 3 is off by 0.01 (3/2)^2 / 2 = 11.25 mm.
  EXPECT_THAT(simplify(two_motions(square), 1).lost, Contains(HasSubstr("at most 11.3 mm off")));
}

TEST(SimpleTree, AMotionByTwoCoordinatesIsHeldWithWhatItMoves) {
  auto model = two_motions(ScalarFunction{});
  model.joints[0].axes[1].second_coordinate_idx = 0;
  model.joints[0].axes[1].second_function = ScalarFunction::linear(0.1, 0.0);
  const auto tree = simplify(model, 4);
  EXPECT_EQ(tree.chains.at(0).joints.size(), 1u);
  EXPECT_THAT(tree.lost, Contains(HasSubstr("at most 400 mm off")));
}

TEST(SimpleTree, ALockedCoordinateIsStillAndALoopIsLeftOpen) {
  auto model = two_motions(ScalarFunction::constant(0.3));
  model.coordinates[0].locked = true;
  model.point_constraints.push_back({.name = "ring", .body_b_idx = 0});
  const auto tree = simplify(model, 4);
  EXPECT_TRUE(tree.chains.at(0).joints.empty());
  EXPECT_THAT(tree.lost, Contains(HasSubstr("1 closed loop is left open: ring")));
}

TEST(LegalNames, AreDistinctAndKeepThoseThatWereLegal) {
  data::ModelDescription model;
  for (const char* name : {"a b", "a_b", "world", "a<b"}) model.bodies.push_back({.name = name});
  const auto said = make_names_legal(model);
  EXPECT_EQ(model.bodies[0].name, "a_b_2");
  EXPECT_EQ(model.bodies[1].name, "a_b");
  EXPECT_EQ(model.bodies[2].name, "world_2");
  EXPECT_EQ(model.bodies[3].name, "a_b_3");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said[0], HasSubstr("3 names are changed"));
  EXPECT_THAT(make_names_legal(model), IsEmpty());
}

TEST(Mjcf, HoldsTheBodyItsRangeAndWhatFollows) {
  pugi::xml_document document;
  const auto written = mjcf_of(two_motions(ScalarFunction::linear(0.1, 0.02)));
  ASSERT_TRUE(document.load_string(written.text.c_str()));
  const auto body = document.select_node("/mujoco/worldbody/body[@name='shank']").node();
  EXPECT_STREQ(body.select_node("joint[@name='knee']").node().attribute("range").value(), "-1 2");
  EXPECT_STREQ(body.child("inertial").attribute("fullinertia").value(), "1 2 2.5 0 0 0");
  EXPECT_STREQ(body.child("inertial").attribute("pos").value(), "0 -0.1 0");
  EXPECT_STREQ(body.child("site").attribute("name").value(), "M__1_____x_");
  EXPECT_STREQ(document.select_node("//equality/joint").node().attribute("polycoef").value(),
               "0.02 0.1 0 0 0");
}

TEST(Urdf, HasOneJointALinkAndAMimic) {
  pugi::xml_document document;
  const auto written = urdf_of(two_motions(ScalarFunction::linear(0.1, 0.02)));
  ASSERT_TRUE(document.load_string(written.text.c_str()));
  EXPECT_STREQ(document.select_node("//joint[@name='knee']/child").node().attribute("link").value(), "shank");
  const auto mimic = document.select_node("//joint[@name='hinge_2']/mimic").node();
  EXPECT_STREQ(mimic.attribute("joint").value(), "knee");
  EXPECT_STREQ(mimic.attribute("multiplier").value(), "0.1");
  EXPECT_THAT(written.lost, Contains(HasSubstr("1 marker cannot be stored")));
}

TEST(Urdf, AModelWithoutMassSaysSo) {
  auto model = two_motions(ScalarFunction::constant(0.0));
  model.bodies[0].mass = 0.0;
  EXPECT_THAT(urdf_of(model).lost, Contains(HasSubstr("1 body without mass gets 1e-9 kg in MuJoCo: shank")));
}

TEST(RobotFile, RefusesAnotherEndingAndAFileThatIsThere) {
  const testing_support::ScratchFolder scratch;
  const auto model = two_motions(ScalarFunction::constant(0.0));
  EXPECT_EQ(write_robot(scratch / "a.sdf", model, false).error().code, Code::usage);
  ASSERT_TRUE(write_robot(scratch / "a.URDF", model, false));
  EXPECT_EQ(write_robot(scratch / "a.URDF", model, false).error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
