// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/online_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;
using testing_body::record;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

Eigen::Matrix3Xd frame_of(const data::Trajectories& markers, std::int64_t f) {
  Eigen::Matrix3Xd x(3, markers.markers());
  for (std::int64_t m = 0; m < markers.markers(); ++m) x.col(m) = markers.x(f, m);
  return x;
}

/// All poses of a recording pushed frame by frame.
std::vector<LivePose> stream(OnlineTracker& tracker, const data::Trajectories& markers) {
  std::vector<LivePose> poses;
  const auto fetch = [&] {
    for (;;) {
      const auto pose = tracker.next();
      if (!pose || *pose == nullptr) break;
      poses.push_back(**pose);
    }
  };
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    EXPECT_TRUE(tracker.push(markers.time.time_s(f), frame_of(markers, f)));
    fetch();
  }
  tracker.finish();
  fetch();
  return poses;
}

TEST(OnlineTracker, GivesTheSameNumbersAsAFile) {
  const auto model = body();
  auto markers = record(model, 120, 1e-3, 6);
  for (std::int64_t f = 40; f < 70; ++f) markers.set_missing(f, 7);
  const TrackOptions options{.marker_noise_sd_m = 1e-3};
  const auto file = track_markers(model, markers, options).value();
  auto tracker = OnlineTracker::create(model, markers.names, 100.0, options);
  ASSERT_TRUE(tracker) << tracker.error().message;
  const auto live = stream(*tracker, markers);
  ASSERT_EQ(live.size(), 120u);
  EXPECT_EQ(tracker->locked_coordinates(), file.locked_coordinates);
  for (std::int64_t f = 0; f < 120; ++f) {
    const auto& pose = live[static_cast<std::size_t>(f)];
    EXPECT_EQ(pose.frame, f);
    EXPECT_NEAR(pose.time_s, file.motion.time.time_s(f), 1e-12);
    EXPECT_EQ(pose.status, file.motion.status[static_cast<std::size_t>(f)]) << f;
    EXPECT_EQ(pose.rank, file.rank[static_cast<std::size_t>(f)]);
    for (std::int64_t c = 0; c < file.motion.size(); ++c) {
      const auto i = file.motion.index(f, c);
      ASSERT_EQ(pose.q[c], file.motion.q[i]) << f << ' ' << c;
      ASSERT_EQ(pose.qd[c], file.motion.qd[i]);
      ASSERT_EQ(pose.qdd[c], file.motion.qdd[i]);
      if (!std::isnan(pose.tau[c])) {
        ASSERT_EQ(pose.tau[c], file.motion.tau[i]);
      }
      // A file knows besides what the filter took away from the movement.
      if (!std::isnan(pose.q_sd[c])) {
        ASSERT_NEAR(std::hypot(pose.q_sd[c], file.filter_sd[i]), file.motion.q_sd[i], 1e-10);
        ASSERT_GE(file.motion.q_bound[i], pose.q_bound[c] - 1e-10);
      }
    }
  }
}

