// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Real models: what is in them, and that nothing of it is lost.
#include "kinemark/io/osim/osim_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "kinemark/io/file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Counts {
  const char* path;
  std::size_t bodies, coordinates, markers, couplings, point_constraints, locked;
};

// Without the ground, which files before 4.0 list as a body. The scapulothoracic joint of abdbonepin adds
// one.
const Counts kModels[] = {
    {"opensim-core-ik/subject01_simbody.osim", 12, 23, 39, 0, 0, 0},
    {"opensim-core-ik/subject1_abdbonepin.osim", 8, 17, 11, 0, 1, 2},
    {"opensim-gait2354/subject01_simbody.osim", 12, 23, 39, 0, 0, 0},
    {"opensim-gait2354/subject01_scaledOnly.osim", 12, 23, 39, 0, 0, 0},
    {"opensim-gait2354/gait2354_simbody.osim", 12, 23, 0, 0, 0, 0},
    {"opensim-hamner-fullbody/subject02_registered.osim", 20, 37, 46, 0, 0, 8},
    {"opensim-arm26/arm26.osim", 3, 2, 3, 0, 0, 0},
    {"bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim", 22, 39, 64, 2, 0, 8},
    {"nimble-arnold-synthetic/subject01/subject01.osim", 22, 33, 64, 2, 0, 0},
    {"monkey-arm/monkeyArm_current.osim", 10, 7, 13, 0, 0, 0},
    {"monkey-arm/Han_scaled_20171122.osim", 10, 7, 10, 0, 0, 3},
    {"models-upper-and-full-body/MOBL_ARMS_41.osim", 12, 26, 10, 13, 0, 0},
    {"models-upper-and-full-body/Wu_Shoulder_Model_via_points.osim", 7, 17, 22, 0, 0, 1},
    {"models-upper-and-full-body/wholebody.osim", 25, 42, 49, 0, 0, 0},
    {"models-upper-and-full-body/Rajagopal2016.osim", 22, 39, 66, 2, 0, 8},
};

TEST(OsimModel, EveryRealModelLoadsWithItsCounts) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  for (const Counts& expected : kModels) {
    const auto model = read_osim(data / expected.path);
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->bodies.size(), expected.bodies) << expected.path;
    EXPECT_EQ(model->joints.size(), expected.bodies) << expected.path;
    EXPECT_EQ(model->coordinates.size(), expected.coordinates) << expected.path;
    EXPECT_EQ(model->markers.size(), expected.markers) << expected.path;
    EXPECT_EQ(model->couplings.size(), expected.couplings) << expected.path;
    EXPECT_EQ(model->point_constraints.size(), expected.point_constraints) << expected.path;
    std::size_t locked = 0;
    for (const auto& c : model->coordinates) locked += c.locked;
    EXPECT_EQ(locked, expected.locked) << expected.path;
    EXPECT_THAT(model->warnings, IsEmpty()) << expected.path;
    EXPECT_TRUE(model->validate()) << expected.path;
  }
}

// One list holds all models of the data, so that a new one cannot be forgotten.
TEST(OsimModel, TheTableAboveIsComplete) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data))
    found += entry.path().extension() == ".osim";
  EXPECT_EQ(found, std::size(kModels));
}

TEST(OsimModel, CoordinatesComeInTheOrderOfOpenSimsResults) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto model = read_osim(data / "opensim-gait2354/subject01_simbody.osim").value();
  std::vector<std::string> names;
  for (const auto& c : model.coordinates) names.push_back(c.name);
  names.resize(8);
  EXPECT_THAT(names, ElementsAre("pelvis_tilt", "pelvis_list", "pelvis_rotation", "pelvis_tx", "pelvis_ty",
                                 "pelvis_tz", "hip_flexion_r", "hip_adduction_r"));
}

TEST(OsimModel, OldAndNewFormatOfOneModelAgree) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto old = read_osim(data / "opensim-core-ik/subject01_simbody.osim").value();
  const auto renewed = read_osim(data / "opensim-gait2354/subject01_simbody.osim").value();
  ASSERT_EQ(old.joints.size(), renewed.joints.size());
  for (std::size_t j = 0; j < old.joints.size(); ++j) {
    EXPECT_EQ(old.joints[j].name, renewed.joints[j].name);
    EXPECT_EQ(old.joints[j].parent_body_idx, renewed.joints[j].parent_body_idx);
    EXPECT_EQ(old.joints[j].child_body_idx, renewed.joints[j].child_body_idx);
    EXPECT_EQ(old.joints[j].axes.size(), renewed.joints[j].axes.size());
  }
  for (std::size_t c = 0; c < old.coordinates.size(); ++c) {
    EXPECT_EQ(old.coordinates[c].name, renewed.coordinates[c].name);
    EXPECT_EQ(old.coordinates[c].is_rotation, renewed.coordinates[c].is_rotation) << old.coordinates[c].name;
  }
}

