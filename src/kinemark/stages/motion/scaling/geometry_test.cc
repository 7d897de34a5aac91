// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_leg::leg;

data::ModelDescription whole_body() {
  data::ModelDescription model;
  for (const char* name :
       {"pelvis",    "abdomen",   "thorax",  "clavicle_r", "clavicle_l", "head",    "humerus_r",
        "humerus_l", "ulna_r",    "ulna_l",  "radius_r",   "radius_l",   "hand_r",  "hand_l",
        "fingers_r", "fingers_l", "femur_r", "femur_l",    "tibia_r",    "tibia_l", "talus_r",
        "talus_l",   "calcn_r",   "calcn_l", "toes_r",     "toes_l"})
    model.bodies.push_back({.name = name});
  return model;
}

const ScaleGroup& group(const std::vector<ScaleGroup>& groups, const std::string& name) {
  return *std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
}

TEST(ScaleGroups, a_whole_body_has_17_sizes) {
  const auto groups = default_scale_groups(whole_body());
  EXPECT_EQ(groups.size(), 17U);
  EXPECT_EQ(group(groups, "forearm_r").parts.size(), 2U);
  EXPECT_EQ(group(groups, "foot_l").parts.size(), 3U);
  EXPECT_EQ(group(groups, "trunk height").parts.size(), 4U);
  EXPECT_EQ(group(groups, "trunk height").parts[0].axes, Vector3d(1, 1, 0));
  EXPECT_EQ(group(groups, "shoulder width").parts[0].axes, Vector3d(0, 0, 1));
}

TEST(ScaleGroups, sides_share_a_size_when_asked) {
  const auto groups = default_scale_groups(whole_body(), true);
  EXPECT_EQ(groups.size(), 11U);
  EXPECT_EQ(group(groups, "thigh").parts.size(), 2U);
}

TEST(ScaleGroups, unknown_bodies_are_groups_of_their_own) {
  data::ModelDescription model;
  model.bodies = {{.name = "wing_l"}, {.name = "wing_r"}};
  const auto groups = default_scale_groups(model);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].name, "wing_l");
  EXPECT_EQ(groups[0].parts[0].axes, Vector3d::Ones());
}

TEST(ScaleParameters, a_size_moves_joints_markers_and_slides_of_its_body) {
  const auto model = leg();
  const std::vector<ScaleGroup> groups{{.name = "thigh", .parts = {{.body = "femur_r"}}}};
  const auto parameters = scale_parameters(model, groups, 0.2);
  ASSERT_TRUE(parameters) << parameters.error().message;
  ASSERT_EQ(parameters->size(), 1U);
  const auto& thigh = parameters->front();
  EXPECT_EQ(thigh.initial, 1.0);
  EXPECT_EQ(thigh.prior_sd, 0.2);
  const auto bigger = apply_geometry(model, *parameters, Eigen::VectorXd::Constant(1, 0.1));
  // The thigh's own frame in its joint to the pelvis, the knee's position and translation, the marker.
  EXPECT_TRUE(bigger.joints[1].child_from_joint.translation.isApprox(Vector3d(0, 0.011, 0)));
  EXPECT_EQ(bigger.joints[1].parent_from_joint.translation, model.joints[1].parent_from_joint.translation);
  EXPECT_TRUE(bigger.joints[2].parent_from_joint.translation.isApprox(1.1 * Vector3d(0, -0.4, 0)));
  const auto& slide = model.joints[2].axes[1].function;
  EXPECT_NEAR(bigger.joints[2].axes[1].function(0.7).f, 1.1 * slide(0.7).f, 1e-15);
  EXPECT_NEAR(bigger.joints[2].axes[0].function(0.7).f, 0.7, 1e-15);
  const int marker = model.find_marker("THI");
  EXPECT_TRUE(bigger.markers[marker].x_in_body.isApprox(1.1 * model.markers[marker].x_in_body));
  const int shank = model.find_marker("TIB");
  EXPECT_EQ(bigger.markers[shank].x_in_body, model.markers[shank].x_in_body);
}

TEST(ScaleParameters, only_the_named_axes_grow) {
  const auto model = leg();
  const std::vector<ScaleGroup> groups{
      {.name = "width", .parts = {{.body = "pelvis", .axes = Vector3d(0, 0, 1)}}}};
  const auto parameters = scale_parameters(model, groups).value();
  const auto wider = apply_geometry(model, parameters, Eigen::VectorXd::Constant(1, 0.5));
  const Vector3d hip = model.joints[1].parent_from_joint.translation;
  EXPECT_TRUE(
      wider.joints[1].parent_from_joint.translation.isApprox(Vector3d(hip.x(), hip.y(), 1.5 * hip.z())));
}

