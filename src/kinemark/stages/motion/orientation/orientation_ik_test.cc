// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/orientation_ik.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/stages/motion/testing/sensors.h"

namespace kinemark::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_body::session;

constexpr double kDegree = std::numbers::pi / 180.0;

const OrientationOptions kUpright{.up_in_world = Eigen::Vector3d::UnitZ()};

TEST(OrientationIk, FindsAnglesAndHeadingOfExactSensors) {
  const auto s = session(40.0 * kDegree, 0.0, 1);
  const auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found->fit.heading_rad, 40.0 * kDegree, 0.02 * kDegree);
  EXPECT_EQ(found->fit.heading_source, HeadingSource::motion);
  EXPECT_TRUE(found->motion.validate());
  const auto& motion = found->motion;
  double worst = 0.0;
  for (const char* name :
       {"tilt", "list", "turn", "arm_flex", "arm_add", "arm_rot", "elbow", "hip", "knee"}) {
    const auto c = motion.find(name);
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      worst = std::max(worst, std::abs(motion.q[motion.index(f, c)] - s.truth(c, f)));
      EXPECT_TRUE(motion.determined[motion.index(f, c)]);
    }
  }
  EXPECT_LT(worst, 0.1 * kDegree);
  EXPECT_LT(found->fit.rms_rad, 0.02 * kDegree);
}

TEST(OrientationIk, LengthsStayAtTheirDefaultsAndAreNotDetermined) {
  const auto s = session(0.0, 1.0 * kDegree, 2, 20);
  const auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright).value();
  EXPECT_THAT(found.fit.at_default, ElementsAre("tx", "ty", "tz"));
  for (const char* name : {"tx", "ty", "tz"}) {
    const auto i = found.motion.index(7, found.motion.find(name));
    EXPECT_EQ(found.motion.q[i], 0.0);
    EXPECT_FALSE(found.motion.determined[i]);
    EXPECT_TRUE(std::isnan(found.motion.q_sd[i]));
  }
  EXPECT_EQ(found.motion.status[7], data::FrameStatus::converged);
}

TEST(OrientationIk, ErrorBarsHoldTheTruth) {
  std::int64_t within = 0, within_two = 0, all = 0;
  double noise = 0.0;
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    const auto s = session(0.3 * static_cast<double>(seed), 2.0 * kDegree, seed, 100);
    const auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright).value();
    noise += found.fit.noise_sd_rad / 6.0;
    for (const char* name : {"tilt", "list", "turn", "arm_flex", "arm_add", "arm_rot", "elbow", "hip", "knee",
                             "kneecap_angle"}) {
      const auto c = found.motion.find(name);
      for (std::int64_t f = 0; f < found.motion.frames(); ++f) {
        const auto i = found.motion.index(f, c);
        const double z = std::abs(found.motion.q[i] - s.truth(c, f)) / found.motion.q_sd[i];
        within += z < 1.0;
        within_two += z < 1.96;
        ++all;
      }
    }
  }
  EXPECT_NEAR(noise, 2.0 * kDegree, 0.15 * kDegree);
  const auto share = [all](std::int64_t n) { return static_cast<double>(n) / static_cast<double>(all); };
  EXPECT_GT(share(within), 0.60);
  EXPECT_LT(share(within), 0.75);
  EXPECT_GT(share(within_two), 0.90);
  EXPECT_LT(share(within_two), 0.98);
}

