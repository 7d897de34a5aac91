// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/stages/reconstruction/reconstruct.h"
#include "support/lateral_rig.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
namespace ts = testing_support;

constexpr double kConstant = 22500.0;  // counts of an LED of light 1 on the axis, from 1 m
const Vector4d kStray(4.4, 4.4, 5.7, 3.1);

data::Rig known_rig(std::uint64_t seed) {
  data::Rig rig = ts::real_rig(seed);
  for (auto& camera : rig.cameras) {
    auto& d = camera.detector;
    d.offset_counts.array() += 10.0;
    d.dark_counts = d.offset_counts - kStray;
    d.light_counts = kConstant;
  }
  return rig;
}

/// An LED of that light: its position and direction at a time.
struct Shining {
  double light = 1.0;
  std::function<Vector3d(double)> path, direction;
};

/// Counts from the law itself: gain times current by cosines and distance, dark counts, and stray light that
/// goes with the light.
data::Counts recording(const data::Rig& rig, const Shining& led, std::int64_t frames = 400) {
  auto counts =
      data::Counts::zeros({"led"}, {"A", "B"}, {.rate_hz = 110.0, .t0_s = 0.0, .frames = frames}, false);
  Random random(11, 2);
  for (std::int64_t f = 0; f < frames; ++f) {
    const double t = counts.time.time_s(f);
    const Vector3d x = led.path(t), n = led.direction(t).normalized();
    for (std::int64_t c = 0; c < 2; ++c) {
      const auto& camera = rig.cameras[static_cast<std::size_t>(c)];
      const Vector3d to_camera = camera.centre_in_world() - x;
      const double distance = to_camera.norm(), depth = (camera.cam_from_world * x).z();
      const double strength =
          led.light * kConstant * n.dot(to_camera) / distance * depth / std::pow(distance, 3);
      const Vector4d mean = strength * camera::respond(camera, x).phi + camera.detector.dark_counts +
                            led.light * (camera.detector.offset_counts - camera.detector.dark_counts);
      const double sd = std::sqrt(camera::conversion_variance(rig.electronics, mean.mean()) - 1.0 / 12.0);
      for (int k = 0; k < 4; ++k)
        counts.counts[4 * counts.index(f, 0, c) + static_cast<std::size_t>(k)] =
            static_cast<std::int16_t>(std::min(4095.0, std::round(mean[k] + sd * random.gaussian())));
    }
  }
  return counts;
}

Vector3d circle(double t) { return {0.15 * std::cos(6.0 * t), 0.15 * std::sin(6.0 * t), 0.1}; }
Vector3d ahead(double) { return {0.2, 0.1, 1.0}; }

double mean_error_m(const data::Trajectories& points, const Shining& led) {
  Vector3d sum = Vector3d::Zero();
  double n = 0.0;
  for (std::int64_t f = 0; f < points.frames(); ++f)
    if (points.present(f, 0)) sum += points.x(f, 0) - led.path(points.time.time_s(f)), n += 1.0;
  return (sum / n).norm();
}

TEST(Light, IsFoundToTwoPercentAndTakesTheBiasAway) {
  for (const double s : {0.3, 0.5, 1.0, 2.0}) {
    const auto rig = known_rig(4);
    const Shining led{s, circle, ahead};
    const auto counts = recording(rig, led);
    ReconstructOptions options;
    options.flicker_counts = 0.0;
    const auto with = reconstruct(counts, rig, options).value();
    options.light = false;
    const auto without = reconstruct(counts, rig, options).value();
    ASSERT_EQ(with.lights.size(), 1u);
    EXPECT_EQ(with.lights[0].source, LightSource::direction) << s;
    EXPECT_NEAR(with.lights[0].light, s, 0.02 * s);
    EXPECT_LT(std::abs(with.lights[0].light - s), 4.0 * with.lights[0].light_sd) << s;
    EXPECT_LT(mean_error_m(with.points, led), 0.25e-3 / std::min(1.0, s)) << s;
    if (s == 0.3) EXPECT_GT(mean_error_m(without.points, led), 5.0 * mean_error_m(with.points, led));
    EXPECT_TRUE(without.lights.empty());
  }
}

TEST(Light, OfAnLedThatTurnsIsWhatItShowsAtMost) {
  const auto rig = known_rig(5);
  const Shining led{0.6, circle, [](double t) -> Vector3d {
                      return Eigen::AngleAxisd(0.6 * std::sin(2.0 * t), Vector3d::UnitY()) *
                             Vector3d(0.0, 0.0, 1.0);
                    }};
  const auto r = reconstruct(recording(rig, led), rig).value();
  EXPECT_EQ(r.lights[0].source, LightSource::turning);
  EXPECT_NEAR(r.lights[0].light, 0.6, 0.12 * 0.6);
}

TEST(Light, CountsAloneTellItWhereTheCamerasConstantsAreNotKnown) {
  auto rig = known_rig(6);
  for (auto& camera : rig.cameras) camera.detector.light_counts = kNaN;
  const auto r = reconstruct(recording(rig, {0.4, circle, ahead}), rig).value();
  EXPECT_EQ(r.lights[0].source, LightSource::stray);
  EXPECT_LT(std::abs(r.lights[0].light - 0.4), 4.0 * r.lights[0].light_sd);
  EXPECT_LT(r.lights[0].light_sd, 0.15);
}

TEST(Light, IsTakenForOneWhereNothingIsKnown) {
  auto rig = known_rig(6);
  const auto counts = recording(rig, {0.4, circle, ahead});
  for (auto& camera : rig.cameras) {
    camera.detector.light_counts = kNaN;
    camera.detector.dark_counts.setConstant(kNaN);
  }
  const auto r = reconstruct(counts, rig).value();
  EXPECT_EQ(r.lights[0].source, LightSource::unknown);
  EXPECT_EQ(r.lights[0].light, 1.0);
  ReconstructOptions options;
  options.light = false;
  EXPECT_EQ(r.points.x_in_world, reconstruct(counts, rig, options)->points.x_in_world);
}

TEST(Light, OneFullChannelIsLeftOutAndTheFrameStays) {
  const auto rig = known_rig(7);
  const Shining led{
      3.2,
      [](double t) -> Vector3d { return {0.05 * std::sin(3.0 * t), 0.28 + 0.08 * std::sin(5.0 * t), 0.5}; },
      ahead};
  const auto full = recording(rig, led);
  std::int64_t clipped = 0;
  auto counts = full;
  for (std::size_t i = 0; i < counts.flags.size(); ++i) {
    int at_top = 0;
    for (std::size_t k = 0; k < 4; ++k) at_top += counts.counts[4 * i + k] >= counts.highest_code;
    if (at_top > 0) counts.flags[i] |= data::kCountSaturated;
    clipped += at_top == 1;
  }
  ASSERT_GT(clipped, 40);
  const auto r = reconstruct(counts, rig).value();
  EXPECT_EQ(r.leds[0].located + r.leds[0].saturated, counts.frames());
  EXPECT_LT(r.leds[0].saturated, 10) << "two full channels are too many";
  EXPECT_LT(mean_error_m(r.points, led), 0.1e-3);
}

}  // namespace
}  // namespace kinemark::reconstruction
