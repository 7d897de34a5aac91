// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/plot_axis.h"

#include <algorithm>
#include <cmath>

namespace kinemark::report {

bool PlotAxis::shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0.0); }

void PlotAxis::include(double value) {
  if (!shows(value)) return;
  if (logarithmic) value = std::log10(value);
  low = std::min(low, value);
  high = std::max(high, value);
}

void PlotAxis::settle() {
  if (!(low <= high)) low = 0.0, high = 1.0;
  const double margin = high > low ? 0.04 * (high - low) : 0.5;
  low -= margin;
  high += margin;
}

double PlotAxis::at(double value) const {
  return from + ((logarithmic ? std::log10(value) : value) - low) / (high - low) * (to - from);
}

std::vector<double> PlotAxis::ticks(double count) const {
  std::vector<double> out;
  if (!logarithmic) {
    const double raw = (high - low) / count, power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * power;
    for (const double m : {5.0, 2.0, 1.0})
      if (m * power >= raw) step = m * power;
    for (double v = std::ceil(low / step) * step; v <= high; v += step)
      out.push_back(std::abs(v) < 1e-9 * step ? 0.0 : v);
    return out;
  }
  // Three to a power of ten where there is room for them, else one, or one of several.
  constexpr double kEach = 3.0, kCrowded = 2.0;
  const double step = std::max(1.0, std::ceil((high - low) / (kCrowded * count)));
  const bool crowded = kEach * (high - low) > kCrowded * count;
  for (double power = step * std::floor(low / step); power <= high; power += step)
    for (const double m : {1.0, 2.0, 5.0}) {
      const double v = std::log10(m) + power;
      if (v >= low && v <= high && (m == 1.0 || !crowded)) out.push_back(m * std::pow(10.0, power));
    }
  return out;
}

void make_equal(PlotAxis& x, PlotAxis& y) {
  const double x_scale = (x.high - x.low) / std::abs(x.to - x.from),
               y_scale = (y.high - y.low) / std::abs(y.to - y.from);
  PlotAxis& narrow = x_scale < y_scale ? x : y;
  const double half = 0.5 * std::max(x_scale, y_scale) * std::abs(narrow.to - narrow.from),
               middle = 0.5 * (narrow.low + narrow.high);
  narrow.low = middle - half;
  narrow.high = middle + half;
}

}  // namespace kinemark::report