TEST(OrientationIk, TurnedSamplesAreLeftOutAndOtherFramesKeepTheirAngles) {
  const auto good = session(0.7, 1.0 * kDegree, 5);
  auto bad = good;
  const auto spoil = [&bad](std::int64_t f, std::int64_t s) {
    const Eigen::Quaterniond q(bad.recording.rotation(f, s) *
                               Eigen::AngleAxisd(50.0 * kDegree, Eigen::Vector3d(0.6, 0.0, 0.8)));
    double* to = bad.recording.quaternion.data() + 4 * (f * bad.recording.size() + s);
    to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
  };
  for (const std::int64_t f : {42, 43, 44}) spoil(f, 4);
  spoil(120, 1);
  auto options = kUpright;
  const auto by_motion = solve_orientations(good.model, good.recording, &good.pose, options).value();
  // One heading for all: where it is estimated, other frames may say it.
  options.facing =
      FacingAxis{.sensor = "trunk_imu",
                 .axis = by_motion.fit.sensors[0].body_from_sensor.transpose() * Eigen::Vector3d::UnitX()};
  const auto clean = solve_orientations(good.model, good.recording, &good.pose, options).value();
  const auto found = solve_orientations(bad.model, bad.recording, &bad.pose, options).value();
  EXPECT_TRUE(clean.fit.rejected.empty());
  ASSERT_EQ(found.fit.rejected.size(), 2U);
  EXPECT_EQ(found.fit.rejected[1].sensor, "shank_imu");
  EXPECT_EQ(found.fit.rejected[1].samples(), 3);
  EXPECT_NEAR(found.fit.rejected[1].angle_rad, 50.0 * kDegree, 8.0 * kDegree);
  EXPECT_NEAR(found.fit.noise_sd_rad, clean.fit.noise_sd_rad, 0.02 * clean.fit.noise_sd_rad);
  options.judge_samples = false;
  const auto kept = solve_orientations(bad.model, bad.recording, &bad.pose, options).value();
  EXPECT_TRUE(kept.fit.rejected.empty());
  EXPECT_GT(kept.fit.max_rad, 2.0 * found.fit.max_rad);
  for (std::int64_t f = 0; f < clean.motion.frames(); ++f) {
    const bool is_spoiled = (f >= 42 && f <= 44) || f == 120;
    EXPECT_EQ(std::isnan(found.error_rad[static_cast<std::size_t>(f * found.fit.sensors.size() + 4)]),
              f >= 42 && f <= 44);
    for (std::int64_t c = 0; c < clean.motion.size() && !is_spoiled; ++c) {
      const auto i = clean.motion.index(f, c);
      EXPECT_NEAR(found.motion.q[i], clean.motion.q[i], 1e-6) << f << " " << c;
    }
  }
}

TEST(OrientationIk, FramesAreCountedOnceHoweverOftenTheyAreSolved) {
  constexpr std::int64_t kFrames = 1000;  // progress is said after so many
  const auto s = session(0.7, 0.02, 3, kFrames);
  for (const bool error_bars : {true, false}) {
    auto options = kUpright;
    options.error_bars = error_bars;
    std::vector<std::int64_t> done;
    const auto count = [&](std::int64_t frames, std::int64_t total) {
      EXPECT_EQ(total, kFrames);
      done.push_back(frames);
      return true;
    };
    ASSERT_TRUE(solve_orientations(s.model, s.recording, &s.pose, options, count));
    ASSERT_FALSE(done.empty());
    EXPECT_TRUE(std::ranges::is_sorted(done));
    EXPECT_EQ(done.size() > 1, error_bars) << "they are solved again with the noise that was found";
    EXPECT_EQ(done.back(), kFrames);
    EXPECT_EQ(std::ranges::count(done, kFrames), 1);
  }
}

TEST(OrientationIk, AFacingAxisGivesTheHeading) {
  auto s = session(-70.0 * kDegree, 0.0, 3, 30);
  // The trunk's sensor: which of its axes faces along the model's x in the pose?
  const auto by_motion = solve_orientations(s.model, s.recording, &s.pose, kUpright).value();
  const Eigen::Vector3d forward =
      by_motion.fit.sensors[0].body_from_sensor.transpose() * Eigen::Vector3d::UnitX();
  auto options = kUpright;
  options.facing = FacingAxis{.sensor = "trunk_imu", .axis = forward};
  const auto found = solve_orientations(s.model, s.recording, &s.pose, options).value();
  EXPECT_NEAR(found.fit.heading_rad, -70.0 * kDegree, 0.05 * kDegree);
  EXPECT_EQ(found.fit.heading_sd_rad, 0.0);
  EXPECT_EQ(found.fit.heading_source, HeadingSource::facing);
  options.facing->sensor = "head_imu";
  EXPECT_THAT(solve_orientations(s.model, s.recording, &s.pose, options).error().message,
              HasSubstr("no sensor 'head_imu'"));
  options.facing =
      FacingAxis{.sensor = "trunk_imu",
                 .axis = by_motion.fit.sensors[0].body_from_sensor.transpose() * Eigen::Vector3d::UnitY()};
  EXPECT_THAT(solve_orientations(s.model, s.recording, &s.pose, options).error().message,
              HasSubstr("upright"));
}

