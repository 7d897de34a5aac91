// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/reach_path.h"

#include <algorithm>

#include "kinemark/stages/simulation/internal/limb_build.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Vector3d;

/// Flash & Hogan (1985): the smoothest way from rest to rest.
double minimum_jerk(double t) { return t * t * t * (10.0 - 15.0 * t + 6.0 * t * t); }

}  // namespace

Vector3d mouth_in_world() { return {0.060, 0.090, 0.130}; }

ReachPath::ReachPath(std::uint64_t seed, double rate_hz)
    : random_(seed, static_cast<std::uint64_t>(LimbStream::motion)),
      rate_hz_(rate_hz),
      from_(0.200, -0.060, -0.060),
      to_(from_) {
  plan();
}

void ReachPath::plan() {
  from_ = to_;
  to_mouth_ = !to_mouth_;
  Vector3d scatter;
  for (double& value : scatter) value = random_.gaussian();
  const Vector3d food = Vector3d(0.190, -0.040, -0.070) + scatter.cwiseProduct(Vector3d(0.030, 0.060, 0.040));
  to_ = to_mouth_ ? Vector3d(mouth_in_world() + 0.008 * scatter) : food;
  const double movement_s = random_.uniform(0.6, 1.1);
  const double rest_s = random_.uniform(0.2, to_mouth_ ? 0.6 : 0.8);
  moving_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(movement_s * rate_hz_));
  frames_ = moving_ + static_cast<std::int64_t>(rest_s * rate_hz_);
  at_ = 0;
}

Vector3d ReachPath::next() {
  if (at_ >= frames_) plan();
  const double t = std::min(1.0, static_cast<double>(at_) / static_cast<double>(moving_));
  ++at_;
  return from_ + minimum_jerk(t) * (to_ - from_);
}

}  // namespace kinemark::simulation::internal
