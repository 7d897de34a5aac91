// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_samples.h"

#include <algorithm>

#include "kinemark/core/check.h"
#include "kinemark/core/wide.h"

namespace kinemark::analysis {
namespace {

// Weights of the samples 0 to 4 steps away; those before have the same sign (even) or the opposite (odd).
struct Stencil {
  double weight[5];
  double before;
};
constexpr Stencil kFirst{{0.0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280}, -1.0};
constexpr Stencil kSecond{{-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560}, 1.0};
constexpr Stencil kThird{{0.0, -61.0 / 30, 169.0 / 120, -3.0 / 10, 7.0 / 240}, -1.0};

// Where one axis comes from and goes to: the samples with the margin before and behind them.
struct Axis {
  const double* x;
  std::int64_t count;
  double rate;
  double *v, *a, *j;
};

template <const Stencil& kStencil>
[[gnu::always_inline]] inline void apply(const double* here, double scale, double* to) {
  Lanes sum, before, behind;
  load(sum, here);
  sum = kStencil.weight[0] * sum;
  for (std::int64_t k = 1; k <= kDerivativeMargin; ++k) {
    load(behind, here + k);
    load(before, here - k);
    sum += kStencil.weight[k] * (behind + kStencil.before * before);
  }
  store(to, scale * sum);
}

[[gnu::always_inline]] inline void differentiate_axis(const Axis& axis) {
  const double rate = axis.rate, rate2 = rate * rate, rate3 = rate * rate * rate;
  const auto four = [&](std::int64_t i) __attribute__((always_inline)) {
    const double* here = axis.x + kDerivativeMargin + i;
    apply<kFirst>(here, rate, axis.v + i);
    apply<kSecond>(here, rate2, axis.a + i);
    apply<kThird>(here, rate3, axis.j + i);
  };
  std::int64_t i = 0;
  for (; i + kLanes <= axis.count; i += kLanes) four(i);
  if (i < axis.count) four(axis.count - kLanes);
}

}  // namespace

PathSamples differentiate(const SeriesMatrix& x, std::int64_t first, std::int64_t count, double rate_hz) {
  return differentiate(x, first, count, rate_hz, 0, x.cols());
}

PathSamples differentiate(const SeriesMatrix& x, std::int64_t first, std::int64_t count, double rate_hz,
                          std::int64_t column, std::int64_t axes) {
  check(first >= kDerivativeMargin && count > 0 && first + count + kDerivativeMargin <= x.rows(),
        "a span needs four samples before and behind it");
  check(column >= 0 && column + axes <= x.cols(), "a path has as many columns as are taken of it");
  PathSamples out{.rate_hz = rate_hz};
  for (auto* matrix : {&out.x, &out.v, &out.a, &out.j}) matrix->resize(count, axes);
  // Short ones are made longer, so that they fill a vector.
  const std::int64_t room = std::max(count, kLanes), with_margin = count + 2 * kDerivativeMargin;
  PathMatrix columns = PathMatrix::Zero(room + 2 * kDerivativeMargin, axes);
  PathMatrix few = count < kLanes ? PathMatrix(kLanes, 3) : PathMatrix();
  const double* from = x.data() + (first - kDerivativeMargin) * x.cols() + column;
  for (std::int64_t i = 0; i < with_margin; ++i, from += x.cols())
    for (std::int64_t k = 0; k < axes; ++k) columns(i, k) = from[k];
  out.x = columns.middleRows(kDerivativeMargin, count);
  for (std::int64_t k = 0; k < axes; ++k) {
    Axis axis{.x = columns.col(k).data(),
              .count = count,
              .rate = rate_hz,
              .v = out.v.col(k).data(),
              .a = out.a.col(k).data(),
              .j = out.j.col(k).data()};
    if (count < kLanes) {
      axis.count = kLanes;
      axis.v = few.col(0).data(), axis.a = few.col(1).data(), axis.j = few.col(2).data();
    }
    run_wide<differentiate_axis>(axis);
    if (count < kLanes)
      out.v.col(k) = few.col(0).head(count), out.a.col(k) = few.col(1).head(count),
      out.j.col(k) = few.col(2).head(count);
  }
  return out;
}

}  // namespace kinemark::analysis
