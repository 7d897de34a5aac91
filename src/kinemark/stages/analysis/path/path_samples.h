// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/math/difference_smoother.h"

namespace kinemark::analysis {

/// n x 3: one row per sample, one column per axis.
using math::SeriesMatrix;

/// The path of one point over a stretch of even samples, with its derivatives.
struct PathSamples {
  double rate_hz = 0.0;  ///< above 0
  SeriesMatrix x;        ///< position, m
  SeriesMatrix v;        ///< velocity, m/s
  SeriesMatrix a;        ///< acceleration, m/s^2
  SeriesMatrix j;        ///< jerk, m/s^3

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

}  // namespace kinemark::analysis
