// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/osim_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A thigh on the ground and a shank on the thigh, with what kinemark does not compute with.
constexpr std::string_view kLeg = R"(<?xml version="1.0"?>
<OpenSimDocument Version="40000">
<!-- kept: before the model -->
<Model name="leg">
  <BodySet><objects>
    <Body name="thigh"><mass>7</mass><mass_center>0 -0.2 0</mass_center><inertia>0.1 0.02 0.1 0 0 0</inertia>
      <attached_geometry><Mesh name="femur"><mesh_file>femur.vtp</mesh_file></Mesh></attached_geometry>
      <WrapObjectSet><objects>
        <WrapCylinder name="condyles"><translation>0.01 -0.4 0</translation>
          <xyz_body_rotation>0 0 1.5707963267948966</xyz_body_rotation><radius>0.03</radius><length>0.2</length></WrapCylinder>
        <WrapSphere name="head"><radius>0.02</radius></WrapSphere>
        <WrapEllipsoid name="belly"><dimensions>0.1 0.2 0.3</dimensions></WrapEllipsoid>
        <WrapTorus name="ring"><inner_radius>0.01</inner_radius><outer_radius>0.02</outer_radius></WrapTorus>
      </objects></WrapObjectSet></Body>
    <Body name="shank"><mass>3</mass><mass_center>0 -0.2 0</mass_center><inertia>0.05 0.01 0.05 0 0 0</inertia></Body>
  </objects></BodySet>
  <JointSet><objects>
    <PinJoint name="hip"><socket_parent_frame>/ground</socket_parent_frame>
      <socket_child_frame>/bodyset/thigh</socket_child_frame><coordinates><Coordinate name="hip_angle"/></coordinates></PinJoint>
    <CustomJoint name="knee"><socket_parent_frame>thigh_offset</socket_parent_frame>
      <socket_child_frame>/bodyset/shank</socket_child_frame>
      <coordinates><Coordinate name="knee_angle"><speed_penalty>3</speed_penalty></Coordinate></coordinates>
      <frames><PhysicalOffsetFrame name="thigh_offset"><socket_parent>/bodyset/thigh</socket_parent>
        <translation>0 <!-- in the text --> -0.4 0</translation></PhysicalOffsetFrame></frames>
      <SpatialTransform>
        <TransformAxis name="rotation1"><coordinates>knee_angle</coordinates><axis>0 0 1</axis>
          <LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction></TransformAxis>
        <TransformAxis name="rotation2"><axis>0 1 0</axis></TransformAxis>
        <TransformAxis name="rotation3"><axis>1 0 0</axis></TransformAxis>
        <TransformAxis name="translation1"><coordinates>knee_angle</coordinates><axis>1 0 0</axis>
          <SimmSpline name="function"><x>-1 0 1</x><y>0 0.01 0.03</y></SimmSpline></TransformAxis>
        <TransformAxis name="translation2"><axis>0 1 0</axis></TransformAxis>
        <TransformAxis name="translation3"><axis>0 0 1</axis></TransformAxis>
      </SpatialTransform></CustomJoint>
  </objects></JointSet>
  <ForceSet><objects>
    <Thelen2003Muscle name="vastus"><max_isometric_force>1000</max_isometric_force>
      <optimal_fiber_length>0.08</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length>
      <GeometryPath name="path"><PathPointSet><objects>
        <PathPoint name="P1"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0.05 0 0</location></PathPoint>
        <ConditionalPathPoint name="P2"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0.06 -0.3 0</location>
          <socket_coordinate>/jointset/knee/knee_angle</socket_coordinate><range>-1 0.5</range></ConditionalPathPoint>
        <MovingPathPoint name="P3"><socket_parent_frame>/bodyset/shank</socket_parent_frame>
          <socket_x_coordinate>/jointset/knee/knee_angle</socket_x_coordinate>
          <x_location><Constant><value>0.05</value></Constant></x_location>
          <y_location><MultiplierFunction><function><Constant><value>-0.1</value></Constant></function><scale>0.5</scale></MultiplierFunction></y_location>
          <z_location><Constant><value>0</value></Constant></z_location></MovingPathPoint>
      </objects></PathPointSet>
      <PathWrapSet><objects><PathWrap><wrap_object>condyles</wrap_object></PathWrap></objects></PathWrapSet></GeometryPath>
    </Thelen2003Muscle>
    <Ligament name="cruciate"><resting_length>0.03</resting_length><GeometryPath name="path"/></Ligament>
  </objects></ForceSet>
  <ContactGeometrySet><objects><ContactSphere name="heel"><socket_frame>/bodyset/shank</socket_frame>
    <location>0 -0.4 0</location><radius>0.02</radius></ContactSphere></objects></ContactGeometrySet>
  <ControllerSet><objects><ControlSetController name="brain"/></objects></ControllerSet>
  <MarkerSet><objects>
    <Marker name="KNE"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0 -0.4 0.05</location></Marker>
  </objects></MarkerSet>
