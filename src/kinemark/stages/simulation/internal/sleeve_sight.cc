// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/sleeve_sight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/stages/simulation/internal/limb_build.h"
#include "kinemark/stages/simulation/internal/reach_path.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Vector3d;

constexpr double kNear_m = 0.055;  // from the wrist to the mouth, while head and hand hide LEDs

/// True when the line from x along `to_camera` meets a ball.
bool meets_ball(const Vector3d& x, const Vector3d& to_camera, const SleeveBall& ball) {
  const double along = std::clamp((ball.centre - x).dot(to_camera) / to_camera.squaredNorm(), 0.0, 1.0);
  return (x + along * to_camera - ball.centre).norm() < ball.radius_m;
}

/// Upright bars of the cage, in front of the animal.
bool meets_bar(const Vector3d& x, const Vector3d& to_camera) {
  constexpr double kFront_m = 0.34, kSpacing_m = 0.06, kRadius_m = 0.004;
  const double along = (kFront_m - x.x()) / to_camera.x();
  if (!(along > 0.0 && along < 1.0)) return false;
  const double y = x.y() + along * to_camera.y();
  return std::abs(y - kSpacing_m * std::round(y / kSpacing_m)) < kRadius_m;
}

bool blocked(const SleeveRoom& room, const Vector3d& x, const Vector3d& to_camera) {
  return meets_ball(x, to_camera, room.head) || meets_ball(x, to_camera, room.trunk) ||
         meets_bar(x, to_camera);
}

}  // namespace

SleeveSight::SleeveSight(const SleeveOptions& options)
    : cosine_(options.sight_cosine),
      mouth_loss_(options.mouth_loss),
      cameras_(options.sight_cameras),
      obstacles_(options.obstacles),
      hidden_(2 * static_cast<std::size_t>(options.leds_per_segment), 0),
      random_(options.seed, static_cast<std::uint64_t>(LimbStream::sight)),
      tip_random_(options.seed, static_cast<std::uint64_t>(LimbStream::tip)) {}

void SleeveSight::begin_frame(const Vector3d& wrist) {
  const bool near = (wrist - mouth_in_world()).norm() < kNear_m;
  if (near && !at_mouth_) {
    // The distal half of the forearm is hidden by the jaw.
    for (std::size_t led = hidden_.size() / 2 + hidden_.size() / 4; led < hidden_.size(); ++led)
      hidden_[led] = random_.uniform() < mouth_loss_ ? 1 : 0;
    tip_hidden_ = tip_random_.uniform() < mouth_loss_;
  }
  if (!near && at_mouth_) {
    std::ranges::fill(hidden_, 0);
    tip_hidden_ = false;
  }
  at_mouth_ = near;
}

bool SleeveSight::sees(int led, const Vector3d& x, const Vector3d& normal) const {
  const auto of_sleeve = static_cast<std::size_t>(led);
  if (of_sleeve < hidden_.size() ? hidden_[of_sleeve] != 0 : tip_hidden_) return false;
  int seen = 0;
  for (const auto& camera : room_.cameras) {
    const Vector3d to_camera = camera - x;
    if (!(to_camera.dot(normal) > cosine_ * to_camera.norm())) continue;
    if (!obstacles_ || !blocked(room_, x, to_camera)) ++seen;
  }
  return seen >= cameras_;
}

}  // namespace kinemark::simulation::internal

namespace kinemark::simulation {

SleeveRoom sleeve_room() {
  const Eigen::Vector3d mouth = internal::mouth_in_world();
  return {.cameras = {{{0.7, 0.5, 0.5},
                       {0.8, -0.3, 0.4},
                       {0.3, 0.9, 0.2},
                       {0.5, -0.8, 0.3},
                       {-0.1, 0.3, 0.9},
                       {0.9, 0.2, -0.2}}},
          .mouth = mouth,
          .head = {.centre = mouth + Eigen::Vector3d(-0.050, 0.0, 0.015), .radius_m = 0.045},
          .trunk = {.centre = {-0.060, 0.110, -0.140}, .radius_m = 0.090}};
}

}  // namespace kinemark::simulation
