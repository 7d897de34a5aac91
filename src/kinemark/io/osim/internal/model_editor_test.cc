// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A description is changed, written into the elements it came from, and read back.
#include "kinemark/io/osim/internal/model_editor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "kinemark/core/random.h"
#include "kinemark/io/osim/internal/model_difference.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/math/euler.h"

namespace kinemark::io::osim {
namespace {

using data::ModelDescription;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

/// A forearm on an upper arm on the ground; a comment and a muscle that no description holds.
constexpr std::string_view kArm = R"(<?xml version="1.0"?>
<OpenSimDocument Version="40000"><Model name="arm">
  <BodySet><objects>
    <Body name="upper"><mass>2</mass><mass_center>0 -0.1 0</mass_center><inertia>0.02 0.002 0.02 0 0 0</inertia></Body>
    <Body name="fore"><mass>1</mass><mass_center>0 -0.1 0</mass_center><inertia>0.01 0.001 0.01 0 0 0</inertia></Body>
  </objects></BodySet>
  <JointSet><objects>
    <PinJoint name="shoulder"><!-- kept --><socket_parent_frame>/ground</socket_parent_frame>
      <socket_child_frame>upper_offset</socket_child_frame>
      <coordinates><Coordinate name="raise"><speed_penalty>7</speed_penalty></Coordinate></coordinates>
      <frames><PhysicalOffsetFrame name="upper_offset"><socket_parent>/bodyset/upper</socket_parent>
        <translation>0 0.2 0</translation><orientation>0.1 0.2 0.3</orientation></PhysicalOffsetFrame></frames></PinJoint>
    <PinJoint name="elbow"><socket_parent_frame>upper_end</socket_parent_frame>
      <socket_child_frame>/bodyset/fore</socket_child_frame><coordinates><Coordinate name="bend"/></coordinates>
      <frames><PhysicalOffsetFrame name="upper_end"><socket_parent>/bodyset/upper</socket_parent>
        <translation>0 -0.3 0</translation></PhysicalOffsetFrame></frames></PinJoint>
  </objects></JointSet>
  <ConstraintSet><objects><PointConstraint name="loop"><socket_body_1>/bodyset/upper</socket_body_1>
    <socket_body_2>/bodyset/fore</socket_body_2><location_body_1>0 0 0.1</location_body_1>
    <location_body_2>0 0 0.2</location_body_2></PointConstraint></objects></ConstraintSet>
  <MarkerSet><objects>
    <Marker name="A"><socket_parent_frame>/bodyset/upper</socket_parent_frame><location>0 0 0.05</location></Marker>
    <Marker name="B"><socket_parent_frame>/jointset/elbow/upper_end</socket_parent_frame><location>0.01 0 0</location></Marker>
  </objects></MarkerSet>
  <ForceSet><objects><Millard2012EquilibriumMuscle name="biceps"/></objects></ForceSet>
</Model></OpenSimDocument>)";

/// The same arm as OpenSim 3 wrote it.
constexpr std::string_view kOldArm = R"(<?xml version="1.0"?>
<OpenSimDocument Version="30000"><Model name="arm"><BodySet><objects>
  <Body name="ground"/>
  <Body name="upper"><mass>2</mass><mass_center>0 -0.1 0</mass_center>
    <inertia_xx>0.02</inertia_xx><inertia_yy>0.002</inertia_yy><inertia_zz>0.02</inertia_zz>
    <inertia_xy>0</inertia_xy><inertia_xz>0</inertia_xz><inertia_yz>0</inertia_yz>
    <Joint><PinJoint name="shoulder"><parent_body>ground</parent_body>
      <location_in_parent>0 0 0</location_in_parent><location>0 0.2 0</location>
      <CoordinateSet><objects><Coordinate name="raise"/></objects></CoordinateSet></PinJoint></Joint></Body>
</objects></BodySet>
<MarkerSet><objects><Marker name="A"><body>upper</body><location>0 0 0.05</location></Marker></objects></MarkerSet>
</Model></OpenSimDocument>)";

struct Edited {
  ModelDescription wanted, found;
  std::string text;
};

Edited edit(std::string_view xml, const std::function<void(ModelDescription&)>& change) {
  const auto before = parse_osim(xml, "arm.osim").value();
  auto file = XmlFile::parse(xml, "arm.osim", XmlFile::Comments::kept).value();
  Edited e{.wanted = before};
  change(e.wanted);
  const Status status = edit_model(file, file.find_object({"Model"}), before, e.wanted);
  EXPECT_TRUE(status) << status.error().message;
  e.text = file.text();
  e.found = parse_osim(e.text, "edited.osim").value();
  return e;
}

