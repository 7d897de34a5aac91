// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/live/live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/stream/recorded_source.h"
#include "kinemark/workflow/motion/track.h"

namespace kinemark::workflow {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kRate_hz = 60.0;

/// A walk of 1.5 s; its eighth marker is lost for a third of a second.
struct Walk {
  model::Model model = model::Model::compile(pipeline::human_model().value()).value();
  data::Trajectories markers =
      simulation::simulate_subject(
          model, {.motion = simulation::MotionKind::walk, .duration_s = 1.5, .rate_hz = kRate_hz, .seed = 3})
          .value()
          .markers;
  motion::TrackOptions options{.marker_noise_sd_m = 1e-3};

  Walk() {
    for (std::int64_t f = 40; f < 60; ++f) markers.set_missing(f, 7);
  }
};

/// What came out of all frames of a source.
std::vector<motion::LivePose> follow(const model::Model& model, stream::Source& source,
                                     const motion::TrackOptions& options) {
  std::vector<motion::LivePose> out;
  const auto angles =
      live(model, source.facts(), [&](const auto& one) { out.push_back(one); }, options).value();
  for (stream::Frame frame; source.next(frame).value();) EXPECT_TRUE(angles->push(frame));
  EXPECT_TRUE(angles->finish());
  return out;
}

std::vector<motion::LivePose> follow(const Walk& walk) {
  stream::RecordedSource source(walk.markers, {.name = "walk"});
  return follow(walk.model, source, walk.options);
}

TEST(Live, FramesGivenOneAtATimeHaveTheAnglesOfTheRecording) {
  const Walk walk;
  const auto whole = track(walk.model, {.trial = {.markers = walk.markers}}, {.track = walk.options}).value();
  const auto& motion = whole.result.motion;
  const auto poses = follow(walk);
  ASSERT_EQ(static_cast<std::int64_t>(poses.size()), motion.frames());
  std::int64_t with_sd = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto& pose = poses[static_cast<std::size_t>(f)];
    EXPECT_EQ(pose.frame, f);
    EXPECT_NEAR(pose.time_s, motion.time.time_s(f), 1e-12);
    EXPECT_EQ(pose.status, motion.status[static_cast<std::size_t>(f)]);
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto i = motion.index(f, c);
      ASSERT_EQ(pose.q[c], motion.q[i]) << f << ' ' << c;
      ASSERT_EQ(pose.qd[c], motion.qd[i]);
      ASSERT_EQ(pose.determined[static_cast<std::size_t>(c)], motion.determined[i]);
      if (std::isnan(pose.q_sd[c])) continue;
      // A recording knows besides what the filter took away from the movement.
      ASSERT_NEAR(std::hypot(pose.q_sd[c], whole.result.filter_sd[i]), motion.q_sd[i], 1e-10);
      ++with_sd;
    }
  }
  EXPECT_GT(with_sd, motion.frames() * motion.size() / 2);
}

TEST(Live, AnglesComeAsManyFramesLaterAsItSays) {
  Walk walk;
  for (const double lookahead_s : {0.2, 0.3}) {
    walk.options.lookahead_s = lookahead_s;
    stream::RecordedSource source(walk.markers, {.name = "walk"});
    std::int64_t last = -1;
    const auto angles =
        live(walk.model, source.facts(), [&](const auto& one) { last = one.frame; }, walk.options).value();
    const auto delay = angles->delay_frames();
    EXPECT_NEAR(static_cast<double>(delay), lookahead_s * kRate_hz, 1.5);
    for (stream::Frame frame; source.next(frame).value();) {
      ASSERT_TRUE(angles->push(frame));
      ASSERT_EQ(last, frame.number <= delay ? -1 : frame.number - delay) << "all come with the first";
    }
    ASSERT_TRUE(angles->finish());
    EXPECT_EQ(last, walk.markers.frames() - 1);
  }
}