TEST(ScaleParameters, refuse_unknown_bodies_and_priors) {
  const std::vector<ScaleGroup> groups{{.name = "g", .parts = {{.body = "tail"}}}};
  EXPECT_THAT(scale_parameters(leg(), groups).error().message, HasSubstr("body 'tail'"));
  EXPECT_THAT(scale_parameters(leg(), {}, 0.0).error().message, HasSubstr("need above 0"));
}

TEST(JointParameters, three_for_every_joint_that_is_not_on_the_ground) {
  const auto model = leg();
  const auto parameters = joint_parameters(model).value();
  ASSERT_EQ(parameters.size(), 9U);
  EXPECT_EQ(parameters[0].name, "hip_r.x");
  EXPECT_EQ(parameters[2].initial, model.joints[1].parent_from_joint.translation.z());
  Eigen::VectorXd change = Eigen::VectorXd::Zero(9);
  change[4] = 0.01;
  const auto moved = apply_geometry(model, parameters, change);
  EXPECT_TRUE(moved.joints[2].parent_from_joint.translation.isApprox(Vector3d(0, -0.39, 0)));
}

TEST(JointParameters, tied_markers_go_along) {
  auto model = leg();
  model.markers.push_back(
      {.name = "KNEE", .body_idx = 1, .x_in_body = model.joints[2].parent_from_joint.translation});
  const std::vector<std::string> joints{"knee_r"};
  const std::vector<MarkerOnJoint> tied{{"KNEE", "knee_r"}};
  const auto parameters = joint_parameters(model, joints, 0.02, tied).value();
  ASSERT_EQ(parameters.size(), 3U);
  Eigen::VectorXd change(3);
  change << 0.01, 0.02, 0.03;
  const auto moved = apply_geometry(model, parameters, change);
  EXPECT_EQ(moved.markers.back().x_in_body, moved.joints[2].parent_from_joint.translation);
}

TEST(JointParameters, refuse_names_and_ties_that_make_no_sense) {
  const auto model = leg();
  const auto message = [&](const std::vector<std::string>& joints, const std::vector<MarkerOnJoint>& tied) {
    return joint_parameters(model, joints, 0.02, tied).error().message;
  };
  EXPECT_THAT(message({"elbow"}, {}), HasSubstr("no joint 'elbow'"));
  EXPECT_THAT(message({"ground_pelvis"}, {}), HasSubstr("is connected to the ground"));
  EXPECT_THAT(message({}, {{"NONE", "knee_r"}}), HasSubstr("no marker 'NONE'"));
  EXPECT_THAT(message({}, {{"TIB", "knee_r"}}), HasSubstr("cannot sit on joint 'knee_r'"));
}

TEST(MarkerParameters, three_for_every_marker) {
  const auto model = leg();
  const auto all = marker_parameters(model).value();
  EXPECT_EQ(all.size(), 3 * model.markers.size());
  const std::vector<std::string> some{"TIB"};
  const auto parameters = marker_parameters(model, some, 0.004).value();
  ASSERT_EQ(parameters.size(), 3U);
  EXPECT_EQ(parameters[1].name, "TIB.y");
  const auto moved = apply_geometry(model, parameters, Vector3d(0.001, 0.002, 0.003));
  const int m = model.find_marker("TIB");
  EXPECT_TRUE(
      (moved.markers[m].x_in_body - model.markers[m].x_in_body).isApprox(Vector3d(0.001, 0.002, 0.003)));
  const std::vector<std::string> wrong{"NONE"};
  EXPECT_THAT(marker_parameters(model, wrong).error().message, HasSubstr("no marker 'NONE'"));
}

TEST(ApplyGeometry, no_change_changes_nothing) {
  const auto model = leg();
  const auto parameters = scale_parameters(model, default_scale_groups(model)).value();
  const auto same =
      apply_geometry(model, parameters, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size())));
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    EXPECT_EQ(same.joints[j].parent_from_joint.translation, model.joints[j].parent_from_joint.translation);
  EXPECT_TRUE(same.validate());
}

TEST(SegmentLengths, run_from_joint_to_joint) {
  std::vector<std::string> names;
  const auto lengths = segment_lengths(leg());
  for (const auto& length : lengths) names.push_back(length.name);
  EXPECT_THAT(names, ElementsAre("pelvis: ground_pelvis to hip_r", "femur_r: hip_r to knee_r",
                                 "tibia_r: knee_r to ankle_r"));
  EXPECT_NEAR(lengths[1].length_m, 0.41, 1e-12);  // its own frame lies 10 mm above the joint
}

}  // namespace
}  // namespace kinemark::motion