void expect_kept(std::string_view xml, const std::function<void(ModelDescription&)>& change) {
  const Edited e = edit(xml, change);
  EXPECT_EQ(difference_of(e.wanted, e.found), "") << e.text;
}

math::SE3 random_pose(Random& random) {
  const auto number = [&] { return random.uniform(-1.0, 1.0); };
  const double a = number(), b = number(), c = number(), x = number(), y = number(), z = number();
  return {math::from_body_xyz({3.0 * a, 1.5 * b, 3.0 * c}), {x, y, z}};
}

TEST(ModelEditor, WithoutAChangeNotAByteChanges) {
  for (const std::string_view xml : {kArm, kOldArm}) {
    const auto untouched = XmlFile::parse(xml, "arm.osim", XmlFile::Comments::kept).value().text();
    EXPECT_EQ(edit(xml, [](ModelDescription&) {}).text, untouched);
  }
}

TEST(ModelEditor, FramesOfJointsGoAnywhere) {
  Random random(5, 5);
  for (int trial = 0; trial < 20; ++trial)
    expect_kept(kArm, [&](ModelDescription& m) {
      for (auto& joint : m.joints) {
        joint.parent_from_joint = random_pose(random);
        joint.child_from_joint = random_pose(random);
      }
    });
}

TEST(ModelEditor, AFrameThatOnlyTurnsIsWrittenToo) {
  expect_kept(kArm, [](ModelDescription& m) {
    for (auto& joint : m.joints)
      joint.parent_from_joint.rotation =
          joint.parent_from_joint.rotation * math::from_body_xyz({0.4, 0.0, -0.2});
  });
  expect_kept(kArm, [](ModelDescription& m) { m.joints[0].child_from_joint.rotation.setIdentity(); });
}

TEST(ModelEditor, MarkersOnAFrameThatMovesStayWhereTheyAre) {
  const Edited e =
      edit(kArm, [](ModelDescription& m) { m.joints[1].parent_from_joint.translation.y() = -0.4; });
  EXPECT_EQ(difference_of(e.wanted, e.found), "");
  EXPECT_LT((e.found.markers[1].x_in_body - Vector3d(0.01, -0.3, 0.0)).norm(), 1e-15);
}

TEST(ModelEditor, MassesMarkersAndLoops) {
  expect_kept(kArm, [](ModelDescription& m) {
    m.bodies[1].mass = 1.25;
    m.bodies[1].com_in_body = Vector3d(0.01, -0.12, 0.003);
    m.bodies[0].inertia_about_com << 0.03, 0.001, 0.002, 0.001, 0.004, 0.0005, 0.002, 0.0005, 0.03;
    m.markers[0].x_in_body = Vector3d(0.1, 0.2, 0.3);
    m.markers[1].body_idx = 1;
    m.markers.push_back({.name = "C", .body_idx = data::kGround, .x_in_body = {1, 2, 3}});
    m.point_constraints[0].point_in_a = Vector3d(0.3, 0.2, 0.1);
    m.point_constraints[0].point_in_b = Vector3d(0.1, 0.0, 0.1);
  });
}

TEST(ModelEditor, ABodyMayBeAddedWithItsJointAndMarker) {
  expect_kept(kArm, [](ModelDescription& m) {
    m.bodies.push_back(
        {.name = "hand", .mass = 0.4, .inertia_about_com = 0.001 * Eigen::Matrix3d::Identity()});
    m.joints.push_back({.name = "wrist",
                        .type = "WeldJoint",
                        .parent_body_idx = 1,
                        .child_body_idx = 2,
                        .parent_from_joint = {math::from_body_xyz({0.1, 0.0, 0.2}), {0.0, -0.25, 0.0}}});
    m.markers.push_back({.name = "H", .body_idx = 2, .x_in_body = {0.0, -0.05, 0.0}});
  });
}

TEST(ModelEditor, WhatADescriptionDoesNotHoldStays) {
  const Edited e = edit(kArm, [](ModelDescription& m) {
    m.bodies[0].mass = 3.0;
    m.joints[0].parent_from_joint.translation = Vector3d(1, 1, 1);
    m.markers[0].x_in_body.setZero();
  });
  for (const char* part : {"<!-- kept -->", "speed_penalty>7<", "Muscle name=\"biceps\""})
    EXPECT_THAT(e.text, HasSubstr(part));
  EXPECT_THAT(e.text, Not(HasSubstr("<mass>2</mass>")));
}

