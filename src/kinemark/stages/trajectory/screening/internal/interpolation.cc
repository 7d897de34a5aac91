// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/internal/interpolation.h"

#include <algorithm>
#include <cmath>

namespace kinemark::trajectory::internal {
namespace {

using data::InterpolationKernel;

// All kernels but hold, linear and Lagrange are cubics between two knots, given by the slopes there (knots
// one apart). Those at the ends only need to exist: they are not used.

/// Twice differentiable: s(i-1) + 4 s(i) + s(i+1) = 3 (v(i+1) - v(i-1)), natural ends.
void spline_slopes(Knots& k) {
  const std::vector<double>& v = k.value;
  const std::size_t n = v.size();
  k.scratch.resize(n);
  double pivot = 2.0;
  k.slope[0] = 3.0 * (v[1] - v[0]) / pivot;
  for (std::size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n;
    k.scratch[i] = 1.0 / pivot;
    pivot = (last ? 2.0 : 4.0) - k.scratch[i];
    const double right = last ? 3.0 * (v[i] - v[i - 1]) : 3.0 * (v[i + 1] - v[i - 1]);
    k.slope[i] = (right - k.slope[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i > 0; --i) k.slope[i - 1] -= k.scratch[i] * k.slope[i];
}

void catmull_rom_slopes(Knots& k) {
  for (std::size_t i = 1; i + 1 < k.value.size(); ++i) k.slope[i] = 0.5 * (k.value[i + 1] - k.value[i - 1]);
}

/// Harmonic mean of both chords, flat at an extreme (Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput.
/// 5:300).
void pchip_slopes(Knots& k) {
  for (std::size_t i = 1; i + 1 < k.value.size(); ++i) {
    const double left = k.value[i] - k.value[i - 1];
    const double right = k.value[i + 1] - k.value[i];
    k.slope[i] = left * right > 0.0 ? 2.0 * left * right / (left + right) : 0.0;
  }
}

/// Chords weighted by the change of slope on the other side (Akima 1970, J. ACM 17:589).
void akima_slopes(Knots& k) {
  const std::vector<double>& v = k.value;
  for (std::size_t i = 2; i + 2 < v.size(); ++i) {
    const double a = v[i - 1] - v[i - 2];
    const double b = v[i] - v[i - 1];
    const double c = v[i + 1] - v[i];
    const double d = v[i + 2] - v[i + 1];
    const double weight_b = std::abs(d - c);
    const double weight_c = std::abs(b - a);
    const double sum = weight_b + weight_c;
    k.slope[i] = sum > 0.0 ? (weight_b * b + weight_c * c) / sum : 0.5 * (b + c);
  }
}

/// Weights of four knots i - 1 to i + 2, or of two knots and two slopes, at u between knots i and i + 1.
using Weights = std::array<double, 4>;

Weights lagrange_weights(double u) {
  return {-u * (u - 1.0) * (u - 2.0) / 6.0, (u * u - 1.0) * (u - 2.0) / 2.0, -u * (u + 1.0) * (u - 2.0) / 2.0,
          u * (u * u - 1.0) / 6.0};
}

Weights hermite_weights(double u) {
  const double w = 1.0 - u;
  return {(1.0 + 2.0 * u) * w * w, u * u * (3.0 - 2.0 * u), u * w * w, -u * u * w};
}

}  // namespace

bool residuals(std::span<const double> y, int factor, int phase, InterpolationKernel kernel, Knots& knots,
               std::span<double> out) {
  std::ranges::fill(out, kNotPredicted);
  const auto f = static_cast<std::size_t>(factor);
  const auto p = static_cast<std::size_t>(phase);
  const auto edge = static_cast<std::size_t>(edge_knots(kernel));
  const std::size_t count = y.size() > p ? (y.size() - p - 1) / f + 1 : 0;
  if (count < 2 * edge + 6) return false;
  knots.value.resize(count);
  knots.slope.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) knots.value[i] = y[p + i * f];
  if (kernel == InterpolationKernel::spline) spline_slopes(knots);
  if (kernel == InterpolationKernel::catmull_rom) catmull_rom_slopes(knots);
  if (kernel == InterpolationKernel::pchip) pchip_slopes(knots);
  if (kernel == InterpolationKernel::akima) akima_slopes(knots);
  const double* v = knots.value.data();
  const double* s = knots.slope.data();
  for (std::size_t j = 1; j < f; ++j) {
    const double u = static_cast<double>(j) / static_cast<double>(f);
    const Weights w = kernel == InterpolationKernel::lagrange ? lagrange_weights(u) : hermite_weights(u);
    for (std::size_t i = edge; i + edge + 1 < count; ++i) {
      double made = v[i];
      if (kernel == InterpolationKernel::linear)
        made = (1.0 - u) * v[i] + u * v[i + 1];
      else if (kernel == InterpolationKernel::lagrange)
        made = w[0] * v[i - 1] + w[1] * v[i] + w[2] * v[i + 1] + w[3] * v[i + 2];
      else if (kernel != InterpolationKernel::hold)
        made = w[0] * v[i] + w[1] * v[i + 1] + w[2] * s[i] + w[3] * s[i + 1];
      const std::size_t at = p + i * f + j;
      out[at] = y[at] - made;
    }
  }
  return true;
}

}  // namespace kinemark::trajectory::internal
