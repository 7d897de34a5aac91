// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_json.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A joint that one of four frames does not place.
JointsOutcome outcome_of_a_knee() {
  JointsOutcome out;
  out.used = data::Trajectories::all_missing({"A"}, {.rate_hz = 50.0, .t0_s = 0.0, .frames = 4});
  auto& s = out.skeleton;
  s.time = {.rate_hz = 50.0, .t0_s = 0.0, .frames = 4};
  s.markers = {"A"};
  s.segments.resize(2);
  s.segments[0].name = "thigh";
  s.segments[1].name = "shank";
  s.joints.resize(1);
  s.joints[0].name = "knee";
  s.joints[0].child_segment = 1;
  s.allocate_centres();
  for (std::size_t f = 0; f < 3; ++f) {
    s.state[f] = data::CentreState::determined;
    for (std::size_t k = 0; k < 3; ++k) s.centre_in_world[3 * f + k] = 0.5;
  }
  return out;
}

TEST(JointsPage, FoldsWhatStandsOut) {
  JointsJob job;
  job.input = "folder/walk.c3d";
  auto outcome = outcome_of_a_knee();
  const auto page = joints_page(job, outcome, 1);
  EXPECT_THAT(page, HasSubstr(R"("trial":"walk.c3d")"));
  EXPECT_THAT(page, HasSubstr(R"("verdict":"good")"));
  EXPECT_THAT(page, HasSubstr("1 joint not placed in some frames"));
  EXPECT_THAT(page, HasSubstr("knee: not placed in 1 of 4 frames."));
  EXPECT_THAT(page, Not(HasSubstr("left out as no body's")));
  outcome.skeleton.warnings = {"The fit is doubtful."};
  const auto doubtful = joints_page(job, outcome, 1);
  EXPECT_THAT(doubtful, HasSubstr(R"("verdict":"attention")"));
  EXPECT_THAT(doubtful, HasSubstr("1 doubt about the fit"));
}

TEST(JointsPage, SaysNothingOfJointsThatAreAlwaysPlaced) {
  auto outcome = outcome_of_a_knee();
  outcome.skeleton.state[3] = data::CentreState::bridged;
  EXPECT_THAT(joints_page({}, outcome, 1), Not(HasSubstr("not placed in some frames")));
}

TEST(JointsPage, CountsJointsAndNotWhatIsSaidOfAllOfThem) {
  auto outcome = outcome_of_a_knee();
  EXPECT_THAT(joints_page({}, outcome, 1), Not(HasSubstr("not determined")));
  for (const char* name : {"determined", "determined", "any_joint"})
    outcome.gates.push_back({.name = name, .passed = false, .unit = "joints", .sentence = "Not determined."});
  const auto page = joints_page({}, outcome, 1);
  EXPECT_THAT(page, HasSubstr("2 joints not determined"));
  EXPECT_THAT(page, HasSubstr("1 quality check missed"));
}

using data::CentreState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two segments, a hinge and a ball, four frames.
data::Skeleton small() {
  data::Skeleton s;
  s.time = {.rate_hz = 50.0, .t0_s = 0.0, .frames = 4};
  s.markers = {"A", "B", "C"};
  s.noise_sd_m = 0.001;
  s.segments.resize(2);
  s.segments[0].name = "thigh";
  s.segments[0].markers = {0, 2};
  s.segments[0].x_in_segment = Eigen::Matrix3Xd::Zero(3, 2);
  s.segments[0].x_in_segment.col(1) = Eigen::Vector3d(0.1, 0.2, 0.3);
  s.segments[1].name = "shank";
  s.joints.resize(2);
  auto& knee = s.joints[0];
  knee.name = "knee";
  knee.kind = data::JointKind::hinge;
  knee.parent_segment = 0;
  knee.child_segment = 1;
  knee.method = "SARA";
  knee.description = "a hinge";
  knee.range_of_motion_rad = 90.0 * kRadPerDeg;
  knee.axis_in_parent = knee.axis_in_child = Eigen::Vector3d::UnitZ();
  knee.axis_sd_rad = 1.0 * kRadPerDeg;
  knee.centre_in_parent = Eigen::Vector3d(0.0, -0.4, 0.0);
  knee.covariance_in_parent = 1e-6 * Eigen::Matrix3d::Identity();
  knee.covariance_in_child = Eigen::Matrix3d::Constant(kNaN);
  s.joints[1].name = "lost";
  s.joints[1].kind = data::JointKind::ball;
  s.joints[1].parent_segment = 1;
  s.joints[1].child_segment = 0;
  s.joints[1].covariance_in_parent = s.joints[1].covariance_in_child = Eigen::Matrix3d::Constant(kNaN);
  s.centre_in_world.assign(3 * 4 * 2, kNaN);
  s.covariance.assign(6 * 4 * 2, kNaN);
  s.state.assign(8, CentreState::undetermined);
  const CentreState states[] = {CentreState::determined, CentreState::bridged, CentreState::ambiguous};
  for (std::int64_t f = 0; f < 3; ++f) {
    const auto i = static_cast<std::size_t>(s.index(f, 0));
    s.state[i] = states[f];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      s.centre_in_world[3 * i + axis] = static_cast<double>(f) + 0.1 * static_cast<double>(axis);
      s.covariance[6 * i + axis] = 0.0;
      s.covariance[6 * i + 3 + axis] = 0.0;
    }
  }
  s.lengths.push_back({.name = "knee to lost", .joint_a = 0, .joint_b = 1, .length_m = 0.4, .sd_m = 0.002});
  s.warnings = {"odd"};
  return s;
}