TEST(ModelEditor, AnOldDocumentKeepsItsForm) {
  const Edited e = edit(kOldArm, [](ModelDescription& m) {
    m.bodies[0].mass = 2.5;
    m.joints[0].parent_from_joint.translation = Vector3d(0.1, 0.9, 0.0);
    m.joints[0].child_from_joint.translation = Vector3d(0.0, 0.25, 0.0);
    m.markers[0].x_in_body = Vector3d(0.0, -0.1, 0.05);
    m.markers.push_back({.name = "N", .body_idx = 0, .x_in_body = {0.0, 0.0, 0.1}});
  });
  EXPECT_EQ(difference_of(e.wanted, e.found), "") << e.text;
  EXPECT_THAT(e.text, HasSubstr("<body>upper</body>"));
  EXPECT_THAT(e.text, Not(HasSubstr("socket")));
}

TEST(ModelEditor, FramesOfAnOldDocumentGoAnywhereToo) {
  Random random(6, 5);
  for (int trial = 0; trial < 10; ++trial)
    expect_kept(kOldArm, [&](ModelDescription& m) {
      m.joints[0].parent_from_joint = random_pose(random);
      m.joints[0].child_from_joint = random_pose(random);
    });
  // Files that give the child's rotation only have the longer name for its place, too.
  std::string longer(kOldArm);
  const std::string_view place = "<location>0 0.2 0</location>";
  longer.replace(longer.find(place), place.size(), "<orientation_in_child>0.1 0 0</orientation_in_child>");
  expect_kept(longer, [&](ModelDescription& m) { m.joints[0].child_from_joint.translation.y() = 0.3; });
}

TEST(ModelEditor, ADocumentBetweenTheVersionsIsMeasuredFromItsFrames) {
  const std::string_view between = R"(<?xml version="1.0"?>
<OpenSimDocument Version="30503"><Model name="arm"><BodySet><objects>
  <Body name="upper"><mass>2</mass><mass_center>0 -0.1 0</mass_center><inertia>0.02 0.002 0.02 0 0 0</inertia></Body>
</objects></BodySet><JointSet><objects>
  <PinJoint name="shoulder"><connectors>
      <Connector_PhysicalFrame_ name="parent_frame"><connectee_name>ground_offset</connectee_name></Connector_PhysicalFrame_>
      <Connector_PhysicalFrame_ name="child_frame"><connectee_name>upper</connectee_name></Connector_PhysicalFrame_></connectors>
    <frames><PhysicalOffsetFrame name="ground_offset"><connectors>
      <Connector_PhysicalFrame_ name="parent"><connectee_name>ground</connectee_name></Connector_PhysicalFrame_></connectors>
      <translation>0 1 0</translation><orientation>0 0.5 0</orientation></PhysicalOffsetFrame></frames>
    <CoordinateSet><objects><Coordinate name="raise"/></objects></CoordinateSet></PinJoint>
</objects></JointSet></Model></OpenSimDocument>)";
  const auto untouched = XmlFile::parse(between, "arm.osim", XmlFile::Comments::kept).value().text();
  EXPECT_EQ(edit(between, [](ModelDescription&) {}).text, untouched);
  expect_kept(between, [](ModelDescription& m) {
    m.joints[0].parent_from_joint.translation = Vector3d(0.1, 1.1, 0.2);
    m.joints[0].parent_from_joint.rotation = math::from_body_xyz({0.2, 0.1, 0.4});
  });
}

TEST(ModelEditor, AJointOfAnotherKindKeepsItsFrames) {
  const Edited e = edit(kArm, [](ModelDescription& m) {
    auto& joint = m.joints[1];
    joint.type = "CustomJoint";
    joint.axes[0].axis = Vector3d(0.1, 0.2, 0.97).normalized();
  });
  EXPECT_EQ(difference_of(e.wanted, e.found), "") << e.text;
  EXPECT_THAT(e.text, HasSubstr("<CustomJoint name=\"elbow\""));
  EXPECT_THAT(e.text, HasSubstr("PhysicalOffsetFrame name=\"upper_end\""));
}

}  // namespace
}  // namespace kinemark::io::osim
