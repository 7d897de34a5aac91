// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the filter of the goals takes away from movements that are known.
#include "kinemark/stages/motion/control/internal/track_bars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::int64_t kFrames = 400, kKick = 200;
constexpr int kElbow = 9, kKnee = 11;
constexpr double kNoise_m = 1e-3;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

/// The moving body, whose elbow kicks by 0.4 rad within a tenth of a second.
Eigen::VectorXd kicking(const model::Model& model, std::int64_t frame) {
  Eigen::VectorXd q = testing_body::coordinates(model, frame);
  const double t = static_cast<double>(frame - kKick) / 3.0;
  q[kElbow] += 0.4 * std::exp(-0.5 * t * t);
  return q;
}

data::Trajectories record_kick(const model::Model& model, double noise_m) {
  auto markers = testing_body::record(model, kFrames);
  model::Workspace w(model);
  Random random(7, 3);
  for (std::int64_t f = 0; f < kFrames; ++f) {
    model::kinematics(model, w, model::state_from_coordinates(model, kicking(model, f)));
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const Eigen::Vector3d x =
          w.marker.col(model.description().find_marker(markers.names[static_cast<std::size_t>(m)]));
      for (Eigen::Index k = 0; k < 3; ++k) markers.x(f, m)[k] = x[k] + noise_m * random.gaussian();
    }
  }
  return markers;
}

TEST(FilterBars, AKickThatTheFilterRoundsIsInItsDeviations) {
  const auto model = body();
  const auto track = track_markers(model, record_kick(model, kNoise_m)).value();
  const auto& motion = track.motion;
  double rounded = 0.0;
  for (std::int64_t f = kKick - 12; f <= kKick + 12; ++f) {
    const auto i = motion.index(f, kElbow);
    const double off = std::abs(motion.q[i] - kicking(model, f)[kElbow]);
    rounded = std::max(rounded, off);
    EXPECT_LE(off, 3.0 * motion.q_sd[i]) << f;
    EXPECT_LE(off, motion.q_bound[i]) << f;
    EXPECT_GE(motion.q_sd[i], track.filter_sd[i]);
  }
  EXPECT_GT(rounded, 0.05) << "else nothing is rounded here";
  EXPECT_GT(track.filter_sd[motion.index(kKick, kElbow)], 0.8 * rounded);
  // The knee is quiet all the time, and what is fast elsewhere does not widen it.
  std::vector<double> share;
  for (std::int64_t f = 30; f + 30 < kFrames; ++f)
    share.push_back(track.filter_sd[motion.index(f, kKnee)] / motion.q_sd[motion.index(f, kKnee)]);
  std::ranges::sort(share);
  EXPECT_LT(share[share.size() / 2], 0.4);
}

TEST(FilterBars, WithoutAFilterNothingIsTaken) {
  const auto model = body();
  const auto track = track_markers(model, record_kick(model, kNoise_m), {.cutoff_hz = 0.0}).value();
  EXPECT_EQ(std::ranges::count(track.filter_sd, 0.0), std::ssize(track.filter_sd));
}

TEST(FilterBars, WhatNoMarkerFixesHasNone) {
  const auto model = body();
  auto markers = record_kick(model, kNoise_m);
  for (std::int64_t f = 100; f < 140; ++f)
    for (std::int64_t m : {6, 7}) markers.set_missing(f, m);  // the forearm's
  const auto track = track_markers(model, markers).value();
  const auto i = track.motion.index(120, kElbow);
  EXPECT_EQ(track.motion.determined[i], 0);
  EXPECT_TRUE(std::isnan(track.filter_sd[i]));
  EXPECT_TRUE(std::isfinite(track.filter_sd[track.motion.index(60, kElbow)]));
}

TEST(FilterBars, NoiseIsFoundBesideAMovementThatIsFarLarger) {
  const auto model = body();
  const auto markers = record_kick(model, kNoise_m);
  const auto with = [&](double cutoff_hz) {
    // What goal_noise() made of it stands in the account of the markers, times what the filter passes.
    TrackOptions options{.cutoff_hz = cutoff_hz};
    const auto track = track_markers(model, markers, options).value();
    const GoalFilter filter(100.0, cutoff_hz, 0.0, 0.1);
    std::vector<double> noise;
    for (const auto& marker : track.fit.markers)
      noise.push_back(marker.noise_sd_m / std::sqrt(filter.noise_in_goal()));
    std::ranges::sort(noise);
    return noise[noise.size() / 2];
  };
  EXPECT_NEAR(with(6.0), kNoise_m, 0.15 * kNoise_m);
  EXPECT_NEAR(with(3.0), kNoise_m, 0.2 * kNoise_m);
}

}  // namespace
}  // namespace kinemark::motion::internal