</Model>
</OpenSimDocument>)";

OsimDocument leg() { return OsimDocument::parse(kLeg, "leg.osim").value(); }

std::string text_of(const OsimDocument& document, const OsimChange& change) {
  const auto text = document.format(change);
  if (!text) return text.error().message;
  EXPECT_THAT(text->lost, IsEmpty());
  return text->text;
}

/// What stands between <tag> and </tag> of the element behind `before`.
std::string element(const std::string& text, std::string_view before, const std::string& tag) {
  const std::size_t from = text.find("<" + tag + ">", text.find(before));
  const std::size_t begin = from + tag.size() + 2;
  return from == std::string::npos ? "none" : text.substr(begin, text.find("</", begin) - begin);
}

TEST(OsimDocument, what_is_not_changed_stands_as_it_stood) {
  const auto document = leg();
  const std::string text = text_of(document, {.model = document.model(), .factors = {}, .paths = {}});
  for (const char* part : {"kept: before the model", "in the text", "<mesh_file>femur.vtp</mesh_file>",
                           "ControlSetController name=\"brain\"", "<speed_penalty>3</speed_penalty>",
                           "<max_isometric_force>1000</max_isometric_force>", "Version=\"40000\"",
                           "<PathWrap>", "ContactSphere name=\"heel\""})
    EXPECT_THAT(text, HasSubstr(part));
  const auto again = OsimDocument::parse(text, "again.osim").value();
  EXPECT_EQ(text_of(again, {.model = again.model(), .factors = {}, .paths = {}}), text);
}

TEST(OsimDocument, paths_are_read_with_their_conditions_functions_and_surfaces) {
  const auto paths = leg().paths();
  ASSERT_EQ(paths.size(), 2);
  EXPECT_EQ(paths[0].name, "vastus");
  EXPECT_EQ(paths[0].kind, "Thelen2003Muscle");
  ASSERT_EQ(paths[0].wraps.size(), 1);
  const auto& [surface, first, last] = paths[0].wraps[0];
  EXPECT_EQ(surface.name, "condyles");
  EXPECT_TRUE(surface.is_cylinder && surface.active);
  EXPECT_EQ(surface.body_idx, leg().model().find_body("thigh"));
  EXPECT_EQ(surface.frame_from_surface.translation, Vector3d(0.01, -0.4, 0));
  EXPECT_NEAR(surface.frame_from_surface.rotation(1, 0), 1.0, 1e-15);
  EXPECT_EQ(surface.radius, 0.03);
  EXPECT_EQ(surface.length, 0.2);
  EXPECT_EQ(surface.side_axis, -1);
  EXPECT_EQ(first, -1);
  EXPECT_EQ(last, -1);
  ASSERT_EQ(paths[0].points.size(), 3);
  EXPECT_EQ(paths[0].points[0].x_in_frame, Vector3d(0.05, 0, 0));
  EXPECT_EQ(paths[0].points[1].condition_idx, leg().model().find_coordinate("knee_angle"));
  EXPECT_EQ(paths[0].points[1].range_max, 0.5);
  EXPECT_TRUE(paths[0].points[2].moves);
  EXPECT_EQ(paths[0].points[2].place[1].function(0.0).f, -0.05);
  EXPECT_EQ(paths[1].kind, "Ligament");
}