/// A device that counts from 1000 on and shows nobody for the first and the last half second.
class Device final : public stream::Source {
 public:
  explicit Device(data::Trajectories markers)
      : Source({.name = "device", .markers = markers.names, .rate_hz = kRate_hz}),
        markers_(std::move(markers)) {}
  Result<bool> next(stream::Frame& frame) override {
    constexpr std::int64_t kHalf = 30;
    if (came_ == markers_.frames() + 2 * kHalf) return false;
    frame.number = 1000 + came_;
    frame.time_s = 12.5 + static_cast<double>(came_) / kRate_hz;
    frame.clear(markers_.names.size());
    const auto f = came_++ - kHalf;
    for (std::int64_t m = 0; f >= 0 && f < markers_.frames() && m < markers_.markers(); ++m) {
      if (!markers_.present(f, m)) continue;
      Eigen::Map<Eigen::Vector3d>(frame.x_in_world.data() + 3 * m) = markers_.x(f, m);
      frame.state[static_cast<std::size_t>(m)] = data::SampleState::measured;
    }
    return true;
  }

 private:
  data::Trajectories markers_;
  std::int64_t came_ = 0;
};

TEST(Live, FramesHaveTheNumbersOfTheirSource) {
  const Walk walk;
  Device device(walk.markers);
  const auto poses = follow(walk.model, device, walk.options);
  ASSERT_EQ(poses.size(), 150U);
  for (std::size_t f = 0; f < poses.size(); ++f) {
    EXPECT_EQ(poses[f].frame, 1000 + static_cast<std::int64_t>(f));
    EXPECT_NEAR(poses[f].time_s, 12.5 + static_cast<double>(f) / kRate_hz, 1e-9);
  }
}

TEST(Live, WhereNoMarkerIsSeenNothingIsKnown) {
  const Walk walk;
  Device device(walk.markers);
  const auto poses = follow(walk.model, device, walk.options);
  for (const auto* nobody : {&poses.front(), &poses.back()}) {
    EXPECT_EQ(nobody->status, data::FrameStatus::no_markers);
    EXPECT_THAT(nobody->determined, Each(0));
    for (const auto* numbers : {&nobody->q, &nobody->qd, &nobody->qdd, &nobody->tau, &nobody->q_sd}) {
      EXPECT_EQ(numbers->size(), walk.model.coordinate_count());
      EXPECT_TRUE(numbers->array().isNaN().all());
    }
  }
  const auto& seen = poses[75];
  EXPECT_TRUE(seen.q.allFinite());
  EXPECT_GT(std::ranges::count(seen.determined, 1), walk.model.coordinate_count() / 2);
}

TEST(Live, AFrameThatDoesNotAdvanceIsRefused) {
  const Walk walk;
  stream::RecordedSource source(walk.markers, {.name = "walk"});
  const auto angles = live(walk.model, source.facts(), [](const auto&) {}).value();
  stream::Frame frame;
  ASSERT_TRUE(source.next(frame).value());
  EXPECT_TRUE(angles->push(frame));
  EXPECT_THAT(angles->push(frame).error().message, HasSubstr("time runs backwards"));
}

TEST(Live, WhatCannotBeFollowedIsSaidWithTheNameOfTheSource) {
  const Walk walk;
  const auto refused = [&](const stream::SourceFacts& facts) {
    const auto angles = live(walk.model, facts, [](const auto&) {});
    return angles ? std::string("followed") : angles.error().message;
  };
  EXPECT_EQ(refused({.name = "cameras", .markers = walk.markers.names, .rate_hz = kRate_hz}), "followed");
  EXPECT_THAT(refused({.name = "cameras", .markers = {"nose"}, .rate_hz = kRate_hz}),
              StartsWith("cameras: no marker in common"));
  EXPECT_THAT(refused({.name = "cameras", .markers = walk.markers.names}),
              StartsWith("cameras: the rate is 0"));
  EXPECT_THROW((void)live(walk.model, {}, nullptr), ContractError);
}

TEST(Live, AFrameOfOtherMarkersBreaksTheContract) {
  const Walk walk;
  stream::RecordedSource source(walk.markers, {.name = "walk"});
  const auto angles = live(walk.model, source.facts(), [](const auto&) {}).value();
  stream::Frame frame;
  frame.clear(3);
  EXPECT_THROW((void)angles->push(frame), ContractError);
}

}  // namespace
}  // namespace kinemark::workflow
