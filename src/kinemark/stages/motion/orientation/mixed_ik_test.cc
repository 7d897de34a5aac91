// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/stages/motion/orientation/orientation_ik.h"
#include "kinemark/stages/motion/testing/sensors.h"

namespace kinemark::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kRadPerDegree = std::numbers::pi / 180.0;
const OrientationOptions kZUp{.up_in_world = Eigen::Vector3d::UnitZ()};

/// Markers at 100 Hz and sensors at 50 Hz of the same motion; the shank and what follows it have no markers.
struct Both {
  testing_body::Session sensors;
  data::Trajectories markers;

  Both(double heading, double noise_m, double noise_rad, std::uint64_t seed, std::int64_t frames = 150)
      : sensors(testing_body::session(heading, noise_rad, seed, frames / 2 + 1, testing_body::kSensorBodies,
                                      50.0)),
        markers(testing_body::record(sensors.model, frames, noise_m, seed)) {
    hide(10, 14, 0, frames);
  }

  void hide(std::int64_t first_marker, std::int64_t last_marker, std::int64_t first, std::int64_t last) {
    for (std::int64_t f = first; f < last; ++f)
      for (std::int64_t m = first_marker; m < last_marker; ++m) markers.set_missing(f, m);
  }

  [[nodiscard]] Result<MixedResult> solve(const OrientationOptions& options = kZUp, const IkOptions& ik = {},
                                          bool pose = true) const {
    return solve_mixed(sensors.model, markers, sensors.recording, pose ? &sensors.pose : nullptr, ik,
                       options);
  }

  [[nodiscard]] double truth(const data::JointMotion& motion, std::int64_t f, std::int64_t c) const {
    return testing_body::coordinates(sensors.model, motion.time.number(f))[c];
  }
};

TEST(MixedIk, SensorsDetermineWhatMarkersDoNot) {
  const Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 3);
  const auto alone = solve_ik(both.sensors.model, both.markers).value();
  const auto found = both.solve();
  ASSERT_TRUE(found) << found.error().message;
  const auto& motion = found->ik.motion;
  ASSERT_TRUE(motion.validate());
  EXPECT_EQ(motion.frames(), 150);
  const auto knee = motion.find("knee");
  double squares = 0.0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    EXPECT_FALSE(alone.motion.determined[alone.motion.index(f, knee)]);
    EXPECT_TRUE(motion.determined[motion.index(f, knee)]);
    EXPECT_EQ(motion.status[static_cast<std::size_t>(f)], data::FrameStatus::converged);
    squares += std::pow(motion.q[motion.index(f, knee)] - both.truth(motion, f, knee), 2.0);
  }
  EXPECT_LT(std::sqrt(squares / 150.0), 1.5 * kRadPerDegree);
  EXPECT_EQ(found->fit.heading_source, HeadingSource::markers);
  EXPECT_NEAR(found->fit.heading_rad, 40.0 * kRadPerDegree, 3.0 * found->fit.heading_sd_rad);
  EXPECT_LT(found->fit.heading_sd_rad, 2.0 * kRadPerDegree);
  EXPECT_NEAR(found->fit.noise_sd_rad, 0.9 * kRadPerDegree, 0.2 * kRadPerDegree)
      << "half of the frames lie between samples";
  ASSERT_EQ(found->fit.sensors.size(), 5U);
  EXPECT_EQ(found->fit.sensors[0].placed_by, SensorPlacement::markers);
  EXPECT_EQ(found->fit.sensors[4].placed_by, SensorPlacement::pose);
  EXPECT_EQ(found->error_rad.size(), 150U * 5U);
  EXPECT_LT(found->ik.fit.rms_error_m, 2e-3);
  EXPECT_EQ(found->ik.fit.markers.size(), 10U);
  EXPECT_EQ(motion.markers.size(), 10U);
}

TEST(MixedIk, FramesWithoutMarkersKeepTheirAnglesAndLoseTheirPlace) {
  Both both(-100.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 4);
  both.hide(0, 14, 60, 100);
  const auto found = both.solve().value();
  const auto& motion = found.ik.motion;
  for (const char* name : {"tilt", "list", "arm_flex", "elbow", "hip", "knee"}) {
    const auto c = motion.find(name);
    for (std::int64_t f = 60; f < 100; ++f) {
      ASSERT_TRUE(motion.determined[motion.index(f, c)]) << name << f;
      EXPECT_NEAR(motion.q[motion.index(f, c)], both.truth(motion, f, c),
                  6.0 * motion.q_sd[motion.index(f, c)]);
    }
  }
  const auto tx = motion.find("tx");
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    EXPECT_EQ(motion.determined[motion.index(f, tx)] != 0, f < 60 || f >= 100) << f;
  EXPECT_EQ(motion.status[80], data::FrameStatus::underdetermined);
  // About where the markers were last seen, not at the origin of the sensors' world.
  EXPECT_NEAR(motion.q[motion.index(70, tx)], motion.q[motion.index(59, tx)], 0.2);
}

