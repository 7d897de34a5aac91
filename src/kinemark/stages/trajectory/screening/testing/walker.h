// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A small body for the tests of this folder: markers that swing on a walking trunk, with white noise.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory::testing {

struct WalkerOptions {
  int markers = 8;
  std::int64_t frames = 600;
  double rate_hz = 100.0;
  double noise_m = 0.0002;
  std::uint64_t seed = 1;
};

/// Noise-free position of one marker, m. Markers are 0.15 m apart and more.
inline Eigen::Vector3d position(int marker, double time_s) {
  const double w = 2.0 * std::numbers::pi * 0.9;
  const double own = 0.7 * marker;
  return {0.4 * time_s + 0.15 * std::sin(w * time_s + own),
          0.2 * marker + 0.02 * std::sin(2.0 * w * time_s + own),
          1.0 + 0.05 * std::cos(2.0 * w * time_s + own)};
}

inline data::Trajectories walker(const WalkerOptions& o = {}) {
  std::vector<std::string> names;
  for (int m = 0; m < o.markers; ++m) names.push_back("M" + std::to_string(m));
  auto t = data::Trajectories::all_missing(names, {.rate_hz = o.rate_hz, .t0_s = 0.0, .frames = o.frames});
  Random random(o.seed, 0);
  for (std::int64_t f = 0; f < o.frames; ++f)
    for (int m = 0; m < o.markers; ++m) {
      Eigen::Vector3d x = position(m, t.time.time_s(f));
      for (int a = 0; a < 3; ++a) x(a) += o.noise_m * random.gaussian();
      t.x(f, m) = x.cast<float>().cast<double>();
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  return t;
}

/// Every sample between frames n with n % factor == phase replaced by the straight line between its real
/// neighbours.
inline void interpolate_linearly(data::Trajectories& t, int factor, int phase, std::int64_t marker) {
  std::int64_t left = -1;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (f % factor != phase) continue;
    for (std::int64_t k = left + 1; left >= 0 && k < f; ++k) {
      const double u = static_cast<double>(k - left) / static_cast<double>(f - left);
      const Eigen::Vector3d x = (1.0 - u) * t.x(left, marker) + u * t.x(f, marker);
      t.x(k, marker) = x.cast<float>().cast<double>();
    }
    left = f;
  }
}

}  // namespace kinemark::trajectory::testing