TEST(OrientationIk, SensorsOfAModelNeedNoPose) {
  const auto s = session(25.0 * kDegree, 1.0 * kDegree, 9, 40);
  const auto by_pose = solve_orientations(s.model, s.recording, &s.pose, kUpright).value();
  auto options = kUpright;
  for (const auto& sensor : by_pose.fit.sensors)
    if (sensor.body != "thigh") options.placed.push_back({sensor.name, sensor.body, sensor.body_from_sensor});
  const auto found = solve_orientations(s.model, s.recording, nullptr, options).value();
  EXPECT_EQ(found.fit.heading_source, HeadingSource::model);
  EXPECT_EQ(found.fit.heading_sd_rad, 0.0);
  EXPECT_THAT(found.fit.left_out, ElementsAre("thigh_imu"));
  const auto elbow = found.motion.find("elbow");
  for (std::int64_t f = 0; f < found.motion.frames(); ++f)
    EXPECT_NEAR(found.motion.q[found.motion.index(f, elbow)],
                by_pose.motion.q[by_pose.motion.index(f, elbow)], 0.02 * kDegree)
        << "joints do not feel the heading, which turns all bodies alike";
  options.placed[0].body = "hand";
  EXPECT_THAT(solve_orientations(s.model, s.recording, nullptr, options).error().message,
              HasSubstr("body 'hand'"));
  options.placed = {{"other_imu", "trunk", Eigen::Matrix3d::Identity()}};
  EXPECT_THAT(solve_orientations(s.model, s.recording, nullptr, options).error().message,
              HasSubstr("none of the sensors that are placed"));
}

TEST(OrientationIk, AHeadingThatTheMotionLeavesOpenIsNotGuessed) {
  // One free body turns alike under any heading.
  const auto s = session(0.5, 1.0 * kDegree, 4, 60, {"trunk"});
  const auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Code::bad_input);
  EXPECT_THAT(found.error().message, HasSubstr("heading of the sensors is not determined by the motion"));
}

TEST(OrientationIk, HingesOfBothDirectionsLeaveHalfATurnOpen) {
  const auto s = session(0.5, 1.0 * kDegree, 4, 60);
  auto options = kUpright;
  options.limits = false;
  const auto found = solve_orientations(s.model, s.recording, &s.pose, options);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("deg explain it alike"));
}

TEST(OrientationIk, WithoutResidualsTheNoiseIsNotKnown) {
  const auto s = session(0.0, 1.0 * kDegree, 5, 10, {"trunk"});
  auto options = kUpright;
  options.facing = FacingAxis{.sensor = "trunk_imu", .axis = Eigen::Vector3d(0.7, 0.4, 0.6)};
  const auto found = solve_orientations(s.model, s.recording, &s.pose, options).value();
  EXPECT_TRUE(std::isnan(found.fit.noise_sd_rad));
  EXPECT_TRUE(std::isnan(found.motion.q_sd[found.motion.index(3, 0)]));
  EXPECT_TRUE(found.motion.determined[found.motion.index(3, 0)]);
  EXPECT_FALSE(found.motion.determined[found.motion.index(3, found.motion.find("elbow"))]);
  options.noise_sd_rad = 1.0 * kDegree;
  const auto given = solve_orientations(s.model, s.recording, &s.pose, options).value();
  EXPECT_NEAR(given.fit.noise_sd_rad, std::sqrt(1.05) * kDegree, 1e-9) << "of the pose as well, of 20 frames";
  EXPECT_GT(given.motion.q_sd[given.motion.index(3, 0)], 0.9 * kDegree);
}

