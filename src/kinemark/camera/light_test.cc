// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "support/lateral_rig.h"

namespace kinemark::camera {
namespace {

using Eigen::Vector4d;
namespace ts = testing_support;

const Vector4d kDark(16.0, 17.0, 15.0, 16.5), kStray(4.4, 4.4, 5.7, 3.1);

data::Rig measured_rig() {
  data::Rig rig = ts::real_rig(3);
  for (auto& camera : rig.cameras) {
    camera.detector.offset_counts = kDark + kStray;
    camera.detector.dark_counts = kDark;
    camera.detector.dark_sd_counts = 0.1;
  }
  return rig;
}

int offset_of(const data::Rig& rig, int camera) {
  return rig.first_parameter(camera) +
         data::ParameterLayout(rig.cameras[static_cast<std::size_t>(camera)]).offset;
}

TEST(Light, OffsetsAreDarkCountsAndTheShareOfTheLight) {
  const auto rig = measured_rig();
  for (const double s : {0.2, 1.0, 3.0}) {
    const auto lit = with_light(rig, {.value = s});
    for (const auto& camera : lit.cameras)
      EXPECT_LT((camera.detector.offset_counts - (kDark + s * kStray)).norm(), 1e-12) << s;
  }
  EXPECT_EQ(with_light(rig, {}).covariance.size(), 0);
}

// Offsets of light s are s q - (s - 1) o of the calibrated q and the dark o: errors of q count s times.
TEST(Light, CovarianceIsThatOfTheOffsetsInForce) {
  auto rig = measured_rig();
  const int n = rig.parameter_count(), a = offset_of(rig, 0), b = offset_of(rig, 1);
  rig.covariance = 0.04 * Eigen::MatrixXd::Identity(n, n);
  const double s = 0.4, sd = 0.05;
  const auto lit = with_light(rig, {.value = s, .sd = sd});
  EXPECT_NEAR(lit.covariance(a, a), s * s * 0.04 + 0.6 * 0.6 * 0.01 + sd * sd * kStray[0] * kStray[0], 1e-12);
  EXPECT_NEAR(lit.covariance(a, b + 2), sd * sd * kStray[0] * kStray[2],
              1e-12);  // all cameras share the light
  EXPECT_NEAR(lit.covariance(0, 0), 0.04, 1e-15);
}

TEST(Light, StrayLightThatIsNotKnownLiesWithinTheOffset) {
  auto rig = measured_rig();
  auto& detector = rig.cameras[0].detector;
  detector.dark_counts.setConstant(std::nan(""));
  const auto stray = stray_light(detector);
  EXPECT_FALSE(stray.known);
  for (int k = 0; k < 4; ++k) {
    const double sd = std::hypot(stray.sd_counts, stray.share_sd * stray.counts[k]);
    EXPECT_GT(stray.counts[k] + 2.0 * sd, kStray[k]);
    EXPECT_LT(stray.counts[k] - 2.0 * sd, kStray[k]);
  }
  EXPECT_TRUE(stray_light(rig.cameras[1].detector).known);
  // The share is common: errors of two channels go together.
  const int n = offset_of(rig, 0);
  EXPECT_NEAR(with_light(rig, {.value = 0.5}).covariance(n, n + 1),
              0.25 / 3.0 * stray.counts[0] * stray.counts[1], 1e-12);
}

data::Counts dark_recording(std::int64_t frames, double rate_hz, double pedestal) {
  auto counts =
      data::Counts::zeros({"led"}, {"A"}, {.rate_hz = rate_hz, .t0_s = 0.0, .frames = frames}, true);
  Random random(5, 1);
  for (std::size_t k = 0; k < 4; ++k) counts.dark_time_s[k] = 0.004 + 50e-6 * static_cast<double>(k);
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::size_t k = 0; k < 4; ++k) {
      const double t = counts.time.time_s(f) + counts.dark_time_s[k];
      const double mean = pedestal + static_cast<double>(k) + 1.5 * std::sin(240.0 * std::numbers::pi * t);
      counts.dark[4 * static_cast<std::size_t>(f) + k] =
          static_cast<std::int16_t>(std::max(0.0, std::round(mean + random.gaussian())));
    }
  return counts;
}

TEST(DarkSlot, MeansWithoutTheFlickerOfTheRoom) {
  const auto found = dark_slot(dark_recording(400, 110.0, 16.0), 0);
  ASSERT_TRUE(found);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(found->counts[k], 16.0 + k, 4.0 * found->sd_counts);
  EXPECT_NEAR(found->sd_counts, std::sqrt(1.0 + 1.0 / 12.0) / 20.0, 0.01);
  EXPECT_NEAR(found->flicker.norm(), 1.5, 0.2);
}

TEST(DarkSlot, SaysNothingWhereItCannotKnow) {
  EXPECT_FALSE(dark_slot(dark_recording(10, 110.0, 16.0), 0));   // too short
  EXPECT_FALSE(dark_slot(dark_recording(400, 110.0, 0.5), 0));   // clipped at 0
  EXPECT_FALSE(dark_slot(dark_recording(400, 120.0, 16.0), 0));  // flicker looks like an offset
  auto none = dark_recording(400, 110.0, 16.0);
  none.dark.clear();
  none.dark_time_s.clear();
  EXPECT_FALSE(dark_slot(none, 0));
}

TEST(DarkSlot, GoesToTheRig) {
  auto rig = ts::real_rig(3);
  rig.cameras.resize(1);
  find_dark_counts(dark_recording(400, 110.0, 16.0), rig);
  EXPECT_TRUE(rig.cameras[0].detector.knows_dark());
  EXPECT_NEAR(rig.cameras[0].detector.dark_counts[2], 18.0, 0.3);
}

TEST(DarkSlot, IsWhereOffsetsBegin) {
  auto rig = ts::real_rig(3);
  const auto before = rig.cameras[1].detector.offset_counts;
  rig.cameras.resize(1);
  begin_in_the_dark(dark_recording(400, 110.0, 16.0), rig);
  EXPECT_EQ(rig.cameras[0].detector.offset_counts, rig.cameras[0].detector.dark_counts);
  EXPECT_NEAR(rig.cameras[0].detector.offset_counts[2], 18.0, 0.3);
  auto undark = ts::real_rig(3);
  undark.cameras[1].detector.dark_counts.setConstant(std::nan(""));
  auto none = dark_recording(400, 110.0, 16.0);
  none.dark.clear();
  none.dark_time_s.clear();
  begin_in_the_dark(none, undark);
  EXPECT_EQ(undark.cameras[1].detector.offset_counts, before);
}

TEST(DarkSlot, IsFollowedWhereItHasSurelyDrifted) {
  auto rig = measured_rig();
  auto& detector = rig.cameras[0].detector;
  detector.dark_counts << 16.1, 17.0, 14.0, 19.0;  // 0.1, 0, 4 and 0 off
  detector.dark_sd_counts = 0.05;
  rig.covariance = 0.04 * Eigen::MatrixXd::Identity(rig.parameter_count(), rig.parameter_count());
  const auto before = detector.offset_counts;
  const int n = offset_of(rig, 0);
  const double variance = rig.covariance(n, n);
  const auto drifted = follow_dark_counts(dark_recording(400, 110.0, 16.0), rig);
  ASSERT_EQ(drifted.size(), rig.cameras.size());
  EXPECT_NEAR(drifted[0], 4.0, 0.3);
  EXPECT_NEAR(detector.offset_counts[2] - before[2], 4.0, 0.3);
  EXPECT_NEAR(detector.dark_counts[2], 18.0, 0.3);
  EXPECT_GT(rig.covariance(n, n), variance);
  // What is followed is where it is: nothing changes again.
  const auto settled = detector.offset_counts;
  EXPECT_EQ(follow_dark_counts(dark_recording(400, 110.0, 16.0), rig)[0], 0.0);
  EXPECT_EQ(detector.offset_counts, settled);
  // Without a dark slot nobody knows.
  detector.dark_counts.array() += 3.0;
  EXPECT_EQ(follow_dark_counts(dark_recording(10, 110.0, 16.0), rig)[0], 0.0);
}

}  // namespace
}  // namespace kinemark::camera