TEST(MixedIk, FramesBeyondTheSensorsHaveMarkersAlone) {
  Both both(20.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 5);
  auto& recording = both.sensors.recording;
  recording.time.frames = 41;  // to 0.8 s
  recording.quaternion.resize(4U * 41U * 5U);
  const auto found = both.solve().value();
  const auto& motion = found.ik.motion;
  const auto knee = motion.find("knee"), hip = motion.find("hip");
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    EXPECT_EQ(motion.determined[motion.index(f, knee)] != 0, f <= 80) << f;
    EXPECT_TRUE(motion.determined[motion.index(f, hip)]);
    EXPECT_EQ(std::isnan(found.error_rad[static_cast<std::size_t>(5 * f)]), f > 80);
  }
}

TEST(MixedIk, ErrorBarsHoldTheTruth) {
  std::int64_t within = 0, within_two = 0, all = 0;
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    Both both(0.7 * static_cast<double>(seed), 2e-3, 2.0 * kRadPerDegree, seed, 100);
    both.hide(0, 14, 70, 85);
    const auto found = both.solve().value();
    const auto& motion = found.ik.motion;
    for (std::int64_t f = 0; f < motion.frames(); f += 2)  // on samples of the sensors
      for (std::int64_t c = 0; c < motion.size(); ++c) {
        const auto i = motion.index(f, c);
        if (!(motion.q_sd[i] > 0.0)) continue;
        const double z = std::abs(motion.q[i] - both.truth(motion, f, c)) / motion.q_sd[i];
        within += z < 1.0;
        within_two += z < 1.96;
        ++all;
      }
  }
  const auto share = [all](std::int64_t n) { return static_cast<double>(n) / static_cast<double>(all); };
  EXPECT_GT(all, 3000);
  EXPECT_GT(share(within), 0.60);
  EXPECT_LT(share(within), 0.75);
  EXPECT_GT(share(within_two), 0.90);
  EXPECT_LT(share(within_two), 0.98);
}

TEST(MixedIk, WithoutAPoseMarkersPlaceTheSensorsOrNobody) {
  const Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 6);
  const auto found = both.solve(kZUp, {}, false);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->fit.unplaced, ElementsAre("shank_imu"));
  EXPECT_EQ(found->fit.sensors.size(), 4U);
  EXPECT_FALSE(found->ik.motion.determined[found->ik.motion.index(9, found->ik.motion.find("knee"))]);
  // With the shank's markers in some frames its sensor says where the knee is in the others.
  Both seen(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 6);
  const auto whole = testing_body::record(seen.sensors.model, 150, 1e-3, 6);
  for (std::int64_t f = 0; f < 40; ++f)
    for (std::int64_t m = 10; m < 14; ++m) {
      seen.markers.x(f, m) = whole.x(f, m);
      seen.markers.state[seen.markers.index(f, m)] = data::SampleState::measured;
    }
  const auto later = seen.solve(kZUp, {}, false).value();
  EXPECT_TRUE(later.fit.unplaced.empty());
  EXPECT_EQ(later.fit.sensors[4].placed_by, SensorPlacement::markers);
  EXPECT_TRUE(later.ik.motion.determined[later.ik.motion.index(140, later.ik.motion.find("knee"))]);
}

TEST(MixedIk, FramesOfAModelLeaveTheHeadingToTheMarkers) {
  const Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 7);
  auto options = kZUp;
  const auto by_pose = both.solve().value();
  for (const auto& sensor : by_pose.fit.sensors)
    options.placed.push_back({sensor.name, sensor.body, sensor.body_from_sensor});
  const auto found = both.solve(options, {}, false).value();
  EXPECT_EQ(found.fit.heading_source, HeadingSource::markers);
  EXPECT_NEAR(found.fit.heading_rad, 40.0 * kRadPerDegree, 4.0 * found.fit.heading_sd_rad);
  EXPECT_EQ(found.fit.sensors[4].placed_by, SensorPlacement::model);
}

