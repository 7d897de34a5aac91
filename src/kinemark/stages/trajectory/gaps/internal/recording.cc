// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/recording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/math/statistics.h"

namespace kinemark::trajectory::internal {

Recording::Recording(const data::Trajectories& in, std::span<const std::int64_t> left)
    : rate_hz_(in.time.rate_hz), frames_(in.frames()) {
  const auto markers = static_cast<std::size_t>(in.markers());
  const auto length = static_cast<std::size_t>(frames_) + 1;
  x_.assign(markers, Eigen::Matrix3Xd::Zero(3, frames_));
  unusable_before_.assign(markers, std::vector<std::int32_t>(length, 0));
  doubtful_before_.assign(markers, std::vector<std::int32_t>(length, 0));
  for (std::size_t m = 0; m < markers; ++m) {
    const bool is_left = std::ranges::find(left, static_cast<std::int64_t>(m)) != left.end();
    for (Index f = 0; f < frames_; ++f) {
      const auto state = in.state[in.index(f, static_cast<Index>(m))];
      const bool usable =
          !is_left && (state == data::SampleState::measured || state == data::SampleState::upsampled);
      const auto k = static_cast<std::size_t>(f);
      unusable_before_[m][k + 1] = unusable_before_[m][k] + (usable ? 0 : 1);
      if (usable) x_[m].col(f) = in.x(f, static_cast<Index>(m));
    }
  }
}

void Recording::exchange(Index first_marker, Index second_marker, Index frame) {
  Eigen::Matrix3Xd& a = x_[static_cast<std::size_t>(first_marker)];
  Eigen::Matrix3Xd& b = x_[static_cast<std::size_t>(second_marker)];
  for (Index axis = 0; axis < 3; ++axis) std::swap(a(axis, frame), b(axis, frame));
}

void Recording::set_doubtful(const std::vector<std::vector<std::uint8_t>>& flags) {
  for (std::size_t m = 0; m < flags.size(); ++m)
    for (std::size_t f = 0; f < flags[m].size(); ++f)
      doubtful_before_[m][f + 1] = doubtful_before_[m][f] + (flags[m][f] != 0 ? 1 : 0);
}

double Recording::estimate_noise(Index marker) const {
  std::vector<double> size;
  for (Index f = 0; f + 5 <= frames_; ++f) {
    if (!complete(marker, f, f + 5)) continue;
    const Eigen::Vector3d d = x(marker, f) - 4.0 * x(marker, f + 1) + 6.0 * x(marker, f + 2) -
                              4.0 * x(marker, f + 3) + x(marker, f + 4);
    size.push_back(d.norm());
  }
  if (size.size() < 8) return 0.0;
  return math::nth_smallest(size, size.size() / 4) /
         (1.1011 * std::sqrt(70.0));  // lower quartile of chi(3); 1 + 16 + 36 + 16 + 1
}

}  // namespace kinemark::trajectory::internal
