// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <pugixml.hpp>
#include <set>
#include <sstream>
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
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

data::AxisDescription axis_of(bool is_rotation, int coordinate, ScalarFunction function = {}) {
  return {.is_rotation = is_rotation, .coordinate_idx = coordinate, .function = std::move(function)};
}

/// One body on the ground by a joint of those axes, which two coordinates move: "turn" and "push".
ModelDescription one_body(std::vector<data::AxisDescription> axes) {
  ModelDescription model{.name = "one"};
  model.bodies.push_back({.name = "arm",
                          .mass = 1.5,
                          .com_in_body = {0.1, 0.2, 0.3},
                          .inertia_about_com = Eigen::Matrix3d{{3, 0.1, 0.2}, {0.1, 4, 0.3}, {0.2, 0.3, 5}}});
  model.coordinates = {{.name = "turn"}, {.name = "push", .is_rotation = false}};
  model.joints.push_back({.name = "joint", .type = "CustomJoint", .axes = std::move(axes)});
  return model;
}

/// What was written, read again.
struct Written {
  explicit Written(const ModelDescription& model) : lost(urdf_of(model).lost) {
    EXPECT_TRUE(document.load_string(urdf_of(model).text.c_str()));
  }
  [[nodiscard]] std::string value(const std::string& path, const char* attribute) const {
    return document.select_node(path.c_str()).node().attribute(attribute).value();
  }
  [[nodiscard]] std::size_t count(const char* path) const { return document.select_nodes(path).size(); }

  pugi::xml_document document;
  std::vector<std::string> lost;
};

Vector3d parse(const std::string& text) {
  std::istringstream in(text);
  Vector3d v;
  in >> v.x() >> v.y() >> v.z();
  return v;
}

TEST(UrdfOf, IsATreeOfLinksWithOneRoot) {
  auto model = one_body({axis_of(true, 0), axis_of(false, 1)});
  model.bodies.push_back({.name = "hand", .mass = 0.5});
  model.joints.push_back({.name = "wrist", .type = "WeldJoint", .parent_body_idx = 0, .child_body_idx = 1});
  const Written file(model);
  std::set<std::string> links, children;
  for (const auto& link : file.document.select_nodes("/robot/link"))
    EXPECT_TRUE(links.insert(link.node().attribute("name").value()).second);
  for (const auto& joint : file.document.select_nodes("/robot/joint")) {
    const std::string child = joint.node().child("child").attribute("link").value();
    EXPECT_TRUE(links.contains(child)) << child;
    EXPECT_TRUE(links.contains(joint.node().child("parent").attribute("link").value()));
    EXPECT_TRUE(children.insert(child).second) << child << " hangs twice";
  }
  links.erase("ground");
  EXPECT_EQ(links, children);
}

TEST(UrdfOf, AWeldIsFixed) {
  auto model = one_body({});
  model.joints[0].parent_from_joint.translation = {1.0, 2.0, 3.0};
  const Written file(model);
  EXPECT_EQ(file.value("//joint[@name='arm_fixed']", "type"), "fixed");
  EXPECT_EQ(file.value("//joint[@name='arm_fixed']/origin", "xyz"), "1 2 3");
  EXPECT_EQ(file.value("//joint[@name='arm_fixed']/parent", "link"), "ground");
  EXPECT_EQ(file.value("//joint[@name='arm_fixed']/child", "link"), "arm");
  EXPECT_EQ(file.count("//joint"), 1u);
}

TEST(UrdfOf, ALockedCoordinateIsFixedWhereItStands) {
  auto model = one_body({axis_of(false, 1)});
  model.coordinates[1].locked = true;
  model.coordinates[1].default_value = 0.25;
  const Written file(model);
  EXPECT_EQ(file.value("//joint", "type"), "fixed");
  EXPECT_EQ(file.value("//joint/origin", "xyz"), "0.25 0 0");
}