TEST(OnlineTracker, DeviationsHoldWhatTheFilterDoesNotSee) {
  // Skin slides more slowly than any filter removes: each marker by 8 mm, in its own rhythm.
  const auto model = body();
  auto markers = record(model, 600, 0.2e-3, 6);
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    const double phase = 2.1 * static_cast<double>(m), hz = 0.4 + 0.05 * static_cast<double>(m % 7);
    const Eigen::Vector3d along(std::cos(phase), std::sin(phase), std::cos(1.7 * phase));
    for (std::int64_t f = 0; f < markers.frames(); ++f)
      markers.x(f, m) += 8e-3 * std::sin(2.0 * EIGEN_PI * hz * markers.time.time_s(f) + phase) * along;
  }
  const auto file = track_markers(model, markers).value();
  auto tracker = OnlineTracker::create(model, markers.names, 100.0).value();
  const auto live = stream(tracker, markers);
  std::vector<double> ratios, still;
  auto quiet = OnlineTracker::create(model, markers.names, 100.0).value();
  const auto rigid = stream(quiet, record(model, 600, 0.2e-3, 6));
  for (std::int64_t f = 300; f < 600; ++f)
    for (std::int64_t c = 0; c < file.motion.size(); ++c) {
      const auto& pose = live[static_cast<std::size_t>(f)];
      const double sd = file.motion.q_sd[file.motion.index(f, c)];
      if (!(sd > 0.0) || std::isnan(pose.q_sd[c])) continue;
      ratios.push_back(pose.q_sd[c] / sd);
      still.push_back(pose.q_sd[c] / rigid[static_cast<std::size_t>(f)].q_sd[c]);
    }
  ASSERT_GT(ratios.size(), 1000U);
  std::ranges::sort(ratios), std::ranges::sort(still);
  EXPECT_GT(ratios[ratios.size() / 2], 0.8) << "as those of the whole recording";
  EXPECT_LT(ratios[ratios.size() / 2], 1.25);
  EXPECT_GT(ratios.front(), 0.5);
  EXPECT_GT(still[still.size() / 2], 5.0) << "and those of markers that do not slide stay small";
}

TEST(OnlineTracker, ABadSampleIsLeftOutAndSaid) {
  const auto model = body();
  const auto markers = record(model, 200, 0.5e-3, 6);
  auto bad = markers;
  bad.x(130, 6) += Eigen::Vector3d(0.2, -0.1, 0.1);
  const TrackOptions options{.marker_noise_sd_m = 0.5e-3};
  auto clean_tracker = OnlineTracker::create(model, markers.names, 100.0, options).value();
  const auto clean = stream(clean_tracker, markers);
  auto tracker = OnlineTracker::create(model, markers.names, 100.0, options).value();
  const auto judged = stream(tracker, bad);
  ASSERT_EQ(judged.size(), 200U);
  for (std::size_t f = 0; f < judged.size(); ++f) {
    EXPECT_EQ(judged[f].left_out, f == 130 ? std::vector<int>{6} : std::vector<int>{}) << f;
    EXPECT_TRUE(clean[f].left_out.empty()) << f;
    EXPECT_LT((judged[f].q - clean[f].q).cwiseAbs().maxCoeff(), 0.02) << f;
  }
  EXPECT_GT(judged[130].q_sd[9], clean[130].q_sd[9]) << "a sample less: a wider deviation";
  TrackOptions believing = options;
  believing.judge_samples = false;
  auto fool = OnlineTracker::create(model, markers.names, 100.0, believing).value();
  const auto believed = stream(fool, bad);
  EXPECT_GT((believed[130].q - clean[130].q).cwiseAbs().maxCoeff(), 0.05);
}

TEST(OnlineTracker, AnswersAfterTheDelayThatItNames) {
  const auto model = body();
  const auto markers = record(model, 80);
  auto tracker = OnlineTracker::create(model, markers.names, 100.0, {.lookahead_s = 0.15}).value();
  EXPECT_EQ(tracker.delay_frames(), 16);
  std::int64_t fetched = 0;
  for (std::int64_t f = 0; f < 80; ++f) {
    ASSERT_TRUE(tracker.push(markers.time.time_s(f), frame_of(markers, f)));
    while (*tracker.next() != nullptr) ++fetched;
    EXPECT_EQ(fetched, f <= 16 ? 0 : f - 16 + 1) << f;
  }
}

