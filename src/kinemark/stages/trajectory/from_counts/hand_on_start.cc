// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/hand_on_start.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/filtering.h"
#include "kinemark/math/statistics.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::trajectory {
namespace {

using Eigen::Vector3d;

/// SD of a normal variable over the median of its magnitude.
constexpr double kOfMedian = 1.4826;
constexpr std::size_t kFewest = 12;  ///< samples to tell a noise by

Vector3d triple(const Array<double>& values, std::size_t sample) {
  if (values.empty()) return Vector3d::Constant(kNaN);
  return Vector3d(values[3 * sample], values[3 * sample + 1], values[3 * sample + 2]);
}

/// What one LED's frames differ from its path by, axis after axis.
class FrameNoise {
 public:
  void add(const Vector3d& difference, const double* covariance) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      differences_[axis].push_back(std::abs(difference[static_cast<Eigen::Index>(axis)]));
      const double v = covariance == nullptr ? 0.0 : covariance[math::kSymmetric3Diagonal[axis]];
      path_variance_ += std::isfinite(v) ? v : 0.0;
    }
  }
  /// Root mean square over the axes; NaN when there are too few samples.
  [[nodiscard]] double sd() {
    const std::size_t n = differences_[0].size();
    if (n < kFewest) return kNaN;
    double variance = path_variance_ / (3.0 * static_cast<double>(n));
    for (auto& axis : differences_) {
      const double sd = kOfMedian * math::upper_median(axis);
      variance += sd * sd / 3.0;
    }
    return std::sqrt(variance);
  }

 private:
  std::array<Array<double>, 3> differences_;
  double path_variance_ = 0.0;
};

}  // namespace

void hand_on_start(const data::Trajectories& start, const data::Derivatives& rates,
                   data::Trajectories& smoothed) {
  smoothed.filters = rates.filters;
  smoothed.unfiltered_in_world.assign(smoothed.x_in_world.size(), kNaN);
  for (std::int64_t led = 0; led < smoothed.markers(); ++led) {
    auto& filter = smoothed.filters[at(led)];
    if (!data::is_filter(filter)) continue;
    FrameNoise noise;
    for (std::int64_t f = 0; f < smoothed.frames(); ++f) {
      const std::size_t i = smoothed.index(f, led);
      if (start.state[i] != data::SampleState::measured || smoothed.state[i] != data::SampleState::measured)
        continue;
      const double dt = start.time_s(f, led) - smoothed.time_s(f, led);
      const Vector3d moved =
          start.x(f, led) - dt * triple(rates.velocity, i) - 0.5 * dt * dt * triple(rates.acceleration, i);
      if (!moved.allFinite()) continue;
      Eigen::Map<Vector3d>(smoothed.unfiltered_in_world.data() + 3 * i) = moved;
      noise.add(moved - smoothed.x(f, led),
                smoothed.covariance.empty() ? nullptr : smoothed.covariance.data() + 6 * i);
    }
    filter.noise_sd_m = noise.sd();
    data::mark_smoothed(smoothed, led, filter.method);
  }
}

}  // namespace kinemark::trajectory