TEST(UrdfOf, LimitsAreThoseOfClampedCoordinatesOnly) {
  auto model = one_body({axis_of(true, 0)});
  model.coordinates[0].range_min = -0.5;
  model.coordinates[0].range_max = 1.25;
  EXPECT_EQ(Written(model).value("//joint[@name='turn']", "type"), "continuous");
  EXPECT_EQ(Written(model).count("//limit"), 0u);
  model.coordinates[0].clamped = true;
  const Written file(model);
  EXPECT_EQ(file.value("//joint[@name='turn']", "type"), "revolute");
  EXPECT_EQ(file.value("//limit", "lower"), "-0.5");
  EXPECT_EQ(file.value("//limit", "upper"), "1.25");
  EXPECT_EQ(file.value("//limit", "effort"), "1000");
}

TEST(UrdfOf, ASlideAlwaysHasLimits) {
  auto model = one_body({axis_of(false, 1)});
  EXPECT_EQ(Written(model).value("//joint[@name='push']", "type"), "prismatic");
  EXPECT_EQ(Written(model).value("//limit", "lower"), "-100");
  EXPECT_EQ(Written(model).value("//limit", "upper"), "100");
}

TEST(UrdfOf, LinksBetweenSeveralMotionsTakeNoNameOfABody) {
  auto model = one_body({axis_of(true, 0), axis_of(false, 1)});
  model.bodies.push_back({.name = "arm_axis1", .mass = 1.0});
  model.joints.push_back({.name = "other", .type = "WeldJoint", .child_body_idx = 1});
  const Written file(model);
  EXPECT_EQ(file.value("//joint[@name='push']/child", "link"), "arm_axis1_");
  EXPECT_EQ(file.value("//joint[@name='turn']/parent", "link"), "arm_axis1_");
  EXPECT_EQ(file.value("//joint[@name='turn']/child", "link"), "arm");
  EXPECT_EQ(file.count("//link[@name='arm_axis1_']/inertial"), 0u);
}

TEST(UrdfOf, AnOffsetBehindTheLastMotionIsAFixedJointMore) {
  auto model = one_body({axis_of(true, 0)});
  model.joints[0].child_from_joint.translation = {0.0, 0.5, 0.0};
  const Written file(model);
  EXPECT_EQ(file.value("//joint[@name='turn']/child", "link"), "arm_axis1");
  EXPECT_EQ(file.value("//joint[@name='arm_fixed']/parent", "link"), "arm_axis1");
  EXPECT_EQ(parse(file.value("//joint[@name='arm_fixed']/origin", "xyz")), Vector3d(0.0, -0.5, 0.0));
}

TEST(UrdfOf, OrientationsAreRollPitchYawAlsoAtARightAngle) {
  for (const Vector3d& rpy : {Vector3d(0.3, -0.7, 2.5), Vector3d(0.4, std::numbers::pi / 2.0, 0.0),
                              Vector3d(-1.2, -std::numbers::pi / 2.0, 0.9)}) {
    const auto rotation = [](const Vector3d& angles) -> Eigen::Matrix3d {
      return math::axis_angle(Vector3d::UnitZ(), angles.z()) *
             math::axis_angle(Vector3d::UnitY(), angles.y()) *
             math::axis_angle(Vector3d::UnitX(), angles.x());
    };
    auto model = one_body({});
    model.joints[0].parent_from_joint.rotation = rotation(rpy);
    const auto written = parse(Written(model).value("//joint/origin", "rpy"));
    EXPECT_TRUE(rotation(written).isApprox(rotation(rpy), 1e-12)) << rpy.transpose();
  }
}