TEST(OsimDocument, a_surface_may_have_one_side_and_a_path_may_meet_it_between_some_points_only) {
  const auto with = [](std::string_view cylinder, std::string_view wrap) {
    std::string text(kLeg);
    text.insert(text.find("<radius>0.03"), cylinder);
    text.insert(text.find("<wrap_object>"), wrap);
    return OsimDocument::parse(text, "leg.osim").value().paths().at(0).wraps.at(0);
  };
  const auto held = with("<quadrant>-Y</quadrant><active>false</active>", "<range>2 3</range>");
  EXPECT_EQ(held.surface.side_axis, 1);
  EXPECT_EQ(held.surface.side_sign, -1);
  EXPECT_FALSE(held.surface.active);
  EXPECT_EQ(held.first_point, 1);
  EXPECT_EQ(held.last_point, 2);
  EXPECT_EQ(with("<quadrant>+z</quadrant>", "").surface.side_axis, 2);
  EXPECT_EQ(with("<quadrant>+z</quadrant>", "").surface.side_sign, 1);
  EXPECT_EQ(with("<quadrant>all</quadrant>", "<range>-1 2</range>").surface.side_axis, -1);
  EXPECT_EQ(with("", "<range>-1 2</range>").first_point, -1);
  EXPECT_EQ(with("", "<range>-1 2</range>").last_point, 1);
}

TEST(OsimDocument, surfaces_that_are_no_cylinders_or_not_in_the_file_are_kept_by_name) {
  std::string text(kLeg);
  const std::string wraps =
      "<PathWrap><wrap_object>head</wrap_object></PathWrap><PathWrap><wrap_object>none</wrap_object></"
      "PathWrap>";
  text.insert(text.find("</objects></PathWrapSet>"), wraps);
  const auto path = OsimDocument::parse(text, "leg.osim").value().paths().at(0);
  ASSERT_EQ(path.wraps.size(), 3);
  EXPECT_EQ(path.wraps[1].surface.name, "head");
  EXPECT_EQ(path.wraps[1].surface.body_idx, leg().model().find_body("thigh"));
  EXPECT_EQ(path.wraps[2].surface.name, "none");
  EXPECT_FALSE(path.wraps[1].surface.is_cylinder || path.wraps[2].surface.is_cylinder);
}

TEST(OsimDocument, factors_stretch_points_surfaces_geometry_and_frames) {
  const auto document = leg();
  auto model = document.model();
  const Vector3d f(2.0, 3.0, 5.0);
  for (auto& joint : model.joints)
    if (joint.name == "knee") {
      joint.parent_from_joint.translation = joint.parent_from_joint.translation.cwiseProduct(f);
      joint.axes[1].function = joint.axes[1].function.scaled(2.0);
    }
  model.markers[0].x_in_body = model.markers[0].x_in_body.cwiseProduct(f);
  const std::string text =
      text_of(document, {.model = model,
                         .factors = {f, Vector3d::Ones()},
                         .paths = {{.name = "vastus", .ratio = 1.5}, {.name = "cruciate", .ratio = 2.0}}});
  EXPECT_EQ(element(text, "PathPoint name=\"P1\"", "location"), "0.1 0 0");
  EXPECT_EQ(element(text, "name=\"P2\"", "location"), "0.12 -0.8999999999999999 0");
  EXPECT_EQ(element(text, "name=\"P3\"", "value"), "0.05") << "the shank keeps its size";
  EXPECT_EQ(element(text, "WrapCylinder", "translation"), "0.02 -1.2000000000000002 0");
  // The cylinder's x axis is the thigh's y.
  EXPECT_NEAR(std::stod(element(text, "WrapCylinder", "radius")), 0.03 * 2.5, 1e-12);
  EXPECT_NEAR(std::stod(element(text, "WrapCylinder", "length")), 0.2 * 5.0, 1e-12);
  EXPECT_NEAR(std::stod(element(text, "WrapSphere", "radius")), 0.02 * 10.0 / 3.0, 1e-12);
  EXPECT_EQ(element(text, "WrapEllipsoid", "dimensions"), "0.2 0.6000000000000001 1.5");
  EXPECT_NEAR(std::stod(element(text, "WrapTorus", "outer_radius")), 0.02 * 2.5, 1e-12);
  EXPECT_EQ(element(text, "Mesh name", "scale_factors"), "2 3 5");
  EXPECT_THAT(element(text, "name=\"thigh_offset\"", "translation"), HasSubstr("in the text"));
  EXPECT_EQ(element(text, "SimmSpline", "scale"), "2");
  EXPECT_EQ(element(text, "Marker name=\"KNE\"", "location"), "0 -1.2000000000000002 0.25");
  EXPECT_EQ(element(text, "vastus", "optimal_fiber_length"), "0.12");
  EXPECT_EQ(element(text, "vastus", "tendon_slack_length"), "0.30000000000000004");
  EXPECT_EQ(element(text, "cruciate", "resting_length"), "0.06");
  EXPECT_EQ(element(text, "ContactSphere", "radius"), "0.02") << "as OpenSim leaves it";
  const auto again = OsimDocument::parse(text, "again.osim").value();
  EXPECT_NEAR(again.model().joints[1].parent_from_joint.translation.y(), -1.2, 1e-12);
  EXPECT_NEAR(again.model().joints[1].axes[1].function(1.0).f, 0.06, 1e-12);
}

