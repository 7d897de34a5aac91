// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/internal/joints_segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/math/euler.h"

namespace kinemark::workflow {
namespace {

/// A hip and a knee that a search without named segments found and an estimate placed to 1 mm per axis.
JointsFound found_leg() {
  JointsFound out;
  out.markers = {"LASI", "RASI", "LPSI", "LTH1", "LTH2", "LTH3",
                 "LSK1", "LSK2", "LSK3", "LKNE", "LHJC", "M7"};
  auto& s = out.skeleton;
  s.markers = out.markers;
  s.time = {.rate_hz = 50.0, .t0_s = 0.0, .frames = 3};
  s.noise_sd_m = 0.001;
  for (const char* name : {"pelvis", "thigh_l", "shank_l"}) {
    const int first = 3 * static_cast<int>(s.segments.size());
    s.segments.push_back({.name = name,
                          .markers = {first, first + 1, first + 2},
                          .x_in_segment = Eigen::Matrix3Xd::Zero(3, 3)});
    out.layout.segments.push_back({name, s.segments.back().markers});
  }
  auto& found = out.segmentation.emplace();
  found.from_names = true;
  found.sets = {"Plug-in Gait", "CAST"};
  for (const char* name : {"hip_l", "knee_l"}) {
    const int j = static_cast<int>(s.joints.size());
    auto& joint = s.joints.emplace_back();
    joint.name = name;
    joint.parent_segment = j;
    joint.child_segment = j + 1;
    joint.covariance_in_parent = joint.covariance_in_child = 1e-6 * Eigen::Matrix3d::Identity();
    joint.description = "known";
    out.layout.joints.push_back({name, j, j + 1});
    found.joints.push_back({.name = name,
                            .parent_name = s.segments[static_cast<std::size_t>(j)].name,
                            .child_name = s.segments[static_cast<std::size_t>(j) + 1].name,
                            .parent = s.segments[static_cast<std::size_t>(j)].markers,
                            .child = s.segments[static_cast<std::size_t>(j) + 1].markers,
                            .known = true,
                            .gap_m = 0.002,
                            .turn_rad = 0.3,
                            .weight = 1.0,
                            .rivals = {},
                            .reason = {}});
    found.spread_m.push_back(0.0);
  }
  found.layout = out.layout;
  s.allocate_centres();
  for (std::int64_t f = 0; f < 3; ++f)
    for (std::int64_t j = 0; j < 2; ++j) {
      const std::size_t i = s.index(f, j);
      s.state[i] = data::CentreState::determined;
      for (std::size_t k = 0; k < 3; ++k) s.centre_in_world[3 * i + k] = 0.1 * static_cast<double>(j);
      for (const std::size_t k : {0U, 3U, 5U}) s.covariance[6 * i + k] = 1e-6;
      for (const std::size_t k : {1U, 2U, 4U}) s.covariance[6 * i + k] = 0.0;
    }
  s.lengths.push_back(
      {.name = "hip_l to knee_l", .joint_a = 0, .joint_b = 1, .length_m = 0.4, .sd_m = 0.002});
  return out;
}

/// Whether a note, a gate or a joint's words hold these words.
bool says(const JointsFound& outcome, const std::string& words) {
  const auto holds = [&](const std::string& text) { return text.find(words) != std::string::npos; };
  return std::ranges::any_of(outcome.remarks.warnings, holds) ||
         std::ranges::any_of(outcome.remarks.gates, holds, &data::Gate::sentence) ||
         std::ranges::any_of(outcome.skeleton.joints, holds, &data::SkeletonJoint::description);
}

JointsFound settled(JointsFound outcome) {
  settle_segmentation(outcome);
  return outcome;
}

TEST(SettleSegmentation, ALegOfWhichAllIsKnownHasOneSentence) {
  const auto out = settled(found_leg());
  EXPECT_TRUE(out.remarks.passed());
  ASSERT_EQ(out.remarks.warnings.size(), 1U);
  EXPECT_TRUE(says(out, "Segments from the markers' names (Plug-in Gait and CAST); 2 of 2 joints are known."))
      << out.remarks.warnings[0];
  EXPECT_EQ(out.skeleton.joints.size(), 2U);
  EXPECT_FALSE(says(out, "Not determined: joint '"));
  EXPECT_FALSE(says(out, "; rivals of its segmentation place it"));
  EXPECT_FALSE(says(out, "Segments from how the markers move, as their names are of no known set:"));
  EXPECT_FALSE(says(out, "Points that a model made of markers, by their names, were left out:"));
  EXPECT_FALSE(says(out, ", but its distances to the markers there vary by"));
  EXPECT_FALSE(says(out, "On neither side of a joint, as they lie over it or beside it:"));
  EXPECT_FALSE(says(out, "On no segment of a joint that was looked for:"));
  EXPECT_FALSE(says(out, "no centre fits its markers"));
  EXPECT_FALSE(says(out, "the markers leave it open by"));
  EXPECT_FALSE(says(out, "no markers tell how well it is known"));
  EXPECT_FALSE(says(out, "No joint is determined. Name the segments of the body in a file"));
}

TEST(SettleSegmentation, NamedSegmentsAreNoneOfItsBusiness) {
  auto named = found_leg();
  named.segmentation.reset();
  named = settled(std::move(named));
  EXPECT_TRUE(named.remarks.warnings.empty() && named.remarks.gates.empty());
  EXPECT_EQ(named.skeleton.joints[0].description, "known");
  EXPECT_FALSE(says(named, "joints are known"));
  EXPECT_FALSE(says(named, "Segments from the markers' names ("));
}

TEST(SettleSegmentation, SegmentsFromTheDataSayHowManyWereCompared) {
  auto of_data = found_leg();
  of_data.segmentation->from_names = false;
  of_data.segmentation->rivals = 5;
  of_data = settled(std::move(of_data));
  EXPECT_TRUE(says(of_data,
                   "Segments from how the markers move, as their names are of no known set: 5 segmentations "
                   "compared; 2 of 2 joints are known."));
  EXPECT_FALSE(says(of_data, "Segments from the markers' names ("));
}

TEST(SettleSegmentation, WhatRivalsDisagreeByIsInTheErrorBar) {
  auto out = found_leg();
  out.segmentation->joints[0].spread_m = 0.006;
  out = settled(std::move(out));
  EXPECT_TRUE(out.remarks.passed());
  const auto& hip = out.skeleton.joints[0];
  EXPECT_NEAR(hip.covariance_in_parent(1, 1), 1e-6 + 12e-6, 1e-15) << "a third of 36 for each axis";
  EXPECT_NEAR(hip.covariance_in_child(2, 2), 13e-6, 1e-15);
  EXPECT_EQ(hip.covariance_in_parent(0, 1), 0.0);
  EXPECT_TRUE(
      hip.description.ends_with("; rivals of its segmentation place it 6.0 mm away (RMS), which widens "
                                "this to 3.6 mm and is in the SD"))
      << hip.description;
  EXPECT_NEAR(out.skeleton.covariance[6 * out.skeleton.index(1, 0)], 13e-6, 1e-15);
  EXPECT_NEAR(out.skeleton.covariance[6 * out.skeleton.index(1, 1)], 1e-6, 1e-15) << "the knee's is its own";
  EXPECT_NEAR(out.skeleton.lengths[0].sd_m, std::hypot(0.002, 0.006 / std::numbers::sqrt3), 1e-12);
  EXPECT_EQ(out.skeleton.joints[1].description, "known");
}

TEST(SettleSegmentation, ARivalsPlaceOfAHingeCountsAcrossItsAxis) {
  auto out = found_leg();
  auto& knee = out.skeleton.joints[1];
  knee.kind = data::JointKind::hinge;
  knee.axis_in_parent = knee.axis_in_child = Eigen::Vector3d::UnitX();
  knee.covariance_in_parent(0, 0) = knee.covariance_in_child(0, 0) = 1.0;
  out.segmentation->joints[1].spread_m = 0.004;
  out = settled(std::move(out));
  EXPECT_NEAR(out.skeleton.joints[1].covariance_in_child(2, 2), 9e-6, 1e-15) << "half of 16 for each axis";
  EXPECT_TRUE(says(out, "which widens this to 3.0 mm"));
  EXPECT_EQ(out.skeleton.joints.size(), 2U) << "a metre along the axis is open and no fault";
}

TEST(SettleSegmentation, AJointThatTheEstimateDoesNotHaveIsNotKnown) {
  auto out = found_leg();
  out.skeleton = keep_joints(out.skeleton, {1, 0});
  out = settled(std::move(out));
  EXPECT_FALSE(out.remarks.passed());
  EXPECT_TRUE(says(out, "1 of 2 joints are known"));
  EXPECT_TRUE(
      says(out,
           "Not determined: joint 'knee_l' between thigh_l [LTH1, LTH2, LTH3] and shank_l [LSK1, LSK2, "
           "LSK3]: no centre fits its markers."));
  ASSERT_EQ(out.layout.joints.size(), 1U);
  EXPECT_EQ(out.layout.segments.size(), 2U) << "the shank has no joint left";
  EXPECT_EQ(out.remarks.gates[0].name, "determined");
}

TEST(SettleSegmentation, WhatWasLeftOutAsNoBodysIsTheReason) {
  auto out = found_leg();
  out.skeleton = keep_joints(out.skeleton, {1, 0});
  out.left_out.push_back({.is_segment = true,
                          .name = "shank_l",
                          .other = {},
                          .figure = skeleton::BodyFigure::shape,
                          .value_m = 0.09,
                          .least_m = 0.0,
                          .most_m = 0.02,
                          .markers = {"LSK1"}});
  const std::string why = out.left_out[0].description();
  out = settled(std::move(out));
  EXPECT_TRUE(says(out, why));
  EXPECT_FALSE(says(out, "no centre fits its markers"));
}

TEST(SettleSegmentation, AJointThatTheMarkersLeaveOpenIsTakenOut) {
  for (const double sd_m : {0.019, 0.021, kNaN}) {
    auto out = found_leg();
    out.skeleton.joints[0].covariance_in_parent = sd_m * sd_m * Eigen::Matrix3d::Identity();
    out.skeleton.warnings = {"Joint 'hip_l' is odd.", "Joint 'knee_l' is odd."};
    out = settled(std::move(out));
    const bool known = sd_m < 0.02;
    EXPECT_EQ(out.remarks.passed(), known);
    ASSERT_EQ(out.skeleton.joints.size(), known ? 2U : 1U);
    EXPECT_EQ(out.skeleton.warnings.size(), known ? 2U : 1U) << "what is said of it goes with it";
    EXPECT_EQ(out.skeleton.lengths.size(), known ? 1U : 0U);
    if (known) continue;
    EXPECT_EQ(out.skeleton.joints[0].name, "knee_l");
    EXPECT_EQ(out.skeleton.warnings[0], "Joint 'knee_l' is odd.");
    EXPECT_NEAR(out.skeleton.centre(1, 0).x(), 0.1, 1e-15) << "its centres are its own";
    if (std::isnan(sd_m))
      EXPECT_TRUE(says(out, "no markers tell how well it is known"));
    else
      EXPECT_TRUE(says(out, "the markers leave it open by 21 mm (SD for each axis; 20 at most)"));
  }
}

TEST(SettleSegmentation, WithoutAJointItSaysWhatToDo) {
  auto out = found_leg();
  out.skeleton = keep_joints(out.skeleton, {0, 0});
  out = settled(std::move(out));
  EXPECT_FALSE(out.remarks.passed());
  EXPECT_TRUE(
      says(out,
           "No joint is determined. Name the segments of the body in a file (--segments), or record a "
           "movement of the joint with three markers or more"));
  EXPECT_TRUE(says(out, "0 of 2 joints are known"));
  EXPECT_EQ(std::ranges::count(out.remarks.gates, "determined", &data::Gate::name), 2) << "one a joint";
  EXPECT_EQ(std::ranges::count(out.remarks.gates, "any_joint", &data::Gate::name), 1);
  EXPECT_TRUE(out.layout.joints.empty() && out.layout.segments.empty());
}

TEST(SettleSegmentation, MarkersThatWereNotUsedAreNamed) {
  auto out = found_leg();
  auto& found = *out.segmentation;
  found.aside.push_back({.marker = 5, .segment = "thigh_l", .distance_sd_m = 0.031});
  found.over_joints = {9};
  found.model_outputs = {10};
  found.unplaced = {11};
  out = settled(std::move(out));
  EXPECT_TRUE(says(out, "Points that a model made of markers, by their names, were left out: LHJC."));
  EXPECT_TRUE(
      says(out,
           "Marker 'LTH3' was put aside: its name says thigh_l, but its distances to the markers there "
           "vary by 31 mm (median SD)."));
  EXPECT_TRUE(says(out, "On neither side of a joint, as they lie over it or beside it: LKNE."));
  EXPECT_TRUE(says(out, "On no segment of a joint that was looked for: M7."));
  EXPECT_TRUE(out.remarks.passed()) << "none of this is a fault";
}

// Three bodies about two balls, and a point that a model made.
data::Trajectories moving(const std::vector<std::string>& names) {
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 50.0, .t0_s = 0.0, .frames = 300});
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const double t = 0.05 * static_cast<double>(f);
    Eigen::Matrix3d R = math::exp_so3({0.3 * std::sin(0.7 * t), 0.2 * std::cos(0.9 * t), 0.1});
    Eigen::Vector3d at(0.1 * std::sin(t), 0.0, 1.0);
    for (int m = 0; m < out.markers(); ++m) {
      if (m > 0 && m % 4 == 0 && m < 12) {
        at += R * Eigen::Vector3d(0.0, 0.0, -0.3);
        R = R *
            math::exp_so3({0.6 * std::sin((0.8 + 0.1 * m) * t), 0.5 * std::sin((1.3 + 0.1 * m) * t), 0.0});
      }
      const int k = m % 4;
      out.x(f, m) =
          at + R * Eigen::Vector3d(0.05 * std::cos(1.6 * k), 0.05 * std::sin(1.6 * k), -0.05 - 0.04 * k);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

TEST(FindSegmentation, NumbersAreThoseOfTheRecordingAlsoWithoutWhatAModelMade) {
  std::vector<std::string> names{"LHJC"};
  for (int m = 1; m < 12; ++m) names.push_back("M" + std::to_string(m));
  const auto markers = moving(names);
  JointsFound out;
  out.markers = names;
  const auto layout = find_segmentation({}, markers, out);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(out.segmentation->model_outputs, (std::vector<int>{0}));
  ASSERT_EQ(layout->segments.size(), 3U);
  EXPECT_EQ(layout->segments[0].markers, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(layout->segments[1].markers, (std::vector<int>{4, 5, 6, 7}));
  EXPECT_EQ(layout->segments[2].markers, (std::vector<int>{8, 9, 10, 11}));
  for (const auto& joint : out.segmentation->joints)
    EXPECT_EQ(joint.parent, layout->segments[joint.parent_name == "segment1" ? 0U : 1U].markers);
  ASSERT_TRUE(out.topology);
  EXPECT_EQ(out.topology->markers.size(), 12U);
}

TEST(FindSegmentation, NamesOfAKnownSetComeFirst) {
  const auto markers = moving(
      {"LASI", "RASI", "LPSI", "RPSI", "LTH1", "LTH2", "LTH3", "LTH4", "LSK1", "LSK2", "LSK3", "LSK4"});
  JointsFound out;
  const auto layout = find_segmentation({}, markers, out);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_FALSE(out.topology);
  EXPECT_TRUE(out.segmentation->from_names);
  ASSERT_EQ(layout->joints.size(), 2U);
  EXPECT_EQ(layout->joints[1].name, "knee_l");
}

TEST(FindSegmentation, WhereNothingMovesThereIsNoJoint) {
  std::vector<std::string> names;
  for (int m = 0; m < 8; ++m) names.push_back("M" + std::to_string(m));
  auto markers = moving(names);
  for (std::int64_t f = 1; f < markers.frames(); ++f)
    for (int m = 0; m < 8; ++m) markers.x(f, m) = markers.x(0, m);
  JointsFound out;
  const auto layout = find_segmentation({}, markers, out);
  ASSERT_FALSE(layout);
  EXPECT_EQ(layout.error().code, Code::bad_input);
  EXPECT_FALSE(out.segmentation);
}

}  // namespace
}  // namespace kinemark::workflow
