// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/sensor_samples.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

namespace kinemark::motion::internal {
namespace {

/// Turns about an oblique axis at 2 rad/s, 50 Hz, from 1 s on.
data::Orientations turning(std::int64_t frames) {
  data::Orientations out;
  out.names = {"a_imu"};
  out.time = {.rate_hz = 50.0, .t0_s = 1.0, .frames = frames};
  for (std::int64_t f = 0; f < frames; ++f) {
    Eigen::Quaterniond q(
        Eigen::AngleAxisd(2.0 * out.time.time_s(f), Eigen::Vector3d(0.2, 0.9, -0.4).normalized()));
    if (f % 2 == 1) q.coeffs() *= -1.0;  // the same orientation
    out.quaternion.insert(out.quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  return out;
}

double angle_off(const data::Orientations& found, std::int64_t f) {
  const Eigen::Matrix3d truth =
      Eigen::AngleAxisd(2.0 * found.time.time_s(f), Eigen::Vector3d(0.2, 0.9, -0.4).normalized())
          .toRotationMatrix();
  return Eigen::AngleAxisd(Eigen::Matrix3d(truth.transpose() * found.rotation(f, 0))).angle();
}

TEST(SensorClock, TurnsEvenlyBetweenSamples) {
  const auto found = at_times(turning(50), {.rate_hz = 120.0, .t0_s = 1.003, .frames = 100});
  ASSERT_TRUE(found.validate());
  for (std::int64_t f = 0; f < 100; ++f) EXPECT_LT(angle_off(found, f), 1e-7 + 2.0 * 0.1 / 50.0) << f;
  // Away from samples there is no slack.
  EXPECT_LT(angle_off(found, 1), 1e-7);
}

TEST(SensorClock, BeforeAndAfterTheSensorsThereIsNothing) {
  const auto found = at_times(turning(10), {.rate_hz = 100.0, .t0_s = 0.9, .frames = 40});
  for (std::int64_t f = 0; f < 40; ++f) {
    const double t = found.time.time_s(f);
    EXPECT_EQ(found.present(f, 0), t > 1.0 - 1e-9 && t < 1.18 + 1e-9) << t;
  }
}

TEST(SensorClock, AMissingSampleIsNotBridged) {
  auto sensors = turning(20);
  for (std::size_t k = 0; k < 4; ++k)
    sensors.quaternion[4 * 7 + k] = std::numeric_limits<double>::quiet_NaN();
  const auto found = at_times(sensors, {.rate_hz = 100.0, .t0_s = 1.0, .frames = 30});
  for (std::int64_t f = 0; f < 30; ++f) EXPECT_EQ(found.present(f, 0), f < 13 || f > 15) << f;
}

}  // namespace
}  // namespace kinemark::motion::internal
