// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis::testing {

inline constexpr double kTurn = 2.0 * std::numbers::pi;

/// Positions of place(t) at n even times from 0, n x 3.
template <class Place>
SeriesMatrix sampled(std::int64_t n, double rate_hz, const Place& place) {
  SeriesMatrix out(n, 3);
  for (std::int64_t i = 0; i < n; ++i) out.row(i) = place(static_cast<double>(i) / rate_hz).transpose();
  return out;
}

/// The same with derivatives; the first and last four samples are left out.
template <class Place>
PathSamples path_of(std::int64_t n, double rate_hz, const Place& place) {
  return differentiate(sampled(n, rate_hz, place), kDerivativeMargin, n - 2 * kDerivativeMargin, rate_hz);
}

/// Minimum jerk from 0 to 1 over u = 0 to 1.
inline double minimum_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
}
/// Its speed.
inline double minimum_jerk_speed(double u) {
  return u > 0.0 && u < 1.0 ? 30.0 * u * u * (1.0 - u) * (1.0 - u) : 0.0;
}

/// Its acceleration.
inline double minimum_jerk_acceleration(double u) {
  return u > 0.0 && u < 1.0 ? 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) : 0.0;
}
/// A straight way, of which only velocities and accelerations are there.
inline PathSamples straight_way(double rate_hz, const Eigen::VectorXd& speed,
                                const Eigen::VectorXd& acceleration) {
  PathSamples out{.rate_hz = rate_hz, .x = {}, .v = PathMatrix::Zero(speed.size(), 3), .a = {}, .j = {}};
  out.x = out.a = out.j = out.v;
  out.v.col(0) = speed;
  out.a.col(0) = acceleration;
  return out;
}
/// A reach of 0.3 m in 0.7 s after 0.5 s of rest; 1.7 s.
inline Eigen::Vector3d reach(double t) {
  return {0.3 * minimum_jerk((t - 0.5) / 0.7), 0.05 * minimum_jerk((t - 0.5) / 0.7), 0.8};
}
/// Once a second around an ellipse of 400 x 200 mm in a tilted plane.
inline Eigen::Vector3d ellipse(double t) {
  const double x = 0.2 * std::cos(kTurn * t), y = 0.1 * std::sin(kTurn * t);
  return {0.6 * x, y, 0.8 * x};
}

/// One marker "P", all measured, with white noise.
inline data::Trajectories recording_of(const SeriesMatrix& x, double rate_hz, double noise_m,
                                       std::uint64_t seed) {
  auto out = data::Trajectories::all_missing({"P"}, {.rate_hz = rate_hz, .frames = x.rows()});
  Random random(seed, 3);
  for (std::int64_t i = 0; i < x.rows(); ++i) {
    for (int axis = 0; axis < 3; ++axis) out.x(i, 0)[axis] = x(i, axis) + noise_m * random.gaussian();
    out.state[out.index(i, 0)] = data::SampleState::measured;
  }
  return out;
}

}  // namespace kinemark::analysis::testing
