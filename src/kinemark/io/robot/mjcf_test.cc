// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/io/robot/robot_file.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

using data::ModelDescription;
using Eigen::Vector3d;
using math::ScalarFunction;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// "thigh" on the ground by the slide "up" and the hinge "hip", "shank" on it by the hinge "knee".
ModelDescription leg() {
  ModelDescription model{.name = "leg"};
  model.bodies = {{.name = "thigh", .mass = 7.0, .inertia_about_com = Eigen::Matrix3d::Identity()},
                  {.name = "shank", .mass = 3.0, .inertia_about_com = Eigen::Matrix3d::Identity()}};
  model.coordinates = {
      {.name = "hip"}, {.name = "up", .is_rotation = false, .default_value = 0.9}, {.name = "knee"}};
  data::JointDescription hip{.name = "h", .type = "CustomJoint"}, knee{.name = "k", .type = "CustomJoint"};
  hip.axes = {{.axis = {0, 0, 1}, .coordinate_idx = 0},
              {.is_rotation = false, .axis = {0, 1, 0}, .coordinate_idx = 1}};
  knee.parent_body_idx = 0;
  knee.child_body_idx = 1;
  knee.parent_from_joint.translation = {0.0, -0.4, 0.0};
  knee.axes = {{.axis = {0, 0, 1}, .coordinate_idx = 2}};
  model.joints = {knee, hip};  // the child first
  return model;
}

/// What was written, read again.
struct Sheet {
  explicit Sheet(const ModelDescription& model) {
    auto text = mjcf_of(model);
    EXPECT_TRUE(document.load_string(text.text.c_str()));
    lost = std::move(text.lost);
  }
  [[nodiscard]] std::string value(const std::string& path, const char* attribute) const {
    return document.select_node(path.c_str()).node().attribute(attribute).value();
  }
  [[nodiscard]] std::size_t count(const char* path) const { return document.select_nodes(path).size(); }

  pugi::xml_document document;
  std::vector<std::string> lost;
};

TEST(MjcfOf, NestsTheBodiesAndKeepsTheirMotionsInOrder) {
  const Sheet file(leg());
  const auto thigh = file.document.select_node("/mujoco/worldbody/body[@name='thigh']").node();
  std::vector<std::string> names;
  for (const auto& joint : thigh.children("joint")) names.emplace_back(joint.attribute("name").value());
  EXPECT_THAT(names, ::testing::ElementsAre("up", "hip"));
  EXPECT_STREQ(thigh.child("joint").attribute("type").value(), "slide");
  EXPECT_STREQ(thigh.child("joint").attribute("axis").value(), "0 1 0");
  EXPECT_STREQ(thigh.child("body").attribute("name").value(), "shank");
  EXPECT_STREQ(thigh.child("body").attribute("pos").value(), "0 -0.4 0");
}

TEST(MjcfOf, TheDefaultPostureIsInTheOrderOfTheFilesJoints) {
  auto model = leg();
  model.coordinates[0].default_value = 0.1;
  model.coordinates[2].default_value = -0.5;
  EXPECT_EQ(Sheet(model).value("//keyframe/key[@name='default']", "qpos"), "0.9 0.1 -0.5");
}

TEST(MjcfOf, AModelOfWeldsHasNoJointAndNoPosture) {
  auto model = leg();
  for (auto& joint : model.joints) joint.axes.clear();
  const Sheet file(model);
  EXPECT_EQ(file.count("//joint"), 0u);
  EXPECT_EQ(file.count("//keyframe"), 0u);
  EXPECT_EQ(file.count("//body"), 2u);
}

TEST(MjcfOf, ALockedCoordinateMovesItsBodyForGood) {
  auto model = leg();
  model.coordinates[1].locked = true;
  const Sheet file(model);
  EXPECT_EQ(file.value("//body[@name='thigh']", "pos"), "0 0.9 0");
  EXPECT_EQ(file.count("//joint[@name='up']"), 0u);
}

