// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/math/difference_smoother.h"

namespace kinemark::analysis {

/// n x 3: one row per sample, one column per axis, one sample behind the other.
using math::SeriesMatrix;

/// n x 3 as well, but one axis behind the other.
using PathMatrix = Eigen::MatrixXd;

/// The path of one point over a stretch of even samples, with its derivatives.
struct PathSamples {
  double rate_hz = 0.0;  ///< above 0
  PathMatrix x;          ///< position, m
  PathMatrix v;          ///< velocity, m/s
  PathMatrix a;          ///< acceleration, m/s^2
  PathMatrix j;          ///< jerk, m/s^3

  [[nodiscard]] std::int64_t count() const { return x.rows(); }  ///< n
};

/// Samples of a smooth path before and behind a stretch that its derivatives need.
inline constexpr std::int64_t kDerivativeMargin = 4;

/// A stretch of a smooth path with its derivatives by central differences over nine samples: of eighth order
/// for velocity and acceleration, of sixth for jerk (Fornberg 1988), exact for polynomials of that degree.
///
/// @param x      positions of the whole recording, m, without missing samples
/// @param first  first sample of the stretch, at least kDerivativeMargin
/// @param count  samples of it; kDerivativeMargin must follow
[[nodiscard]] PathSamples differentiate(const SeriesMatrix& x, std::int64_t first, std::int64_t count,
                                        double rate_hz);
/// The same of some of the columns.
/// @param column  the first of them
/// @param axes    how many
[[nodiscard]] PathSamples differentiate(const SeriesMatrix& x, std::int64_t first, std::int64_t count,
                                        double rate_hz, std::int64_t column, std::int64_t axes);

}  // namespace kinemark::analysis