TEST(OrientationIk, AMissingSensorLeavesItsJointsOpen) {
  auto s = session(0.0, 1.0 * kDegree, 6, 40);
  for (std::int64_t f = 10; f < 20; ++f)
    for (std::int64_t k = 0; k < 4; ++k)
      s.recording.quaternion[static_cast<std::size_t>(4 * (f * 5 + 2) + k)] =
          std::numeric_limits<double>::quiet_NaN();
  const auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright).value();
  const auto elbow = found.motion.find("elbow");
  EXPECT_TRUE(found.motion.determined[found.motion.index(9, elbow)]);
  EXPECT_FALSE(found.motion.determined[found.motion.index(15, elbow)]);
  EXPECT_EQ(found.motion.status[15], data::FrameStatus::underdetermined);
  EXPECT_TRUE(std::isnan(found.error_rad[15 * 5 + 2]));
  EXPECT_NEAR(found.fit.sensors[2].seen, 0.75, 1e-12);
}

TEST(OrientationIk, ASensorThatNoSolvedFrameHasIsLeftOut) {
  auto s = session(0.0, 1.0 * kDegree, 12, 40);
  for (std::int64_t f = 0; f < 40; ++f)
    for (std::int64_t k = 0; k < 4; ++k)
      s.recording.quaternion[static_cast<std::size_t>(4 * (f * 5 + 1) + k)] =
          std::numeric_limits<double>::quiet_NaN();
  const auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright).value();
  EXPECT_THAT(found.fit.never_seen, ElementsAre("upper_arm_imu"));
  ASSERT_EQ(found.fit.sensors.size(), 4U);
  EXPECT_EQ(found.error_rad.size(), 160U);
  EXPECT_LT(found.fit.rms_rad, 3.0 * kDegree);
  EXPECT_FALSE(found.motion.determined[found.motion.index(5, found.motion.find("elbow"))]);
  EXPECT_TRUE(found.motion.determined[found.motion.index(5, found.motion.find("knee"))]);
  std::ranges::fill(s.recording.quaternion, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(solve_orientations(s.model, s.recording, &s.pose, kUpright).error().message,
              HasSubstr("no frame of the time range has an orientation"));
}

TEST(OrientationIk, MatchesSensorsAndBodies) {
  auto s = session(0.0, 0.5 * kDegree, 7, 30);
  s.recording.names[1] = "left wrist";
  s.pose.names[1] = "left wrist";
  auto found = solve_orientations(s.model, s.recording, &s.pose, kUpright);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(found->fit.left_out, ElementsAre("left wrist"));
  auto options = kUpright;
  options.sensors = {{"left wrist", "upper_arm"}};
  found = solve_orientations(s.model, s.recording, &s.pose, options);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fit.sensors[1].body, "upper_arm");
  options.sensors = {{"left wrist", "hand"}};
  EXPECT_THAT(solve_orientations(s.model, s.recording, &s.pose, options).error().message,
              HasSubstr("body 'hand'"));
  options.sensors = {{"wrist", "upper_arm"}};
  EXPECT_THAT(solve_orientations(s.model, s.recording, &s.pose, options).error().message,
              HasSubstr("no sensor 'wrist'"));
  for (auto& name : s.recording.names) name = "x" + name;
  EXPECT_THAT(solve_orientations(s.model, s.recording, nullptr, kUpright).error().message,
              HasSubstr("no sensor is named as a body of the model"));
}

TEST(OrientationIk, BadOptionsAreRefused) {
  const auto s = session(0.0, 0.0, 8, 5);
  auto options = kUpright;
  options.noise_sd_rad = -1.0;
  EXPECT_FALSE(solve_orientations(s.model, s.recording, &s.pose, options));
  options = kUpright;
  options.first_time_s = 90.0;
  EXPECT_THAT(solve_orientations(s.model, s.recording, &s.pose, options).error().message,
              HasSubstr("no frame in the time range"));
  options = kUpright;
  options.facing = FacingAxis{.sensor = "trunk_imu", .axis = Eigen::Vector3d::Zero()};
  EXPECT_FALSE(solve_orientations(s.model, s.recording, &s.pose, options));
}

}  // namespace
}  // namespace kinemark::motion
