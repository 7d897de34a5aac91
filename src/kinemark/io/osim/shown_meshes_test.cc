// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/shown_meshes.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "kinemark/io/osim/osim_model.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

/// A document of this version with the body "a" that holds `shown`.
std::string document(int version, const std::string& shown) {
  const char* joint = version >= 40000 ? ""
                                       : "<Joint><FreeJoint name=\"j\"><parent_body>ground</parent_body>"
                                         "<CoordinateSet/></FreeJoint></Joint>";
  const char* joints =
      version >= 40000
          ? "<JointSet name=\"jointset\"><objects><WeldJoint name=\"w\"><socket_parent_frame>/ground"
            "</socket_parent_frame><socket_child_frame>/bodyset/a</socket_child_frame></WeldJoint></objects>"
            "</JointSet>"
          : "";
  return fmt::format(
      "<OpenSimDocument Version=\"{}\"><Model name=\"m\"><BodySet name=\"bodyset\"><objects><Body name=\"a\">"
      "<mass>1</mass>{}{}</Body></objects></BodySet>{}</Model></OpenSimDocument>",
      version, joint, shown, joints);
}

std::vector<data::ShownMesh> meshes_of(const std::string& xml) {
  data::ModelDescription model;
  model.bodies = {{.name = "a"}};
  auto shown = parse_shown_meshes(xml, "m.osim", model);
  EXPECT_TRUE(shown) << shown.error().message;
  return shown.value_or(std::vector<data::ShownMesh>());
}

TEST(ShownMeshes, OfAnAttachedGeometry) {
  const auto shown = meshes_of(document(40000, R"(<attached_geometry>
    <Mesh name="one"><socket_frame>..</socket_frame><scale_factors>1 -2 3</scale_factors>
      <mesh_file> bone.vtp </mesh_file></Mesh>
    <Mesh name="hidden"><Appearance><visible>false</visible></Appearance><mesh_file>b.vtp</mesh_file></Mesh>
    <Sphere name="ball"><radius>0.1</radius></Sphere>
    <Mesh name="bare"><mesh_file>c.stl</mesh_file></Mesh>
    <Mesh><socket_frame>..</socket_frame><mesh_file>d.stl</mesh_file></Mesh></attached_geometry>)"));
  ASSERT_EQ(shown.size(), 3U);
  EXPECT_EQ(shown[0].body, "a");
  EXPECT_EQ(shown[0].file, "bone.vtp");
  EXPECT_EQ(shown[0].scale, Vector3d(1.0, -2.0, 3.0));
  EXPECT_EQ(shown[1].file, "c.stl");
  EXPECT_EQ(shown[1].scale, Vector3d::Ones());
  EXPECT_EQ(shown[2].body, "a") << "without a name, too";
}

TEST(ShownMeshes, OfAFrameOnABody) {
  const auto shown = meshes_of(document(40000, R"(<components>
    <PhysicalOffsetFrame name="f"><socket_parent>..</socket_parent><translation>0.1 0.2 0.3</translation>
      <orientation>0 0 1.5707963267948966</orientation>
      <attached_geometry><Mesh name="one"><socket_frame>..</socket_frame><mesh_file>bone.obj</mesh_file></Mesh>
      </attached_geometry></PhysicalOffsetFrame></components>)"));
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0].body, "a");
  EXPECT_LT((shown[0].body_from_mesh * Vector3d::UnitX() - Vector3d(0.1, 1.2, 0.3)).norm(), 1e-12);
}

