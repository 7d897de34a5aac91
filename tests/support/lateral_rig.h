// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Two lateral-effect cameras and their counts of moving points: for tests of stages, which may not include
// the simulator.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/camera/noise.h"
#include "kinemark/camera/parameters.h"
#include "kinemark/camera/response.h"
#include "kinemark/core/random.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"

namespace kinemark::testing_support {

inline constexpr double kLight = 2500.0;  ///< counts of all channels that an LED makes

/// Cameras "A" and "B", 3 m from the origin, 60 degrees apart, world Y up; sheets ideal.
inline data::Rig ideal_rig() {
  data::Rig rig;
  rig.method = "nominal";
  for (const double side : {-1.0, 1.0}) {
    data::Camera camera;
    camera.name = side < 0.0 ? "A" : "B";
    const Eigen::Vector3d centre(side * 1.5, 0.0, 1.5 * std::numbers::sqrt3);
    const Eigen::Vector3d z = -centre.normalized(), x = z.cross(Eigen::Vector3d::UnitY()).normalized();
    camera.cam_from_world.rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
    camera.cam_from_world.translation = -(camera.cam_from_world.rotation * centre);
    camera.focal = 4.96;
    rig.cameras.push_back(camera);
  }
  return rig;
}

/// The same with poses, lenses, sheets and channels as workshops make them.
inline data::Rig real_rig(std::uint64_t seed) {
  data::Rig rig = ideal_rig();
  Random random(seed, 77);
  for (auto& camera : rig.cameras) {
    camera = camera::with_warp_degree(camera, 3);
    const data::ParameterLayout layout(camera);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(layout.count);
    const auto draw = [&](int first, int count, double sd) {
      for (int i = 0; i < count; ++i) step[first + i] = sd * random.gaussian();
    };
    draw(data::ParameterLayout::rotation, 3, 2e-3);
    draw(data::ParameterLayout::centre, 3, 8e-3);
    draw(data::ParameterLayout::focal, 1, 0.03);
    draw(data::ParameterLayout::principal, 2, 0.015);
    draw(data::ParameterLayout::warp_x, layout.warp_terms, 3e-3);
    draw(layout.warp_y, layout.warp_terms, 3e-3);
    draw(layout.gain, 4, 5e-3);
    draw(layout.offset, 4, 2.0);
    step.segment<4>(layout.offset).array() += 6.0;
    camera = camera::moved(camera, step);
  }
  return rig;
}

/// Mean counts of a point without noise.
inline Eigen::Vector4d mean_counts(const data::Camera& camera, const Eigen::Vector3d& x,
                                   double light = kLight) {
  return light * camera::respond(camera, x).phi + camera.detector.offset_counts;
}

/// Standard deviation of one conversion, rounding included.
inline double count_sd(const data::Rig& rig) {
  return std::sqrt(camera::conversion_variance(rig.electronics, kLight / 4.0));
}

using PathOfLed = std::function<Eigen::Vector3d(int led, double time_s)>;

/// Counts of LEDs on given paths, every conversion at its own time; noise from Random(seed, 1).
inline data::Counts count_paths(const data::Rig& rig, int leds, std::int64_t frames, double rate_hz,
                                const PathOfLed& path, std::uint64_t seed, double flicker_counts = 0.0) {
  std::vector<std::string> names, cameras;
  for (int led = 0; led < leds; ++led) names.push_back("led " + std::to_string(led));
  for (const auto& camera : rig.cameras) cameras.push_back(camera.name);
  auto counts =
      data::Counts::zeros(names, cameras, {.rate_hz = rate_hz, .t0_s = 0.0, .frames = frames}, false);
  Random random(seed, 1);
  const double sd = std::sqrt(camera::conversion_variance(rig.electronics, kLight / 4.0) - 1.0 / 12.0);
  for (int led = 0; led < leds; ++led)
    for (int c = 0; c < rig.camera_count(); ++c)
      for (int k = 0; k < 4; ++k)
        counts.conversion_time_s[static_cast<std::size_t>((led * rig.camera_count() + c) * 4 + k)] =
            rig.timing.conversion_offset_s(led, c, k, rig.camera_count());
  for (std::int64_t f = 0; f < frames; ++f)
    for (int led = 0; led < leds; ++led)
      for (int c = 0; c < rig.camera_count(); ++c)
        for (int k = 0; k < 4; ++k) {
          const double t = counts.time.time_s(f) + counts.offset_s(led, c)[k];
          const double mean = mean_counts(rig.cameras[static_cast<std::size_t>(c)],
                                          path(led, t - rig.electronics.time_constant_s))[k] +
                              flicker_counts * std::sin(240.0 * std::numbers::pi * t + 0.3);
          const double noise = sd * random.gaussian();
          counts.counts[4 * counts.index(f, led, c) + static_cast<std::size_t>(k)] =
              static_cast<std::int16_t>(std::clamp(std::round(mean + noise), 0.0, 4095.0));
        }
  return counts;
}

}  // namespace kinemark::testing_support