TEST(SkeletonJson, UnknownNumbersAreNullAndAnglesDegrees) {
  auto skeleton = small();
  skeleton.time.first_number = 101;
  const auto json = skeleton_json(skeleton);
  EXPECT_EQ(json["schema"], "kinemark.skeleton");
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["frames"], 4);
  EXPECT_EQ(json["first_frame"], 101);
  EXPECT_EQ(json["segments"][0]["markers"][1]["name"], "C");
  EXPECT_EQ(json["segments"][0]["markers"][1]["x_in_segment_m"], nlohmann::json({0.1, 0.2, 0.3}));
  const auto& knee = json["joints"][0];
  EXPECT_EQ(knee["parent"], "thigh");
  EXPECT_NEAR(knee["range_of_motion_deg"].get<double>(), 90.0, 1e-12);
  EXPECT_NEAR(knee["axis_sd_deg"].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(knee["centre_in_parent_m"], nlohmann::json({0.0, -0.4, 0.0}));
  EXPECT_EQ(knee["covariance_in_parent_m2"][1][1], 1e-6);
  EXPECT_TRUE(knee["centre_in_child_m"].is_null());
  EXPECT_TRUE(knee["covariance_in_child_m2"].is_null());
  EXPECT_EQ(knee["frames"].dump(), R"({"determined":1,"bridged":1,"ambiguous":1,"undetermined":1})");
  const auto& lost = json["joints"][1];
  EXPECT_TRUE(lost["centre_sd_m"].is_null()) << "placed nowhere";
  EXPECT_FALSE(lost.contains("axis_in_parent")) << "a ball has no axis";
  EXPECT_EQ(json["lengths"][0]["to"], "lost");
  EXPECT_EQ(json["warnings"], nlohmann::json({"odd"}));
}

TEST(SkeletonJson, AccuracyRepeatabilityAndSourceStandBesideEachOther) {
  auto skeleton = small();
  auto& knee = skeleton.joints[0];
  knee.covariance_in_parent = Eigen::Vector3d(3e-6, 1e-6, 0.04).asDiagonal();
  knee.repeatability_in_parent = Eigen::Vector3d(1e-8, 0.0, 0.04).asDiagonal();
  knee.prior_share = 0.7;
  knee.skin = {.verdict = data::SkinVerdict::follows,
               .movements = 8,
               .alike = 7,
               .p_value = 0.001,
               .explained = 0.8,
               .own_slide_m = 0.005,
               .own_limit_m = 0.006,
               .description = "The markers' shape follows the posture."};
  auto json = skeleton_json(skeleton)["joints"][0];
  EXPECT_NEAR(json["accuracy_sd_m"].get<double>(), 2e-3, 1e-12) << "across the axis";
  EXPECT_NEAR(json["repeatability_sd_m"].get<double>(), 1e-4, 1e-12);
  EXPECT_EQ(json["source"], "prior");
  EXPECT_EQ(json["skin"]["verdict"], "follows the posture");
  EXPECT_EQ(json["skin"]["alike"], 7);
  EXPECT_TRUE(json["skin"]["gap_with_posture_m"].is_null());
  EXPECT_THAT(skeleton_description(skeleton)[1], HasSubstr("knee: The markers' shape follows the posture."));
  knee.prior_share = 0.3;
  EXPECT_EQ(skeleton_json(skeleton)["joints"][0]["source"], "recording");
  json = skeleton_json(small())["joints"][1];
  EXPECT_TRUE(json["source"].is_null() && json["prior_share"].is_null()) << "skin was not looked at";
  EXPECT_EQ(json["skin"]["verdict"], "untested");
}

TEST(SkeletonDescription, OneLineAJointAndALength) {
  const auto lines = skeleton_description(small());
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], HasSubstr("knee (hinge, SARA): a hinge; placed in 3 of 4 frames"));
  EXPECT_THAT(lines[0], HasSubstr("across the axis"));
  EXPECT_THAT(lines[0], HasSubstr("1 ambiguous"));
  EXPECT_THAT(lines[1], HasSubstr("lost (ball, not found): ; placed in 0 of 4 frames"));
  EXPECT_EQ(lines[2], "knee to lost: 400.0 mm (SD 2.0)");
}