TEST(MjcfOf, AJointStandsWhereTheBodyHasIt) {
  auto model = leg();
  model.joints[0].child_from_joint = {math::axis_angle(Vector3d::UnitX(), std::numbers::pi / 2.0),
                                      {0.0, 0.3, 0.0}};
  const Sheet file(model);
  const auto vector = [&](const char* attribute) {
    Vector3d v = Vector3d::Zero();
    const std::string text = file.value("//joint[@name='knee']", attribute);
    EXPECT_EQ(std::sscanf(text.c_str(), "%lf %lf %lf", &v.x(), &v.y(), &v.z()), 3) << text;
    return v;
  };
  EXPECT_LT((vector("pos") - Vector3d(0.0, 0.3, 0.0)).norm(), 1e-15);
  EXPECT_LT((vector("axis") - Vector3d(0.0, -1.0, 0.0)).norm(), 1e-15) << "z of the joint is -y of the body";
}

TEST(MjcfOf, OnlyClampedCoordinatesAreLimited) {
  auto model = leg();
  model.coordinates[0].range_min = -1.5;
  model.coordinates[0].range_max = 0.5;
  EXPECT_EQ(Sheet(model).value("//joint[@name='hip']", "limited"), "");
  model.coordinates[0].clamped = true;
  EXPECT_EQ(Sheet(model).value("//joint[@name='hip']", "limited"), "true");
  EXPECT_EQ(Sheet(model).value("//joint[@name='hip']", "range"), "-1.5 0.5");
}

TEST(MjcfOf, ACoordinateThatDrivesTwoJointsIsOneOfThemAndLeadsTheOther) {
  auto model = leg();
  model.joints[0].axes[0].coordinate_idx = 0;
  model.joints[0].axes[0].function = ScalarFunction::polynomial({0.0, 1.0, 0.25});
  const Sheet file(model);
  EXPECT_EQ(file.count("//equality/joint"), 1u);
  EXPECT_EQ(file.value("//equality/joint", "joint1"), "k_1");
  EXPECT_EQ(file.value("//equality/joint", "joint2"), "hip");
  EXPECT_EQ(file.count("//body[@name='shank']/joint[@name='k_1']"), 1u);
}

TEST(MjcfOf, GravityAndMarkersAreKept) {
  auto model = leg();
  model.gravity = {0.0, 0.0, -1.62};
  model.markers = {{.name = "KNEE", .body_idx = 1, .x_in_body = {0.05, 0.0, -0.25}}, {.name = "FLOOR"}};
  const Sheet file(model);
  EXPECT_EQ(file.value("//option", "gravity"), "0 0 -1.62");
  EXPECT_EQ(file.value("//body[@name='shank']/site[@name='KNEE']", "pos"), "0.05 0 -0.25");
  EXPECT_EQ(file.value("//worldbody/site[@name='FLOOR']", "pos"), "0 0 0");
  EXPECT_THAT(file.lost, Not(Contains(HasSubstr("cannot be stored"))));
}

TEST(MjcfOf, ABodyWithoutMassAndAnInertiaOfZeroAreSaid) {
  auto model = leg();
  model.bodies[0].mass = 0.0;
  model.bodies[1].inertia_about_com.setZero();
  const Sheet file(model);
  EXPECT_EQ(file.count("//body[@name='thigh']/inertial"), 0u);
  EXPECT_EQ(file.value("//body[@name='shank']/inertial", "fullinertia"), "1e-09 1e-09 1e-09 0 0 0");
  EXPECT_THAT(file.lost, Contains("1 body without mass gets 1e-9 kg in MuJoCo: thigh"));
  EXPECT_THAT(file.lost, Contains(HasSubstr("no rigid body can have, is changed to one that it can: shank")));
}

TEST(MjcfOf, NamesAreLegalAndTheFollowerKnowsThem) {
  auto model = leg();
  model.coordinates[0].name = "hip \"flexion\"";
  model.coordinates[2].name = "knee <angle>";
  model.couplings.push_back(
      {.name = "c", .dependent_idx = 2, .independent_idx = 0, .function = ScalarFunction::linear(2.0, 0.5)});
  const Sheet file(model);
  EXPECT_EQ(file.value("//equality/joint", "joint1"), "knee__angle_");
  EXPECT_EQ(file.value("//equality/joint", "joint2"), "hip__flexion_");
  EXPECT_EQ(file.value("//equality/joint", "polycoef"), "0.5 2 0 0 0");
  EXPECT_EQ(file.count("//body/joint[@name='knee__angle_']"), 1u);
}

}  // namespace
}  // namespace kinemark::io