TEST(OsimModel, Rajagopal2016HasItsKneeMassAndLimits) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto model = read_osim(data / "models-upper-and-full-body/Rajagopal2016.osim").value();
  double mass = 0.0;
  for (const auto& body : model.bodies) mass += body.mass;
  EXPECT_NEAR(mass, 75.337, 0.01);
  const auto& pelvis = model.bodies[static_cast<std::size_t>(model.find_body("pelvis"))];
  EXPECT_NEAR(pelvis.mass, 11.777, 1e-3);
  EXPECT_LT((pelvis.inertia_about_com - pelvis.inertia_about_com.transpose()).norm(), 1e-15);
  for (const auto& joint : model.joints)
    if (joint.name == "walker_knee_r") {
      EXPECT_EQ(joint.axes.size(), 5U) << "three rotations, two translations";
      for (const auto& axis : joint.axes)
        EXPECT_EQ(axis.coordinate_idx, model.find_coordinate("knee_angle_r"));
    }
  const auto& knee = model.coordinates[static_cast<std::size_t>(model.find_coordinate("knee_angle_r"))];
  EXPECT_TRUE(knee.clamped);
  EXPECT_TRUE(knee.is_rotation);
  EXPECT_NEAR(knee.range_max, 2.0944, 1e-5);
  const auto& tx = model.coordinates[static_cast<std::size_t>(model.find_coordinate("pelvis_tx"))];
  EXPECT_FALSE(tx.is_rotation);
  const auto& radioulnar = model.coordinates[static_cast<std::size_t>(model.find_coordinate("wrist_flex_r"))];
  EXPECT_TRUE(radioulnar.locked);
}

TEST(OsimModel, TheScapulothoracicJointIsSplit) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto model = read_osim(data / "opensim-core-ik/subject1_abdbonepin.osim").value();
  EXPECT_GE(model.find_body("scapulothoracic_intermediate"), 0);
  for (const auto& joint : model.joints)
    if (joint.name == "scapulothoracic") {
      EXPECT_EQ(joint.type, "ScapulothoracicJoint");
      EXPECT_EQ(joint.parameters.size(), 6U);
      EXPECT_EQ(joint.axes.size(), 1U);
    }
  const int abduction = model.find_coordinate("scapula_abduction");
  EXPECT_EQ(model.find_coordinate("scapula_winging"), abduction + 3);
  EXPECT_THAT(model.credits, HasSubstr("Seth"));
}

TEST(OsimModel, TextThatIsNotUtf8BecomesUtf8) {
  const std::string xml =
      "<OpenSimDocument Version=\"30000\"><Model name=\"m\"><credits>33:829\x96"
      "840 \xC3\xA9</credits></Model></OpenSimDocument>";
  EXPECT_EQ(parse_osim(xml, "x").value().credits,
            "33:829\xC2\x96"
            "840 \xC3\xA9");
}

TEST(OsimModel, SetsInOtherFilesAreRead) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "markers.xml",
                         "<OpenSimDocument Version=\"40000\"><MarkerSet name=\"markerset\"><objects>"
                         "<Marker name=\"M\"><socket_parent_frame>/ground</socket_parent_frame>"
                         "<location>1 2 3</location></Marker></objects></MarkerSet></OpenSimDocument>",
                         false));
  const std::string xml =
      "<OpenSimDocument Version=\"40000\"><Model name=\"m\"><MarkerSet file=\"markers.xml\"/></Model>"
      "</OpenSimDocument>";
  ASSERT_TRUE(write_text(scratch / "m.osim", xml, false));
  const auto model = read_osim(scratch / "m.osim");
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->markers.size(), 1U);
  EXPECT_EQ(model->markers[0].x_in_body, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(parse_osim(xml, "m.osim").error().message, HasSubstr("'markers.xml', which is not available"));
}

}  // namespace
}  // namespace kinemark::io
