// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/precision_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/missing.h"

namespace kinemark::pipeline {
namespace {

constexpr double kMostCells = 24.0;

struct Sample {
  std::array<double, 2> at;
  double sd_m;
};

std::vector<Sample> samples_of(const data::Trajectories& points, const std::array<int, 2>& axes) {
  std::vector<Sample> out;
  if (points.covariance.empty()) return out;
  for (std::int64_t f = 0; f < points.frames(); ++f)
    for (std::int64_t m = 0; m < points.markers(); ++m) {
      if (!points.present(f, m)) continue;
      const double* c = points.covariance.data() + 6 * points.index(f, m);
      const double trace = c[0] + c[3] + c[5];
      if (!std::isfinite(trace) || trace < 0.0) continue;
      out.push_back({{points.x(f, m)[axes[0]], points.x(f, m)[axes[1]]}, std::sqrt(trace)});
    }
  return out;
}

double side_of_cell(double reach_m) {
  const double least = std::max(reach_m, 1e-6) / kMostCells;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least) return step * power;
  return 10.0 * power;
}

}  // namespace

PrecisionMap precision_map(const data::Trajectories& points, int along) {
  PrecisionMap map{.axes = {along == 0 ? 1 : 0, along == 2 ? 1 : 2}};
  const auto samples = samples_of(points, map.axes);
  if (samples.empty()) return map;
  std::array<double, 2> low{samples.front().at}, high = low;
  for (const auto& sample : samples)
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], sample.at[k]);
      high[k] = std::max(high[k], sample.at[k]);
    }
  map.cell_m = side_of_cell(std::max(high[0] - low[0], high[1] - low[1]));
  const auto cell_of = [&](std::size_t k, double value) {
    return static_cast<std::int64_t>(std::floor((value - map.first[k]) / map.cell_m));
  };
  for (std::size_t k = 0; k < 2; ++k) map.first[k] = map.cell_m * std::floor(low[k] / map.cell_m);
  map.columns = cell_of(0, high[0]) + 1;
  map.rows = cell_of(1, high[1]) + 1;
  std::vector<std::vector<double>> cells(static_cast<std::size_t>(map.columns * map.rows));
  for (const auto& sample : samples)
    cells[static_cast<std::size_t>(cell_of(1, sample.at[1]) * map.columns + cell_of(0, sample.at[0]))]
        .push_back(sample.sd_m);
  for (auto& cell : cells) {
    map.samples.push_back(std::ssize(cell));
    if (cell.empty()) {
      map.sd_m.push_back(kNaN);
      continue;
    }
    const auto middle = cell.begin() + std::ssize(cell) / 2;
    std::ranges::nth_element(cell, middle);
    map.sd_m.push_back(*middle);
  }
  return map;
}

}  // namespace kinemark::pipeline