TEST(MixedIk, NoiseThatIsGivenWeighs) {
  const Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 8, 60);
  auto options = kZUp;
  options.noise_sd_rad = 1.0 * kRadPerDegree;
  const auto one = both.solve(options, {.marker_noise_sd_m = 1e-3}).value();
  options.noise_sd_rad = 4.0 * kRadPerDegree;
  const auto four = both.solve(options, {.marker_noise_sd_m = 1e-3}).value();
  EXPECT_NEAR(one.fit.noise_sd_rad, 1.0 * kRadPerDegree, 1e-12);
  const auto knee = one.ik.motion.index(20, one.ik.motion.find("knee"));
  EXPECT_GT(four.ik.motion.q_sd[knee], 2.5 * one.ik.motion.q_sd[knee]);
  EXPECT_LE(four.ik.fit.rms_error_m, one.ik.fit.rms_error_m);
}

TEST(MixedIk, WithoutErrorBarsThereAreNone) {
  const Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 9, 40);
  const auto with = both.solve().value();
  const auto without = both.solve(kZUp, {.error_bars = false}).value();
  EXPECT_TRUE(without.ik.motion.q_sd.empty());
  EXPECT_TRUE(without.ik.motion.determined.empty());
  EXPECT_EQ(with.ik.motion.q, without.ik.motion.q);
  EXPECT_TRUE(without.ik.motion.validate());
}

TEST(MixedIk, ASampleThatMarkersRejectStaysOut) {
  Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 10);
  both.markers.x(60, 3) += Eigen::Vector3d(0.3, 0.0, 0.0);
  const auto found = both.solve().value();
  const auto& motion = found.ik.motion;
  EXPECT_EQ(motion.marker_state[60 * 10 + 3], data::SampleState::rejected);
  EXPECT_TRUE(std::isnan(motion.marker_error[3 * (60 * 10 + 3)]));
  EXPECT_EQ(found.ik.fit.markers[3].rejected_frames, 1);
  EXPECT_LT(found.ik.fit.max_error_m, 0.02);
}

TEST(MixedIk, AFacingAxisGivesTheHeading) {
  const Both both(25.0 * kRadPerDegree, 1e-3, 0.2 * kRadPerDegree, 11, 60);
  const auto by_markers = both.solve().value();
  auto options = kZUp;
  options.facing =
      FacingAxis{.sensor = "trunk_imu",
                 .axis = by_markers.fit.sensors[0].body_from_sensor.transpose() * Eigen::Vector3d::UnitX()};
  const auto found = both.solve(options).value();
  EXPECT_EQ(found.fit.heading_source, HeadingSource::facing);
  EXPECT_NEAR(found.fit.heading_rad, 25.0 * kRadPerDegree, 1.5 * kRadPerDegree);
  EXPECT_THAT(both.solve(options, {}, false).error().message, HasSubstr("there is none"));
}

TEST(MixedIk, WhatCannotBeTogetherIsRefused) {
  Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 12, 60);
  auto late = both;
  late.sensors.recording.time.t0_s = 90.0;
  EXPECT_THAT(late.solve().error().message, HasSubstr("have no time in common"));
  auto still = both;  // one frame of markers says nothing of the heading
  still.hide(0, 14, 1, 60);
  const auto open = still.solve(kZUp, {}, false);
  ASSERT_FALSE(open);
  EXPECT_THAT(open.error().message, HasSubstr("heading of the sensors is not determined"));
  auto options = kZUp;
  options.noise_sd_rad = -1.0;
  EXPECT_FALSE(both.solve(options));
  EXPECT_FALSE(both.solve(kZUp, {.first_time_s = 50.0}));
}

TEST(MixedIk, ThreadsDoNotChangeABit) {
  const Both both(40.0 * kRadPerDegree, 1e-3, 1.0 * kRadPerDegree, 13, 60);
  const auto one = both.solve(kZUp, {.threads = 1}).value(), two = both.solve(kZUp, {.threads = 2}).value();
  EXPECT_EQ(one.ik.motion.q, two.ik.motion.q);
  for (std::size_t i = 0; i < one.ik.motion.q_sd.size(); ++i)
    EXPECT_TRUE(one.ik.motion.q_sd[i] == two.ik.motion.q_sd[i] || std::isnan(one.ik.motion.q_sd[i]));
}

}  // namespace
}  // namespace kinemark::motion