TEST(OnlineTracker, RefusesTimesThatDoNotAdvance) {
  const auto model = body();
  const auto markers = record(model, 4);
  auto tracker = OnlineTracker::create(model, markers.names, 100.0).value();
  ASSERT_TRUE(tracker.push(1.0, frame_of(markers, 0)));
  const auto back = tracker.push(0.99, frame_of(markers, 1));
  ASSERT_FALSE(back);
  EXPECT_THAT(back.error().message,
              HasSubstr("time runs backwards: a frame at 0.99 s came after one at 1 s"));
  EXPECT_FALSE(tracker.push(1.0, frame_of(markers, 1)));
  EXPECT_FALSE(tracker.push(std::numeric_limits<double>::quiet_NaN(), frame_of(markers, 1)));
  EXPECT_THAT(tracker.push(9.0, frame_of(markers, 1)).error().message, HasSubstr("begin a new stream"));
  EXPECT_THAT(tracker.push(1.01, Eigen::Matrix3Xd::Zero(3, 2)).error().message,
              HasSubstr("2 markers; need 14"));
  EXPECT_TRUE(tracker.push(1.01, frame_of(markers, 1)));
  tracker.finish();
  EXPECT_THAT(tracker.push(1.02, frame_of(markers, 2)).error().message, HasSubstr("after the end"));
}

TEST(OnlineTracker, FramesThatTheStreamSkippedAreGaps) {
  const auto model = body();
  auto markers = record(model, 100);
  auto gappy = markers;
  for (std::int64_t f = 50; f < 60; ++f)
    for (std::int64_t m = 0; m < 14; ++m) gappy.set_missing(f, m);
  auto whole = OnlineTracker::create(model, markers.names, 100.0).value();
  const auto expected = stream(whole, gappy);
  auto tracker = OnlineTracker::create(model, markers.names, 100.0).value();
  std::vector<LivePose> poses;
  for (std::int64_t f = 0; f < 100; ++f) {
    if (f >= 50 && f < 60) continue;
    ASSERT_TRUE(tracker.push(markers.time.time_s(f), frame_of(markers, f)));
    while (const auto* pose = *tracker.next()) poses.push_back(*pose);
  }
  tracker.finish();
  while (const auto* pose = *tracker.next()) poses.push_back(*pose);
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t f = 0; f < poses.size(); ++f) EXPECT_TRUE(poses[f].q == expected[f].q) << f;
  EXPECT_EQ(poses[55].status, data::FrameStatus::no_markers);
}

/// Push frame 0 of `markers` at every one of the times; the poses that come out.
std::vector<LivePose> poses_at(OnlineTracker& tracker, const data::Trajectories& markers,
                               const std::vector<double>& times) {
  std::vector<LivePose> poses;
  const auto x = frame_of(markers, 0);
  for (const double time : times) {
    EXPECT_TRUE(tracker.push(time, x)) << time;
    while (const auto* pose = *tracker.next()) poses.push_back(*pose);
  }
  tracker.finish();
  while (const auto* pose = *tracker.next()) poses.push_back(*pose);
  return poses;
}

TEST(OnlineTracker, JitterOfTheStampsLosesNoFrameAndInventsNone) {
  const auto model = body();
  const auto markers = record(model, 2);
  std::vector<double> times;
  for (int f = 0; f < 600; ++f)
    times.push_back(0.01 * f + (f % 3 == 1 ? 0.0049 : f % 3 == 2 ? -0.0049 : 0.0));
  auto tracker = OnlineTracker::create(model, markers.names, 100.0, {.error_bars = false}).value();
  const auto poses = poses_at(tracker, markers, times);
  ASSERT_EQ(poses.size(), 600u);
  for (const auto& pose : poses) EXPECT_NE(pose.status, data::FrameStatus::no_markers) << pose.frame;
  EXPECT_EQ(tracker.frames_ahead(), 0);
}

TEST(OnlineTracker, AStreamThatIsSlowerThanItsRateDoesNotDrift) {
  const auto model = body();
  const auto markers = record(model, 2);
  std::vector<double> times;
  for (int f = 0; f < 5000; ++f) times.push_back(f / 239.76);
  auto tracker =
      OnlineTracker::create(model, markers.names, 240.0, {.step_s = 1.0 / 240.0, .error_bars = false})
          .value();
  const auto poses = poses_at(tracker, markers, times);
  ASSERT_EQ(poses.size(), 5005u);  // 4999 / 239.76 s are 5004.0 frames of 240 Hz
  EXPECT_NEAR(poses.back().time_s, times.back(), 1.0 / 240.0);
  EXPECT_EQ(tracker.frames_ahead(), 0);
}