TEST(UrdfOf, HasTheInertiaAtTheMassCentre) {
  const Written file(one_body({}));
  EXPECT_EQ(file.value("//inertial/origin", "xyz"), "0.1 0.2 0.3");
  EXPECT_EQ(file.value("//inertial/mass", "value"), "1.5");
  std::vector<std::string> values;
  for (const char* name : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
    values.push_back(file.value("//inertia", name));
  EXPECT_THAT(values, ElementsAre("3", "0.1", "0.2", "4", "0.3", "5"));
  EXPECT_EQ(file.value("//compiler", "balanceinertia"), "false");
  EXPECT_THAT(file.lost, Not(Contains(HasSubstr("inertia"))));
}

TEST(UrdfOf, ABodyWithoutMassHasNoInertial) {
  auto model = one_body({axis_of(true, 0)});
  model.bodies[0].mass = 0.0;
  const Written file(model);
  EXPECT_EQ(file.count("//inertial"), 0u);
  EXPECT_EQ(file.value("//compiler", "boundmass"), "1e-9");
  EXPECT_THAT(file.lost, Contains("1 body without mass gets 1e-9 kg in MuJoCo: arm"));
}

TEST(UrdfOf, AnInertiaThatNoBodyCanHaveIsSaid) {
  auto model = one_body({});
  model.bodies[0].inertia_about_com =
      Vector3d(1.0, 1.0, 2.5).asDiagonal();  // the third above the others' sum
  const Written file(model);
  EXPECT_EQ(file.value("//compiler", "balanceinertia"), "true");
  EXPECT_THAT(file.lost,
              Contains("the inertia of 1 body, which no rigid body can have, is changed to one that it "
                       "can: arm"));
}

TEST(UrdfOf, AMomentOfZeroBecomesAMillionthOfTheLargest) {
  auto model = one_body({});
  model.bodies[0].inertia_about_com = Vector3d(0.0, 2.0, 2.0).asDiagonal();  // a rod
  const Written file(model);
  EXPECT_NEAR(std::stod(file.value("//inertia", "ixx")), 2e-6, 1e-12);
  EXPECT_NEAR(std::stod(file.value("//inertia", "iyy")), 2.0, 1e-12);
  EXPECT_THAT(file.lost, Contains(HasSubstr("no rigid body can have")));
  model.bodies[0].inertia_about_com.setZero();
  EXPECT_NEAR(std::stod(Written(model).value("//inertia", "izz")), 1e-9, 1e-15);
}

TEST(UrdfOf, NamesWithBlanksAndXmlCharactersAreLegalAndDistinct) {
  auto model = one_body({axis_of(true, 0), axis_of(false, 1)});
  model.name = "a <b> & \"c\"";
  model.bodies[0].name = "upper arm";
  model.bodies.push_back({.name = "upper&arm", .mass = 1.0});
  model.joints.push_back({.name = "other", .type = "WeldJoint", .child_body_idx = 1});
  model.coordinates[0].name = "q<1>";
  model.coordinates[1].name = "q 1 ";
  const Written file(model);
  EXPECT_EQ(file.value("/robot", "name"), model.name);
  EXPECT_EQ(file.count("//link[@name='upper_arm']"), 1u);
  EXPECT_EQ(file.count("//link[@name='upper_arm_2']"), 1u);
  EXPECT_EQ(file.count("//joint[@name='q_1_']"), 1u);
  EXPECT_EQ(file.count("//joint[@name='q_1__2']"), 1u);
  EXPECT_THAT(file.lost, Contains(HasSubstr("'upper&arm' is 'upper_arm_2'")));
}

TEST(UrdfOf, WhatItCannotHoldIsSaid) {
  auto model = one_body({axis_of(true, 0)});
  model.point_constraints.push_back({.name = "ring", .body_b_idx = 0});
  model.markers = {{.name = "A", .body_idx = 0}, {.name = "B", .body_idx = 0}};
  const auto lost = Written(model).lost;
  EXPECT_THAT(lost, Contains("1 closed loop is left open: ring"));
  EXPECT_THAT(lost, Contains("2 markers cannot be stored in a .urdf file"));
  EXPECT_THAT(lost, Contains("gravity and the default posture cannot be stored in a .urdf file"));
}

}  // namespace
}  // namespace kinemark::io
