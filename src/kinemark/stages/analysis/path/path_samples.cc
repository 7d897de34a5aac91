// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_samples.h"

#include <array>

#include "kinemark/core/check.h"

namespace kinemark::analysis {
namespace {

// Weights of the samples 0 to 4 steps away; those before have the same sign (even) or the opposite (odd).
struct Stencil {
  std::array<double, 5> weight;
  double before;
};
constexpr Stencil kFirst{{0.0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280}, -1.0};
constexpr Stencil kSecond{{-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560}, 1.0};
constexpr Stencil kThird{{0.0, -61.0 / 30, 169.0 / 120, -3.0 / 10, 7.0 / 240}, -1.0};

template <const Stencil& kStencil>
SeriesMatrix apply(const SeriesMatrix& x, std::int64_t first, std::int64_t count, double scale) {
  // Rows lie one behind the other, so that a step of k samples is one of k columns() numbers.
  const std::int64_t step = x.cols();
  SeriesMatrix out(count, step);
  const double* here = x.data() + first * step;
  double* to = out.data();
  for (std::int64_t i = 0; i < count * step; ++i) {
    double sum = kStencil.weight[0] * here[i];
    for (std::int64_t k = 1; k <= kDerivativeMargin; ++k)
      sum += kStencil.weight[static_cast<std::size_t>(k)] *
             (here[i + k * step] + kStencil.before * here[i - k * step]);
    to[i] = scale * sum;
  }
  return out;
}

}  // namespace

PathSamples differentiate(const SeriesMatrix& x, std::int64_t first, std::int64_t count, double rate_hz) {
  check(first >= kDerivativeMargin && count > 0 && first + count + kDerivativeMargin <= x.rows(),
        "a stretch needs four samples before and behind it");
  return {.rate_hz = rate_hz,
          .x = x.middleRows(first, count),
          .v = apply<kFirst>(x, first, count, rate_hz),
          .a = apply<kSecond>(x, first, count, rate_hz * rate_hz),
          .j = apply<kThird>(x, first, count, rate_hz * rate_hz * rate_hz)};
}

}  // namespace kinemark::analysis