TEST(OnlineTracker, AStreamThatIsFasterThanItsRateIsSaidToBe) {
  const auto model = body();
  const auto x = frame_of(record(model, 2), 0);
  auto tracker = OnlineTracker::create(model, record(model, 2).names, 100.0, {.error_bars = false}).value();
  Status status;
  int f = 0;
  for (; f < 400 && status; ++f) {
    status = tracker.push(f / 125.0, x);
    while (*tracker.next() != nullptr) {
    }
    if (status) {
      EXPECT_NEAR(static_cast<double>(tracker.frames_ahead()), 0.2 * f, 0.6);
    }
  }
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("frames come faster than 100 Hz"));
  EXPECT_NEAR(f, 254, 3);  // 51 frames too many
}

TEST(OnlineTracker, TheLongestPauseOverwritesNothingThatIsStillNeeded) {
  const auto model = body();
  const auto markers = record(model, 140);
  const auto run = [&](bool fetch_late) {
    auto tracker = OnlineTracker::create(model, markers.names, 100.0, {.error_bars = false}).value();
    std::vector<LivePose> poses;
    const auto fetch = [&] {
      while (const auto* pose = *tracker.next()) poses.push_back(*pose);
    };
    for (std::int64_t f = 0; f < 140; ++f) {
      // After 1 s the stream pauses for as long as it may; late: nothing is fetched before that.
      EXPECT_TRUE(tracker.push(markers.time.time_s(f) + (f >= 100 ? 1.98 : 0.0), frame_of(markers, f)));
      if (!fetch_late || f < 80 || f >= 100) fetch();
    }
    tracker.finish();
    fetch();
    return poses;
  };
  const auto soon = run(false), late = run(true);
  ASSERT_EQ(soon.size(), 338u);
  ASSERT_EQ(late.size(), soon.size());
  for (std::size_t f = 0; f < soon.size(); ++f) ASSERT_TRUE(late[f].q == soon[f].q) << f;
}

TEST(OnlineTracker, WaitsForEnoughMarkers) {
  const auto model = body();
  auto markers = record(model, 120);
  for (std::int64_t f = 0; f < 20; ++f)
    for (std::int64_t m = 0; m < 10; ++m) markers.set_missing(f, m);
  auto tracker = OnlineTracker::create(model, markers.names, 100.0).value();
  const auto poses = stream(tracker, markers);
  ASSERT_EQ(poses.size(), 120u);
  EXPECT_EQ(poses[10].status, data::FrameStatus::no_markers);
  EXPECT_EQ(poses[10].q.size(), 13);
  EXPECT_EQ(poses[60].status, data::FrameStatus::converged);
  EXPECT_NEAR(poses[60].q[9], testing_body::coordinates(model, 60)[9], 2e-3);
}

TEST(OnlineTracker, SaysWhatItCannotDo) {
  const auto model = body();
  const std::vector<std::string> names{"T1", "T2"};
  EXPECT_THAT(OnlineTracker::create(model, names, 0.0).error().message, HasSubstr("rate"));
  EXPECT_THAT(OnlineTracker::create(model, {"nose"}, 100.0).error().message,
              HasSubstr("no marker in common"));
  const data::Derivatives none;
  EXPECT_THAT(OnlineTracker::create(model, names, 100.0, {.derivatives = &none}).error().message,
              HasSubstr("derivatives"));
  auto tracker = OnlineTracker::create(model, names, 100.0).value();
  Status status;
  for (int f = 0; f < 300 && status; ++f) status = tracker.push(0.01 * f, Eigen::Matrix3Xd::Zero(3, 2));
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("call next()"));
}

}  // namespace
}  // namespace kinemark::motion
