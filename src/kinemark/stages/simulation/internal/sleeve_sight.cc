// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/sleeve_sight.h"

#include <algorithm>
#include <array>

#include "kinemark/stages/simulation/internal/limb_build.h"
#include "kinemark/stages/simulation/internal/reach_path.h"

namespace kinemark::simulation::internal {
namespace {

constexpr std::array<std::array<double, 3>, 6> kCameras_m{{{0.7, 0.5, 0.5},
                                                           {0.8, -0.3, 0.4},
                                                           {0.3, 0.9, 0.2},
                                                           {0.5, -0.8, 0.3},
                                                           {-0.1, 0.3, 0.9},
                                                           {0.9, 0.2, -0.2}}};
constexpr double kNear_m = 0.055;  // from the wrist to the mouth, while head and hand hide LEDs

}  // namespace

SleeveSight::SleeveSight(const SleeveOptions& options)
    : cosine_(options.sight_cosine),
      mouth_loss_(options.mouth_loss),
      cameras_(options.sight_cameras),
      hidden_(2 * static_cast<std::size_t>(options.leds_per_segment), 0),
      random_(options.seed, static_cast<std::uint64_t>(LimbStream::sight)) {}

void SleeveSight::begin_frame(const Eigen::Vector3d& wrist) {
  const bool near = (wrist - mouth_in_world()).norm() < kNear_m;
  if (near && !at_mouth_) {
    // The far half of the forearm is what dips behind the jaw.
    for (std::size_t led = hidden_.size() / 2 + hidden_.size() / 4; led < hidden_.size(); ++led)
      hidden_[led] = random_.uniform() < mouth_loss_ ? 1 : 0;
  }
  if (!near && at_mouth_) std::ranges::fill(hidden_, 0);
  at_mouth_ = near;
}

bool SleeveSight::sees(int led, const Eigen::Vector3d& x, const Eigen::Vector3d& normal) const {
  if (hidden_[static_cast<std::size_t>(led)] != 0) return false;
  int seen = 0;
  for (const auto& camera : kCameras_m) {
    const Eigen::Vector3d to_camera = Eigen::Map<const Eigen::Vector3d>(camera.data()) - x;
    if (to_camera.dot(normal) > cosine_ * to_camera.norm()) ++seen;
  }
  return seen >= cameras_;
}

}  // namespace kinemark::simulation::internal
