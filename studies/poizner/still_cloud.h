// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The tree's LEDs while nothing moves.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::studies {

/// Which LEDs its sides join, in the order of simulation::tree_sides_m().
inline constexpr std::array<std::array<int, 2>, 3> kTreeSides{{{0, 1}, {0, 2}, {1, 2}}};

/// Mean and scatter of each LED's points; NaN of an LED without any.
struct StillCloud {
  std::vector<Eigen::Vector3d> mean, variance;  ///< per LED, m and m^2

  explicit StillCloud(const data::Trajectories& points) {
    for (std::int64_t led = 0; led < points.markers(); ++led) {
      Eigen::Vector3d m = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();
      double n = 0.0;
      for (std::int64_t f = 0; f < points.frames(); ++f)
        if (points.present(f, led)) m += points.x(f, led), n += 1.0;
      m /= n > 0.0 ? n : kNaN;
      for (std::int64_t f = 0; f < points.frames(); ++f)
        if (points.present(f, led)) v += (points.x(f, led) - m).cwiseAbs2();
      mean.push_back(m);
      variance.push_back(v / std::max(n - 1.0, 1.0));
    }
  }
  /// Between the means of two LEDs, m.
  [[nodiscard]] double distance(const std::array<int, 2>& side) const {
    return (mean[at(side[0])] - mean[at(side[1])]).norm();
  }
};

}  // namespace kinemark::studies
