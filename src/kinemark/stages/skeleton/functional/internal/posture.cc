// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/posture.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/math/euler.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr std::int64_t kMostFrames = 1500;
constexpr double kSwing = 0.5;  ///< of the first component's SD: what is less is no movement
constexpr std::int64_t kLeastCycles = 3, kMostCycles = 12;

}  // namespace

Posture posture_of(const SegmentPoses& parent, const SegmentPoses& child, const RelativeMotion& motion) {
  Posture out;
  const auto n = static_cast<std::int64_t>(motion.frames.size());
  const std::int64_t drawn = std::min(n, kMostFrames);
  out.component.resize(drawn, 3);
  for (std::int64_t i = 0; i < drawn; ++i) {
    const std::int64_t f = motion.frames[at(i * n / drawn)];
    out.frames.push_back(f);
    const Eigen::Matrix3d rotation =
        parent.world_from_segment[at(f)].transpose() * child.world_from_segment[at(f)];
    out.component.row(i) =
        (motion.axes.transpose() * math::log_so3(motion.mean.transpose() * rotation)).transpose();
  }
  out.component.rowwise() -= out.component.colwise().mean().eval();
  out.sd_rad = (out.component.colwise().squaredNorm() / static_cast<double>(drawn)).cwiseSqrt().transpose();
  return out;
}

std::int64_t count_cycles(const Posture& posture) {
  std::int64_t cycles = 0;
  bool below = false;
  for (Eigen::Index i = 0; i < posture.component.rows(); ++i) {
    const double x = posture.component(i, 0);
    if (x < -kSwing * posture.sd_rad(0)) below = true;
    if (!below || x < kSwing * posture.sd_rad(0)) continue;
    below = false;
    ++cycles;
  }
  return std::clamp(cycles, kLeastCycles, kMostCycles);
}

}  // namespace kinemark::skeleton::internal
