// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/joints/joints.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "kinemark/core/missing.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/workflow/joints/internal/joints_segmentation.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// An arm that reaches for 3 s, with what is known of it.
class JointsVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    limb = simulation::simulate_sleeve({.duration_s = 3.0, .noise_sd_m = 0.0005, .line_of_sight = false})
               .value();
    recording.trial.markers = limb.markers;
    recording.trial.first_frame = 101;
    options.segments = limb.layout;
  }
  [[nodiscard]] double rms_m(const data::Skeleton& skeleton) const {
    double squares = 0.0;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f)
      squares +=
          (skeleton.centre(f, 0) - Eigen::Vector3d(&limb.centre_in_world[static_cast<std::size_t>(3 * f)]))
              .squaredNorm();
    return std::sqrt(squares / static_cast<double>(skeleton.frames()));
  }

  simulation::LimbRecording limb;
  data::Recording recording;
  JointsOptions options;
};

TEST_F(JointsVerb, FindsTheElbowFromMemory) {
  const auto found = joints(recording, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->markers, limb.markers.names);
  ASSERT_EQ(found->skeleton.joints.size(), 1U);
  EXPECT_LT(rms_m(found->skeleton), 0.002);
  EXPECT_TRUE(found->remarks.passed());
  EXPECT_FALSE(found->segmentation) << "the segments were given";
  const auto centres = centre_trajectories(found->skeleton);
  EXPECT_EQ(centres.names, (std::vector<std::string>{"elbow", "shoulder"}));
  EXPECT_TRUE(centres.made_by(0, 0).ends_with(": determined"));
  EXPECT_THAT(std::string(centres.made_by(0, 1)), HasSubstr("stays in the room"));
  EXPECT_THAT(std::string(centres.made_by(0, 0)), Not(HasSubstr("stays in the room")));
  EXPECT_LT(centres.x(0, 1).norm(), 0.005) << "the shoulder is the origin";
  ASSERT_EQ(found->layout.ends.size(), 1U);
  EXPECT_EQ(found->layout.ends[0].name, "shoulder");
}

TEST_F(JointsVerb, TheRecordingStaysAsItIs) {
  recording.trial.markers.x(100, 2) += Eigen::Vector3d(0.2, 0.0, 0.0);
  const auto before = recording.trial.markers.x_in_world;
  const auto found = joints(recording, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(std::ranges::equal(recording.trial.markers.x_in_world, before));
  EXPECT_EQ(found->used.state[found->used.index(100, 2)], data::SampleState::rejected);
  EXPECT_THAT(found->remarks.warnings, Contains(HasSubstr("Left out: ")));
  options.drop_doubtful = false;
  const auto kept = joints(recording, options);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->used.state[kept->used.index(100, 2)], data::SampleState::measured);
  EXPECT_THAT(kept->remarks.warnings, Not(Contains(HasSubstr("Left out: "))));
}

TEST_F(JointsVerb, WhatAPersonHasSwappedStaysSwapped) {
  auto& markers = recording.trial.markers;
  for (std::int64_t f = 120; f < 160; ++f) {
    const Eigen::Vector3d first = markers.x(f, 0);
    markers.x(f, 0) = markers.x(f, 1);
    markers.x(f, 1) = first;
  }
  const auto back = joints(recording, options);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->remarks.warnings, Contains(HasSubstr("Exchanged back: ")));
  recording.edits.swapped = {{markers.names[0], markers.names[1]}};
  const auto left = joints(recording, options);
  ASSERT_TRUE(left) << left.error().message;
  EXPECT_THAT(left->remarks.warnings, Not(Contains(HasSubstr("Exchanged back: "))));
}

TEST_F(JointsVerb, WithoutSegmentsTheyAreFound) {
  options.segments.reset();
  const auto found = joints(recording, options);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(found->segmentation);
  EXPECT_FALSE(found->remarks.warnings.empty());
  EXPECT_THAT(describe_origin(*found->segmentation), HasSubstr("from how the markers move"));
}

TEST_F(JointsVerb, AJointThatTheMotionLeavesOpenIsNotKnown) {
  const auto chain = simulation::simulate_chain(
      {.frames = 300, .markers_per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005});
  const auto known = joints({.trial = {.markers = chain->markers}}, JointsOptions{{.method = "score"}});
  ASSERT_TRUE(known) << known.error().message;
  EXPECT_TRUE(known->remarks.passed());
  ASSERT_EQ(known->skeleton.joints.size(), 1U);
  const auto none = keep_joints(known->skeleton, {0});
  EXPECT_TRUE(none.joints.empty() && none.segments.empty() && none.lengths.empty());
  EXPECT_TRUE(none.validate());
  // Its SD beyond the bound: nothing of it is left.
  auto wide = *known;
  wide.skeleton.joints[0].covariance_in_child = 0.021 * 0.021 * Eigen::Matrix3d::Identity();
  settle_segmentation(wide);
  EXPECT_TRUE(wide.skeleton.joints.empty());
  EXPECT_TRUE(wide.layout.joints.empty() && wide.layout.segments.empty());
  EXPECT_FALSE(wide.remarks.passed());
  EXPECT_THAT(wide.segmentation->joints[0].reason, HasSubstr("21 mm"));
}

TEST_F(JointsVerb, AJointWithoutMarkersOnOneSideIsPlacedInNoFrame) {
  auto chain = simulation::simulate_chain({.frames = 200,
                                           .lengths_m = {0.15, 0.16, 0.14},
                                           .markers_per_segment = 4,
                                           .stagger_m = 0.03,
                                           .noise_sd_m = 0.0005})
                   .value();
  const auto found = [&] {
    return joints({.trial = {.markers = chain.markers}}, JointsOptions{{.method = "score"}, chain.layout});
  };
  const auto whole = found();
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_TRUE(whole->remarks.passed());
  EXPECT_THAT(whole->remarks.warnings, Not(Contains(HasSubstr("was placed in no frame."))));
  for (std::int64_t f = 0; f < 200; ++f)
    for (const int m : chain.layout.segments[2].markers) {
      chain.markers.x(f, m).setConstant(kNaN);
      chain.markers.state[chain.markers.index(f, m)] = data::SampleState::missing;
    }
  const auto part = found();
  ASSERT_TRUE(part) << part.error().message;
  ASSERT_EQ(part->skeleton.joints.size(), 2U);
  EXPECT_FALSE(part->remarks.passed());
  EXPECT_THAT(part->remarks.warnings,
              Contains("Joint '" + part->skeleton.joints[1].name + "' was placed in no frame."));
  EXPECT_EQ(part->remarks.gates.size(), 1U) << "the other joint has all that it had";
}

TEST_F(JointsVerb, WhatCannotBeAskedIsRefused) {
  options.method = "guess";
  EXPECT_EQ(joints(recording, options).error().code, Code::usage);
  options.method = "score";
  options.soft_tissue = true;
  EXPECT_THAT(joints(recording, options).error().message, HasSubstr("soft tissue is a term"));
  options.soft_tissue = false;
  options.noise_sd_m = kNaN;
  EXPECT_EQ(joints(recording, options).error().code, Code::usage);
  options.noise_sd_m = 0.0;
  EXPECT_TRUE(JointsMethod(options).check());
}

TEST_F(JointsVerb, CanBeStopped) {
  options.progress = [](std::int64_t, std::int64_t) { return false; };
  const auto stopped = joints(recording, options);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
}

}  // namespace
}  // namespace kinemark::workflow