TEST(ShownMeshes, OfAVisibleObjectHaveItsScaleAndPoseToo) {
  const auto shown = meshes_of(document(30000, R"(<VisibleObject><GeometrySet><objects>
      <DisplayGeometry><geometry_file>bone.vtp</geometry_file><transform>0 0 1.5707963267948966 0.5 0 0</transform>
        <scale_factors>2 1 1</scale_factors><display_preference>4</display_preference></DisplayGeometry>
      <DisplayGeometry><geometry_file>hidden.vtp</geometry_file><display_preference>0</display_preference></DisplayGeometry>
      <DisplayGeometry><geometry_file></geometry_file></DisplayGeometry>
    </objects></GeometrySet><scale_factors>1.5 1 1</scale_factors><transform>0 0 0 0 0.25 0</transform>
    <display_preference>4</display_preference></VisibleObject>)"));
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0].scale, Vector3d(3.0, 1.0, 1.0));
  EXPECT_LT((shown[0].body_from_mesh * Vector3d::UnitX() - Vector3d(0.5, 1.25, 0.0)).norm(), 1e-12);
}

TEST(ShownMeshes, OfAListOfNames) {
  const auto shown = meshes_of(
      document(20000, "<VisibleObject><geometry_files>a.vtp  b.vtp</geometry_files></VisibleObject>"));
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[1].file, "b.vtp");
}

TEST(ShownMeshes, OfABodyWithAPreferenceToHideAreShownAsByOpenSim4) {
  EXPECT_EQ(meshes_of(document(30000, R"(<VisibleObject><display_preference>0</display_preference>
    <geometry_files>a.vtp</geometry_files></VisibleObject>)"))
                .size(),
            1U);
}

TEST(ShownMeshes, WhatIsNoNumberIsASentence) {
  const auto shown =
      parse_shown_meshes(document(40000,
                                  "<attached_geometry><Mesh name=\"one\"><scale_factors>1 x 1</scale_factors>"
                                  "<mesh_file>a.vtp</mesh_file></Mesh></attached_geometry>"),
                         "m.osim", {.bodies = {{.name = "a"}}});
  ASSERT_FALSE(shown);
  EXPECT_THAT(shown.error().message, HasSubstr("m.osim: Body 'a', Mesh 'one'"));
}

TEST(ShownMeshes, TooManyAreASentence) {
  std::string many = "<attached_geometry>";
  for (int i = 0; i < 2100; ++i) many += "<Mesh><mesh_file>a.vtp</mesh_file></Mesh>";
  const auto shown = parse_shown_meshes(document(40000, many + "</attached_geometry>"), "m.osim",
                                        {.bodies = {{.name = "a"}}});
  ASSERT_FALSE(shown);
  EXPECT_THAT(shown.error().message, HasSubstr("more than 2000 meshes"));
}

/// Models of the field: as many meshes as their text names and does not hide, each on a body of the model.
TEST(ShownMeshes, OfRealModels) {
  KINEMARK_REQUIRE_TEST_DATA(data_folder);
  struct Model {
    const char* file;
    std::size_t meshes;
  };
  for (const auto& [file, meshes] :
       {Model{"opensim-gait2354/subject01_simbody.osim", 19},
        Model{"opensim-core-ik/subject01_simbody.osim", 19},
        Model{"opensim-core-ik/subject1_abdbonepin.osim", 7},
        Model{"opensim-hamner-fullbody/subject02_registered.osim", 79},
        Model{"bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim", 79},
        Model{"models-upper-and-full-body/Wu_Shoulder_Model_via_points.osim", 33},
        Model{"models-upper-and-full-body/Rajagopal2016.osim", 81},
        Model{"nimble-arnold-synthetic/subject01/subject01.osim", 79},
        Model{"monkey-arm/monkeyArm_current.osim", 7}}) {
    const auto path = data_folder / file;
    const auto model = read_osim(path).value();
    const auto shown = read_shown_meshes(path, model);
    ASSERT_TRUE(shown) << shown.error().message;
    EXPECT_EQ(shown->size(), meshes) << file;
    std::set<std::string> bodies;
    for (const auto& body : model.bodies) bodies.insert(body.name);
    for (const auto& mesh : *shown) EXPECT_TRUE(bodies.contains(mesh.body)) << file << ' ' << mesh.body;
  }
}

}  // namespace
}  // namespace kinemark::io
