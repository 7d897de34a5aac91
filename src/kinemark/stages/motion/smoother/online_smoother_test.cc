// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/online_smoother.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/missing.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kFrames = 120;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

Eigen::Matrix3Xd frame_of(const data::Trajectories& markers, std::int64_t f) {
  Eigen::Matrix3Xd x(3, markers.markers());
  for (std::int64_t m = 0; m < markers.markers(); ++m) x.col(m) = markers.x(f, m);
  return x;
}

std::vector<SmoothedFrame> stream(OnlineMotionSmoother& live, const data::Trajectories& markers) {
  std::vector<SmoothedFrame> out;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (auto ready = live.push(frame_of(markers, f)).value()) out.push_back(std::move(*ready));
  for (auto& last : live.finish()) out.push_back(std::move(last));
  return out;
}

TEST(OnlineMotionSmoother, ALagAsLongAsTheRecordingIsTheSmoother) {
  const auto model = body();
  const auto markers = testing_body::record(model, kFrames, 0.002, 1);
  const auto offline = smooth_motion(model, markers).value();
  auto live =
      OnlineMotionSmoother::create(model, offline.motion.markers, offline.tuning, {.lag_frames = kFrames})
          .value();
  const auto frames = stream(live, markers);
  ASSERT_EQ(static_cast<std::int64_t>(frames.size()), kFrames);
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const auto& out = frames[static_cast<std::size_t>(f)];
    EXPECT_EQ(out.frame, f);
    for (int c = 0; c < model.coordinate_count(); ++c) {
      const auto i = offline.motion.index(f, c);
      EXPECT_NEAR(out.q[c], offline.motion.q[i], 0.15 * offline.motion.q_sd[i]) << f << " " << c;
      EXPECT_NEAR(out.q_sd[c], offline.motion.q_sd[i], 0.05 * offline.motion.q_sd[i]);
      EXPECT_NEAR(out.qd[c], offline.motion.qd[i], 0.01);
    }
  }
}

TEST(OnlineMotionSmoother, ALongerLagIsBetterAndBarsSaySo) {
  const auto model = body();
  const auto markers = testing_body::record(model, kFrames, 0.002, 2);
  const auto tuning = smooth_motion(model, markers).value();
  double last_error = 1e9, last_sd = 1e9;
  for (const int lag : {3, 12}) {
    auto live = OnlineMotionSmoother::create(model, tuning.motion.markers, tuning.tuning, {.lag_frames = lag})
                    .value();
    double squares = 0.0, variances = 0.0;
    std::int64_t count = 0;
    for (std::int64_t f = 0; f < kFrames; ++f) {
      const auto out = live.push(frame_of(markers, f)).value();
      EXPECT_EQ(out.has_value(), f >= lag);
      if (f < 40) continue;
      EXPECT_EQ(out->frame, f - lag);
      const auto truth = testing_body::coordinates(model, f - lag);
      for (int c = 0; c < 13; ++c, ++count) {
        squares += std::pow(out->q[c] - truth[c], 2);
        variances += out->q_sd[c] * out->q_sd[c];
      }
    }
    EXPECT_LT(squares, last_error);
    EXPECT_LT(variances, last_sd);
    EXPECT_LT(squares, 2.0 * variances);
    last_error = squares, last_sd = variances;
  }
}

TEST(OnlineMotionSmoother, BridgesWhatTheStreamLacks) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, 0.002, 3);
  const auto tuning = smooth_motion(model, markers).value();
  for (std::int64_t f = 60; f < 70; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.x(f, m).setConstant(kNaN);
  auto live =
      OnlineMotionSmoother::create(model, tuning.motion.markers, tuning.tuning, {.lag_frames = 15}).value();
  const auto frames = stream(live, markers);
  ASSERT_EQ(static_cast<std::int64_t>(frames.size()), kFrames);
  for (const std::int64_t f : {55, 65, 75}) {
    const auto truth = testing_body::coordinates(model, f);
    for (int c = 0; c < 12; ++c)
      EXPECT_LT(std::abs(frames[static_cast<std::size_t>(f)].q[c] - truth[c]),
                5.0 * frames[static_cast<std::size_t>(f)].q_sd[c]);
  }
  EXPECT_GT(frames[65].q_sd[9], 1.2 * frames[50].q_sd[9]);
}

TEST(OnlineMotionSmoother, WaitsForMarkers) {
  const auto model = body();
  const auto markers = testing_body::record(model, 30, 0.002, 4);
  const auto tuning = smooth_motion(model, markers).value();
  auto live =
      OnlineMotionSmoother::create(model, tuning.motion.markers, tuning.tuning, {.lag_frames = 3}).value();
  EXPECT_FALSE(live.push(Eigen::Matrix3Xd::Constant(3, 14, kNaN)).value());
  EXPECT_TRUE(live.finish().empty());
  EXPECT_EQ(stream(live, markers).front().frame, 0);
}

