// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/measured_joints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::AnyOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_leg::leg;
using testing_leg::sizes_and_hip;

/// Pelvis, thigh and shank of a leg as `joints` leaves them, in axes of their own.
data::Skeleton skeleton_of(const data::ModelDescription& model, double sd_m) {
  const Matrix3d R = Eigen::AngleAxisd(1.1, Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Vector3d t(0.1, 0.2, -0.3);
  data::Skeleton out;
  for (const char* name : {"pelvis", "thigh", "shank"}) {
    data::SkeletonSegment segment{.name = name};
    const int body = static_cast<int>(out.segments.size());
    std::vector<Vector3d> x;
    for (const auto& marker : model.markers) {
      if (marker.body_idx != body) continue;
      segment.markers.push_back(static_cast<int>(out.markers.size()));
      out.markers.push_back("Ann:" + marker.name);
      x.push_back(R * marker.x_in_body + t);
    }
    segment.x_in_segment.resize(3, static_cast<Index>(x.size()));
    for (Index k = 0; k < segment.x_in_segment.cols(); ++k)
      segment.x_in_segment.col(k) = x[static_cast<std::size_t>(k)];
    out.segments.push_back(std::move(segment));
  }
  for (int j = 0; j < 2; ++j) {
    const auto& joint = model.joints[static_cast<std::size_t>(j + 1)];
    out.joints.push_back({.name = j == 0 ? "hip" : "knee",
                          .parent_segment = j,
                          .child_segment = j + 1,
                          .centre_in_parent = R * joint.parent_from_joint.translation + t,
                          .centre_in_child = R * joint.child_from_joint.translation + t,
                          .covariance_in_parent = sd_m * sd_m * Matrix3d::Identity(),
                          .covariance_in_child = sd_m * sd_m * Matrix3d::Identity()});
  }
  return out;
}

TEST(MatchJoints, finds_the_joint_between_two_bodies_whichever_is_called_the_parent) {
  auto skeleton = skeleton_of(leg(), 0.002);
  const auto found = match_joints(leg(), skeleton);
  EXPECT_THAT(found.names, ElementsAre("hip_r"));
  EXPECT_THAT(found.left_out, Each(Not(HasSubstr("Joint 'hip' is not used: "))));
  ASSERT_EQ(found.joints.size(), 2U);
  EXPECT_TRUE(found.joints[0].in_parent);
  EXPECT_THAT(found.joints[0].markers, ElementsAre(0, 1, 2));
  EXPECT_FALSE(found.joints[1].in_parent);
  EXPECT_THAT(found.joints[1].markers, ElementsAre(3, 4, 5, 6));
  auto& hip = skeleton.joints[0];
  std::swap(hip.parent_segment, hip.child_segment);
  std::swap(hip.centre_in_parent, hip.centre_in_child);
  const auto turned = match_joints(leg(), skeleton);
  ASSERT_EQ(turned.joints.size(), 2U);
  EXPECT_FALSE(turned.joints[0].in_parent);
  EXPECT_THAT(turned.joints[0].markers, ElementsAre(3, 4, 5, 6));
  EXPECT_EQ(turned.joints[0].centre, found.joints[1].centre);
}

TEST(MatchJoints, says_of_each_joint_that_is_not_used_why) {
  auto skeleton = skeleton_of(leg(), 0.002);
  EXPECT_THAT(match_joints(leg(), skeleton).left_out,
              ElementsAre("Joint 'knee' is not used: the centre of 'knee_r' moves in the model."));
  skeleton.joints.erase(skeleton.joints.begin() + 1);
  skeleton.joints.push_back(skeleton.joints[0]);
  EXPECT_THAT(match_joints(leg(), skeleton).left_out, ElementsAre(HasSubstr("has a centre already")));
  skeleton.joints.pop_back();
  skeleton.joints[0].child_segment = 2;
  EXPECT_THAT(match_joints(leg(), skeleton).left_out,
              ElementsAre(HasSubstr("no joint of the model connects 'pelvis' and 'tibia_r'")));
  skeleton.joints[0].child_segment = 0;
  EXPECT_THAT(match_joints(leg(), skeleton).left_out, ElementsAre(HasSubstr("both its segments sit on")));
  skeleton.joints[0].child_segment = 1;
  for (auto* C : {&skeleton.joints[0].covariance_in_parent, &skeleton.joints[0].covariance_in_child})
    C->setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(match_joints(leg(), skeleton).left_out, ElementsAre(HasSubstr("its centre has no covariance")));
  for (auto* centre : {&skeleton.joints[0].centre_in_parent, &skeleton.joints[0].centre_in_child})
    centre->setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(match_joints(leg(), skeleton).left_out, ElementsAre(HasSubstr("its centre is not known")));
  skeleton = skeleton_of(leg(), 0.002);
  skeleton.joints.pop_back();
  skeleton.markers[0] = "unknown";
  const auto one_side = match_joints(leg(), skeleton);
  ASSERT_EQ(one_side.joints.size(), 1U);
  EXPECT_FALSE(one_side.joints[0].in_parent);
  skeleton.markers[3] = skeleton.markers[4] = "unknown";
  EXPECT_THAT(match_joints(leg(), skeleton).left_out, ElementsAre(HasSubstr("neither of its segments")));
  skeleton.markers[1] = "unknown";
  EXPECT_THAT(match_joints(leg(), skeleton).left_out,
              ElementsAre(HasSubstr("segment 'pelvis' has fewer than two markers")));
}

// Each reason is one of its own: the sentence of one joint names what is so of it, and nothing else.
TEST(MatchJoints, a_joint_is_left_out_for_its_own_reason_alone) {
  const auto skeleton = skeleton_of(leg(), 0.002);
  const std::string knee = match_joints(leg(), skeleton).left_out.at(0);
  EXPECT_THAT(knee, HasSubstr("the centre of 'knee_r' moves in the model"));
  EXPECT_THAT(
      knee, Not(AnyOf(HasSubstr("has fewer than two markers on one body of the model"),
                      HasSubstr("both its segments sit on '"), HasSubstr("no joint of the model connects '"),
                      HasSubstr("neither of its segments has three markers"))));
  EXPECT_THAT(knee,
              Not(AnyOf(HasSubstr("its centre has no covariance"), HasSubstr("its centre is not known"))));
  auto apart = skeleton;
  apart.joints.pop_back();
  apart.joints[0].child_segment = 2;
  EXPECT_THAT(match_joints(leg(), apart).left_out.at(0), Not(HasSubstr("' moves in the model")));
}

// Nobody moves: without the functional hip its position stays as the model has it.
TEST(MeasuredJoints, place_the_hip_of_a_subject_who_stands_still_within_its_deviation) {
  const auto list = sizes_and_hip(leg(), 0.04);
  constexpr int kSubjects = 12;
  double with = 0.0, without = 0.0, chi_squares = 0.0;
  for (int s = 0; s < kSubjects; ++s) {
    Random random(static_cast<std::uint64_t>(s + 1), 9);
    Eigen::VectorXd change(static_cast<Index>(list.size()));
    for (Index k = 0; k < change.size(); ++k)
      change[k] = list[static_cast<std::size_t>(k)].prior_sd * random.gaussian();
    const auto truth = apply_geometry(leg(), list, change);
    auto skeleton = skeleton_of(truth, 0.002);
    for (auto* centre : {&skeleton.joints[0].centre_in_parent, &skeleton.joints[0].centre_in_child})
      for (int axis = 0; axis < 3; ++axis) (*centre)[axis] += 0.002 * random.gaussian();
    const auto standing = testing_leg::record(
        truth, {.frames = 20, .noise_sd_m = 0.0005, .amplitude = 0.0, .seed = static_cast<std::uint64_t>(s)});
    AdaptOptions options;
    options.soft_tissue = false;
    options.max_iterations = 100;
    const auto alone = adapt_model(leg(), standing, list, options).value();
    options.joints = match_joints(leg(), skeleton).joints;
    const auto result = adapt_model(leg(), standing, list, options);
    ASSERT_TRUE(result) << result.error().message;
    // Distances of the hip from the markers of the pelvis: no axes of the body are in them.
    const auto distances = [](const data::ModelDescription& model) {
      Vector3d out;
      for (int m = 0; m < 3; ++m)
        out[m] = (model.joints[1].parent_from_joint.translation -
                  model.markers[static_cast<std::size_t>(m)].x_in_body)
                     .norm();
      return out;
    };
    with += (distances(result->model) - distances(truth)).squaredNorm() / 3.0 / kSubjects;
    without += (distances(alone.model) - distances(truth)).squaredNorm() / 3.0 / kSubjects;
    Eigen::VectorXd error(change.size());
    for (Index k = 0; k < error.size(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      error[k] = result->parameters[i].value - list[i].initial - change[k];
    }
    chi_squares +=
        error.dot(result->covariance.ldlt().solve(error)) / static_cast<double>(error.size()) / kSubjects;
  }
  EXPECT_LT(std::sqrt(with), 0.0025);
  EXPECT_GT(std::sqrt(without), 2.0 * std::sqrt(with));
  EXPECT_NEAR(chi_squares, 1.0, 3.0 * std::sqrt(2.0 / (static_cast<double>(list.size()) * kSubjects)));
}

TEST(MeasuredJoints, that_do_not_fit_the_model_are_refused) {
  const auto list = sizes_and_hip(leg(), 0.04);
  AdaptOptions options;
  options.joints = match_joints(leg(), skeleton_of(leg(), 0.002)).joints;
  const auto recording = testing_leg::record(leg(), {.frames = 10, .noise_sd_m = 0.001});
  options.joints[0].joint = "ankle";
  const auto result = adapt_model(leg(), recording, list, options);
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("measured joint 'ankle'"));
  options.joints[0].joint = "hip_r";
  options.joints[0].markers[0] = 99;
  EXPECT_FALSE(adapt_model(leg(), recording, list, options));
}

}  // namespace
}  // namespace kinemark::motion