TEST(OsimDocument, functions_of_moving_points_get_a_multiplier_or_another_one) {
  const auto document = leg();
  const std::string text = text_of(
      document,
      {.model = document.model(), .factors = {Vector3d::Ones(), Vector3d(2.0, 3.0, 4.0)}, .paths = {}});
  const auto place = OsimDocument::parse(text, "again.osim").value().paths()[0].points[2].place;
  EXPECT_NEAR(place[0].function(0.0).f, 0.1, 1e-15);
  EXPECT_NEAR(place[1].function(0.0).f, -0.15, 1e-15);
  EXPECT_EQ(element(text, "y_location", "scale"), "1.5") << "one multiplier, not two";
}

TEST(OsimDocument, masses_and_frames_that_change_are_written_and_only_they) {
  const auto document = leg();
  auto model = document.model();
  model.bodies[1].mass = 4.0;
  model.bodies[1].com_in_body = Vector3d(0.01, -0.25, 0.0);
  model.joints[0].child_from_joint.translation = Vector3d(0.0, 0.02, 0.0);  // the body itself was the frame
  const std::string text = text_of(document, {.model = model, .factors = {}, .paths = {}});
  EXPECT_EQ(element(text, "Body name=\"shank\"", "mass"), "4");
  EXPECT_EQ(element(text, "Body name=\"thigh\"", "inertia"), "0.1 0.02 0.1 0 0 0");
  EXPECT_THAT(text, HasSubstr("PhysicalOffsetFrame name=\"hip_child_offset\""));
  EXPECT_THAT(text, HasSubstr("in the text"));
}

TEST(OsimDocument, markers_move_change_bodies_and_are_added) {
  const auto document = leg();
  auto model = document.model();
  model.markers[0].body_idx = 1;
  model.markers[0].x_in_body = Vector3d(0.1, 0.2, 0.3);
  model.markers.push_back({.name = "TOP 1", .body_idx = data::kGround, .x_in_body = Vector3d(1, 2, 3)});
  const std::string text = text_of(document, {.model = model, .factors = {}, .paths = {}});
  EXPECT_EQ(element(text, "\"KNE\"", "socket_parent_frame"), "/bodyset/shank");
  EXPECT_EQ(element(text, "\"KNE\"", "location"), "0.1 0.2 0.3");
  EXPECT_EQ(element(text, "\"TOP_1\"", "socket_parent_frame"), "/ground");
}

TEST(OsimDocument, joints_of_another_kind_keep_their_frames) {
  const auto document = leg();
  auto model = document.model();
  auto& hip = model.joints[0];
  hip.type = "CustomJoint";
  hip.axes.push_back(
      {.axis = Vector3d::UnitX(), .coordinate_idx = static_cast<int>(model.coordinates.size())});
  model.coordinates.push_back({.name = "hip_abduction"});
  model.bodies.push_back({.name = "foot", .mass = 1.0});
  model.joints.push_back({.name = "ankle", .type = "WeldJoint", .parent_body_idx = 1, .child_body_idx = 2});
  const std::string text = text_of(document, {.model = model, .factors = {}, .paths = {}});
  EXPECT_THAT(text, HasSubstr("CustomJoint name=\"hip\""));
  EXPECT_THAT(text, HasSubstr("Coordinate name=\"hip_abduction\""));
  EXPECT_THAT(text, HasSubstr("WeldJoint name=\"ankle\""));
  EXPECT_EQ(parse_osim(text, "again.osim")->bodies.size(), 3);
}

