// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/classic_chain.h"

#include <algorithm>

#include "kinemark/core/check.h"
#include "kinemark/math/digital_filter.h"

namespace kinemark::trajectory {
namespace {

/// Second derivatives at the knots of the interpolating cubic spline, not-a-knot at both ends.
std::vector<double> second_derivatives(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t n = t.size();
  std::vector<double> h(n - 1), rise(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) h[i] = t[i + 1] - t[i], rise[i] = (y[i + 1] - y[i]) / h[i];
  // Rows 1 to n - 2: h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (rise[i] - rise[i-1]).
  // Not-a-knot makes the third derivative continuous at knots 1 and n - 2, which removes m[0] and m[n-1] from
  // the first and last row.
  const std::size_t rows = n - 2;
  std::vector<double> low(rows), mid(rows), up(rows), right(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    low[r] = h[r], mid[r] = 2.0 * (h[r] + h[r + 1]), up[r] = h[r + 1];
    right[r] = 6.0 * (rise[r + 1] - rise[r]);
  }
  mid[0] += h[0] * (1.0 + h[0] / h[1]);
  up[0] -= h[0] * h[0] / h[1];
  mid[rows - 1] += h[n - 2] * (1.0 + h[n - 2] / h[n - 3]);
  low[rows - 1] -= h[n - 2] * h[n - 2] / h[n - 3];
  for (std::size_t r = 1; r < rows; ++r) {
    const double factor = low[r] / mid[r - 1];
    mid[r] -= factor * up[r - 1];
    right[r] -= factor * right[r - 1];
  }
  std::vector<double> m(n);
  for (std::size_t r = rows; r-- > 0;)
    m[r + 1] = (right[r] - (r + 1 < rows ? up[r] * m[r + 2] : 0.0)) / mid[r];
  m[0] = m[1] - h[0] / h[1] * (m[2] - m[1]);
  m[n - 1] = m[n - 2] + h[n - 2] / h[n - 3] * (m[n - 2] - m[n - 3]);
  return m;
}

}  // namespace

std::vector<double> bridge_by_spline(std::span<const double> values, std::span<const char> valid) {
  check(values.size() == valid.size(), "every value needs a flag");
  std::vector<double> out(values.begin(), values.end()), t, y;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (valid[i]) t.push_back(static_cast<double>(i)), y.push_back(values[i]);
  if (t.size() < 4 || t.size() == values.size()) return out;
  const auto m = second_derivatives(t, y);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (valid[i]) continue;
    const double at = static_cast<double>(i);
    const auto above = std::upper_bound(t.begin(), t.end(), at) - t.begin();
    const auto k = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(t.size()) - 2));
    const double h = t[k + 1] - t[k], a = (t[k + 1] - at) / h, b = (at - t[k]) / h;
    out[i] = a * y[k] + b * y[k + 1] + ((a * a * a - a) * m[k] + (b * b * b - b) * m[k + 1]) * h * h / 6.0;
  }
  return out;
}

std::vector<double> butterworth_both_ways(std::span<const double> values, double rate_hz,
                                          const ClassicChainOptions& options) {
  check(rate_hz > 0.0 && options.cutoff_hz > 0.0, "a low-pass filter needs a rate and a cut-off above zero");
  const std::size_t n = values.size();
  if (n < 4 || options.cutoff_hz >= 0.99 * 0.5 * rate_hz) return {values.begin(), values.end()};
  const double cutoff = options.cutoff_hz / rate_hz;
  const auto sections =
      math::butterworth_lowpass(2, options.cutoff_of_both_passes ? math::two_pass_cutoff(2, cutoff) : cutoff);
  std::vector<double> x(values.begin(), values.end());
  math::filter_both_ways(sections, static_cast<int>(std::min<std::size_t>(60, n - 2)), x);
  return x;
}

std::vector<double> two_point_difference(std::span<const double> values, double rate_hz) {
  const std::size_t n = values.size();
  std::vector<double> out(n, 0.0);
  if (n < 2) return out;
  for (std::size_t i = 1; i + 1 < n; ++i) out[i] = (values[i + 1] - values[i - 1]) * rate_hz / 2.0;
  out[0] = (values[1] - values[0]) * rate_hz;
  out[n - 1] = (values[n - 1] - values[n - 2]) * rate_hz;
  return out;
}

}  // namespace kinemark::trajectory