TEST(CentreTrajectories, StatesSayHowEachCentreWasFound) {
  const auto centres = workflow::centre_trajectories(small());
  EXPECT_THAT(centres.names, ElementsAre("knee", "lost"));
  EXPECT_EQ(centres.state[centres.index(0, 0)], data::SampleState::model_filled);
  EXPECT_EQ(centres.made_by(0, 0), "SARA: determined");
  EXPECT_EQ(centres.state[centres.index(1, 0)], data::SampleState::interpolated);
  EXPECT_EQ(centres.made_by(1, 0), "SARA: bridged");
  EXPECT_EQ(centres.made_by(2, 0), "SARA: ambiguous");
  EXPECT_FALSE(centres.present(3, 0));
  EXPECT_NEAR(centres.x(2, 0).y(), 2.1, 1e-15);
  for (std::int64_t f = 0; f < 4; ++f) EXPECT_FALSE(centres.present(f, 1));
}

TEST(JointsJson, TellsHowTheSkeletonWasFound) {
  JointsJob job;
  job.method = "sara";
  job.command_line = "kinemark joints walk.c3d";
  JointsOutcome outcome;
  outcome.skeleton = small();
  outcome.input = {.role = "markers", .path = "walk.c3d", .bytes = 3, .hash = "00ff", .hash_kind = "XXH3-64"};
  outcome.warnings = {"Left out: a spike"};
  auto json = joints_json(job, outcome);
  EXPECT_EQ(json["command"], job.command_line);
  EXPECT_EQ(json["input"].dump(), R"({"path":"walk.c3d","xxh3_64":"00ff"})");
  EXPECT_EQ(json["method"], "sara");
  EXPECT_EQ(json["notes"], nlohmann::json({"Left out: a spike"}));
  EXPECT_EQ(json["slips"].dump(), "[]");
  EXPECT_FALSE(json.contains("topology")) << "the segments were given";
  EXPECT_FALSE(json.contains("marker_noise"));
  outcome.marker_noise_sd_m = {0.001, kNaN, 0.002};
  outcome.topology.emplace();
  outcome.topology->markers.resize(3);
  outcome.topology->markers[1].doubtful = true;
  outcome.topology->joints.resize(1);
  outcome.topology->joints[0].margin = std::numeric_limits<double>::infinity();
  outcome.topology->layout.joints.push_back({"knee", 0, 1});
  json = joints_json(job, outcome);
  ASSERT_EQ(json["marker_noise"].size(), 2U) << "that of B is not known";
  EXPECT_EQ(json["marker_noise"][1]["name"], "C");
  EXPECT_EQ(json["topology"]["markers"][1]["doubtful"], true);
  EXPECT_EQ(json["topology"]["joints"][0]["name"], "knee");
  EXPECT_TRUE(json["topology"]["joints"][0]["margin"].is_null()) << "no other tree was possible";
}

/// A search without named segments of which one joint is known.
JointsOutcome searched() {
  JointsOutcome out;
  out.markers = {"LASI", "RASI", "LTH3", "LSK1", "LSK2", "LHJC"};
  out.skeleton = small();
  auto& found = out.segmentation.emplace();
  found.from_names = true;
  found.sets = {"Plug-in Gait", "CAST"};
  for (const char* name : {"hip_l", "knee_l"})
    found.joints.push_back({.name = name,
                            .parent_name = "pelvis",
                            .child_name = "thigh_l",
                            .parent = {0, 1},
                            .child = {2},
                            .known = true,
                            .gap_m = 0.002,
                            .turn_rad = 0.3,
                            .weight = 1.0,
                            .rivals = {},
                            .reason = {}});
  auto& knee = found.joints[1];
  knee.known = false;
  knee.reason = "the two hardly turn";
  knee.spread_m = knee.gap_m = kNaN;
  knee.rivals.push_back({.parent = {0, 1}, .child = {3, 4}, .weight = 0.25, .distance_m = 0.08});
  found.aside.push_back({.marker = 2, .segment = "thigh_l", .distance_sd_m = 0.031});
  found.model_outputs = {5};
  return out;
}

TEST(JointsJson, TheSegmentationHoldsJointsRivalsAndMarkersByName) {
  const auto json = joints_json({}, searched())["segmentation"];
  EXPECT_EQ(json["from"], "names");
  EXPECT_EQ(json["sets"].dump(), R"(["Plug-in Gait","CAST"])");
  EXPECT_EQ(json["put_aside"][0]["marker"], "LTH3");
  EXPECT_EQ(json["model_outputs"].dump(), R"(["LHJC"])");
  ASSERT_EQ(json["known"].size(), 1U);
  EXPECT_EQ(json["known"][0]["gap_m"], 0.002);
  EXPECT_FALSE(json["known"][0].contains("words"));
  const auto& open = json["not_determined"][0];
  EXPECT_TRUE(open["gap_m"].is_null() && open["between_rivals_m"].is_null());
  EXPECT_EQ(open["rivals"][0]["child_markers"].dump(), R"(["LSK1","LSK2"])");
  EXPECT_THAT(open["words"].get<std::string>(), HasSubstr("the two hardly turn; a rival: [LASI, RASI]"));
}

}  // namespace

}  // namespace kinemark::pipeline