TEST(OsimDocument, what_cannot_be_kept_is_counted_by_kind) {
  const auto document = leg();
  auto model = document.model();
  model.gravity = Vector3d(0.0, 0.0, -9.81);  // nothing edits gravity
  const auto text = document.format({.model = model, .factors = {}, .paths = {}}).value();
  EXPECT_EQ(parse_osim(text.text, "again.osim")->gravity, model.gravity);
  ASSERT_EQ(text.lost.size(), 1);
  for (const char* part : {"gravity", "1 Thelen2003Muscle", "1 Ligament", "1 ContactSphere",
                           "1 ControlSetController", "1 Mesh", "1 WrapCylinder"})
    EXPECT_THAT(text.lost[0], HasSubstr(part));
}

TEST(OsimDocument, a_path_that_cannot_be_read_is_no_reason_to_refuse_the_model) {
  std::string xml(kLeg);
  xml.replace(xml.find("<range>-1 0.5</range>"), 21, "<range>-1</range>");
  const auto document = OsimDocument::parse(xml, "leg.osim").value();
  EXPECT_THAT(document.paths(), IsEmpty());
  EXPECT_THAT(document.paths_error(), HasSubstr("ConditionalPathPoint 'P2'"));
  EXPECT_THAT(text_of(document, {.model = document.model(), .factors = {}, .paths = {}}),
              HasSubstr("vastus"));
}

TEST(OsimDocument, marks_of_sets_of_files_are_not_taken_along) {
  std::string xml(kLeg);
  xml.insert(xml.find("?>") + 2, "\n<!-- kinemark_set=0123456789abcdef -->");
  const auto document = OsimDocument::parse(xml, "leg.osim").value();
  EXPECT_THAT(text_of(document, {.model = document.model(), .factors = {}, .paths = {}}),
              Not(HasSubstr("kinemark_set")));
}

TEST(OsimDocument, fails_as_the_reader_does) {
  EXPECT_EQ(OsimDocument::parse("<a/>", "a.osim").error().message,
            parse_osim("<a/>", "a.osim").error().message);
  EXPECT_FALSE(OsimDocument::read("/nonexistent/a.osim"));
}

class RealDocuments : public ::testing::TestWithParam<const char*> {};

TEST_P(RealDocuments, pass_through_and_scale_as_their_descriptions) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto document = OsimDocument::read(data / GetParam()).value();
  EXPECT_EQ(document.paths_error(), "");
  text_of(document, {.model = document.model(), .factors = {}, .paths = {}});
  auto bigger = document.model();
  const std::vector<Vector3d> factors(bigger.bodies.size(), Vector3d::Constant(1.25));
  for (auto& marker : bigger.markers) marker.x_in_body *= 1.25;
  for (auto& joint : bigger.joints) {
    joint.parent_from_joint.translation *= 1.25;
    joint.child_from_joint.translation *= 1.25;
  }
  EXPECT_FALSE(text_of(document, {.model = bigger, .factors = factors, .paths = {}}).empty());
}

INSTANTIATE_TEST_SUITE_P(All, RealDocuments,
                         ::testing::Values("opensim-gait2354/gait2354_simbody.osim",
                                           "models-upper-and-full-body/Rajagopal2016.osim",
                                           "models-upper-and-full-body/MOBL_ARMS_41.osim",
                                           "models-upper-and-full-body/Wu_Shoulder_Model_via_points.osim",
                                           "models-upper-and-full-body/wholebody.osim",
                                           "opensim-core-ik/subject01_simbody.osim",
                                           "bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim",
                                           "monkey-arm/monkeyArm_current.osim"));

}  // namespace
}  // namespace kinemark::io