TEST(OnlineMotionSmoother, ASpikeBeyondAllNumbersIsNotSeen) {
  const auto model = body();
  auto markers = testing_body::record(model, kFrames, 0.002, 6);
  const auto tuning = smooth_motion(model, markers).value();
  for (const std::int64_t hit : {0, 50}) {
    auto spoilt = markers, lacking = markers;
    spoilt.x(hit, 2).setConstant(1e200);
    lacking.x(hit, 2).setConstant(kNaN);
    auto live = OnlineMotionSmoother::create(model, tuning.motion.markers, tuning.tuning).value();
    auto without = OnlineMotionSmoother::create(model, tuning.motion.markers, tuning.tuning).value();
    const auto frames = stream(live, spoilt), wanted = stream(without, lacking);
    ASSERT_EQ(frames.size(), wanted.size());
    for (std::size_t f = 0; f < frames.size(); ++f) EXPECT_EQ(frames[f].q, wanted[f].q) << hit << " " << f;
  }
}

TEST(OnlineMotionSmoother, StartsAnewAfterAFrameThatIsNotFinite) {
  const auto model = body();
  const auto markers = testing_body::record(model, kFrames, 0.002, 7);
  auto tuning = smooth_motion(model, markers).value();
  const int lag = 5;
  tuning.tuning.markers[3].information = 1e305;  // overflows wherever it is seen
  auto live =
      OnlineMotionSmoother::create(model, tuning.motion.markers, tuning.tuning, {.lag_frames = lag}).value();
  const std::int64_t hit = 40, dark = 2;  // after the hit the markers stay away for two frames
  std::vector<std::int64_t> numbers;
  for (std::int64_t f = 0; f < kFrames; ++f) {
    Eigen::Matrix3Xd x = frame_of(markers, f);
    if (f != hit) x.col(3).setConstant(kNaN);
    if (f > hit && f <= hit + dark) x.setConstant(kNaN);
    const auto out = live.push(x).value();
    EXPECT_EQ(out.has_value(), f >= lag && (f < hit || f > hit + dark + lag)) << f;
    if (!out) continue;
    EXPECT_EQ(out->frame, f - lag);
    EXPECT_TRUE(out->q.allFinite() && out->qd.allFinite() && out->qdd.allFinite()) << f;
    if (f < hit + dark + lag + 20) continue;
    const auto truth = testing_body::coordinates(model, out->frame);
    for (int c = 0; c < 12; ++c) EXPECT_LT(std::abs(out->q[c] - truth[c]), 5.0 * out->q_sd[c]) << f;
  }
  EXPECT_EQ(live.finish().back().frame, kFrames - 1);
  EXPECT_FALSE(live.push(frame_of(markers, 0)).value());  // the very first frame may be the one
  EXPECT_TRUE(live.finish().empty());
}

TEST(OnlineMotionSmoother, BadInputIsReportedInASentence) {
  const auto model = body();
  const auto offline = smooth_motion(model, testing_body::record(model, 30, 0.002, 5)).value();
  const auto& names = offline.motion.markers;
  EXPECT_THAT(OnlineMotionSmoother::create(model, names, offline.tuning, {.lag_frames = 2}).error().message,
              HasSubstr("lag is 2 frames"));
  EXPECT_THAT(OnlineMotionSmoother::create(model, {"T1"}, offline.tuning).error().message,
              HasSubstr("need 1 and"));
  auto wrong = names;
  wrong[2] = "nose";
  EXPECT_THAT(OnlineMotionSmoother::create(model, wrong, offline.tuning).error().message,
              HasSubstr("'nose'"));
  auto tuning = offline.tuning;
  tuning.rate_hz = 0.0;
  EXPECT_THAT(OnlineMotionSmoother::create(model, names, tuning).error().message, HasSubstr("0 Hz"));
  for (const double rate : {kNaN, std::numeric_limits<double>::infinity()}) {
    tuning.rate_hz = rate;
    EXPECT_THAT(OnlineMotionSmoother::create(model, names, tuning).error().message, HasSubstr("finite rate"));
  }
  for (const double bad : {0.0, -1.0, kNaN, std::numeric_limits<double>::infinity()}) {
    tuning = offline.tuning;
    tuning.markers[1].information = bad;
    EXPECT_THAT(OnlineMotionSmoother::create(model, names, tuning).error().message,
                HasSubstr(fmt::format("marker '{}' has an information of", names[1])));
    tuning = offline.tuning;
    tuning.markers[1].huber_m = bad;
    EXPECT_THAT(OnlineMotionSmoother::create(model, names, tuning).error().message,
                HasSubstr("a Huber threshold of"));
  }
  tuning = offline.tuning;
  tuning.step_variance[0] = 0.0;
  EXPECT_THAT(OnlineMotionSmoother::create(model, names, tuning).error().message, HasSubstr("step variance"));
  auto live = OnlineMotionSmoother::create(model, names, offline.tuning).value();
  EXPECT_THAT(live.push(Eigen::Matrix3Xd::Zero(3, 2)).error().message, HasSubstr("2 markers; need 14"));
}

}  // namespace
}  // namespace kinemark::motion
