// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/bandwidth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/stages/trajectory/from_counts/internal/wiener_filter.h"

namespace kinemark::trajectory {
namespace {

using Scalars = std::vector<internal::Sight<1>>;

/// Pieces of a record on three axes along which its sights are nearly independent.
struct Problem {
  std::vector<Scalars> series;  // each piece, each axis
  double information = 0.0;     // typical, per axis
  double interval_s = 0.0;
};

Problem split(std::span<const PositionSight> sights, std::size_t max_sights) {
  Problem problem;
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const auto& s : sights) mean += s.information;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(mean);
  const Eigen::Matrix3d axes = eigen.eigenvectors();
  const double least = 1e-3 * eigen.eigenvalues()(0) / static_cast<double>(sights.size());
  const auto add = [&](std::size_t first, std::size_t last) {
    std::array<Scalars, 3> piece;
    bool begun = false;
    for (std::size_t k = first; k < last; ++k) {
      const Eigen::Matrix3d h = axes.transpose() * sights[k].information * axes;
      const Eigen::Vector3d z = axes.transpose() * sights[k].position;
      const Eigen::Matrix3d c = h.inverse();
      // Incomplete sights stay as instants without information; they may not begin a piece, whose first value
      // starts the filter.
      const bool complete =
          c.allFinite() && c.diagonal().minCoeff() > 0.0 && c.diagonal().maxCoeff() * least < 1.0;
      begun = begun || complete;
      if (!begun) continue;
      for (int a = 0; a < 3; ++a) {
        internal::Sight<1> s;
        s.time_s = sights[k].time_s;
        s.information(0) = complete ? 1.0 / c(a, a) : 0.0;
        s.value(0) = complete ? z(a) : 0.0;
        piece[static_cast<std::size_t>(a)].push_back(s);
      }
    }
    for (auto& p : piece)
      if (!p.empty()) problem.series.push_back(std::move(p));
  };
  const std::size_t n = sights.size();
  if (n <= max_sights) {
    add(0, n);
  } else {
    const std::size_t length = max_sights / 4;
    for (std::size_t i = 0; i < 4; ++i) add(i * (n - length) / 3, i * (n - length) / 3 + length);
  }
  double logs = 0.0;
  std::size_t count = 0;
  std::vector<double> intervals;
  for (const auto& s : problem.series)
    for (std::size_t k = 0; k < s.size(); ++k) {
      if (s[k].information(0) > 0.0) logs += std::log(s[k].information(0)), ++count;
      if (k > 0) intervals.push_back(s[k].time_s - s[k - 1].time_s);
    }
  if (count < 36 || intervals.empty()) return {};
  problem.information = std::exp(logs / static_cast<double>(count));
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  problem.interval_s = *middle;
  return problem;
}

constexpr double kLongestGap = 4.5;  // intervals: longer gaps carry little information on the bandwidth

template <int kOrder>
double risk(const Problem& problem, const Bandwidth& at) {
  internal::WienerFilter<kOrder, 1> filter(at.spectral_density, at.time_constant_s);
  double sum = 0.0;
  for (const auto& series : problem.series)
    for (const auto& [first, count] : internal::runs_between_gaps(series, kLongestGap * problem.interval_s))
      filter.smooth(
          std::span(series).subspan(first, count), true, [&](std::size_t k, const auto& x, const auto* p) {
            const double h = series[first + k].information(0), r = series[first + k].value(0) - x(0);
            if (h > 0.0) sum += h * r * r + 2.0 * h * (*p)(0, 0);
          });
  return sum;
}

double risk(const Problem& problem, const Bandwidth& at) {
  const double sum = at.order == 3   ? risk<3>(problem, at)
                     : at.order == 4 ? risk<4>(problem, at)
                                     : risk<5>(problem, at);
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

}  // namespace

Bandwidth bandwidth_at(int order, double half_gain_hz, double information, double interval_s) {
  check(order >= 3 && order <= 5, "the order of a smoother is 3, 4 or 5");
  check(half_gain_hz > 0.0 && information > 0.0 && interval_s > 0.0, "a bandwidth needs positive numbers");
  const double omega = 2.0 * std::numbers::pi * half_gain_hz;
  return {.order = order,
          .spectral_density = std::pow(omega, 2 * order) * interval_s / information,
          .time_constant_s = 1.0 / omega,
          .cutoff_hz = half_gain_hz * std::pow(std::numbers::sqrt2 - 1.0, 0.5 / order)};
}

namespace {

/// Octaves first; then the golden section of the two octaves around the best.
template <class Risk>
Bandwidth search(const Risk& risk_at, double highest, int octaves) {
  constexpr int kSections = 5;
  const double octave = std::log(2.0), ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  Bandwidth found;
  found.sure = std::numeric_limits<double>::infinity();
  int best = 0;
  for (int i = 0; i < octaves; ++i)
    if (const auto at = risk_at(highest - i * octave); at.sure < found.sure) found = at, best = i;
  double low = highest - (best + 1) * octave, high = highest - std::max(best - 1, 0) * octave;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  auto fa = risk_at(a), fb = risk_at(b);
  for (int i = 0; i < kSections; ++i) {
    if (fa.sure < found.sure) found = fa;
    if (fb.sure < found.sure) found = fb;
    if (fa.sure < fb.sure) {
      high = b, b = a, fb = fa;
      a = high - ratio * (high - low), fa = risk_at(a);
    } else {
      low = a, a = b, fa = fb;
      b = low + ratio * (high - low), fb = risk_at(b);
    }
  }
  return found;
}

}  // namespace

Bandwidth choose_bandwidth(std::span<const PositionSight> sights, const BandwidthOptions& options) {
  const Problem problem =
      sights.empty() ? Problem{} : split(sights, std::max<std::size_t>(options.max_sights, 48));
  const int fallback_order = options.order > 0 ? options.order : 4;
  const double fallback_hz = options.half_gain_hz > 0.0 ? options.half_gain_hz : 6.0;
  if (problem.series.empty()) {
    const double span = sights.size() > 1 ? sights.back().time_s - sights.front().time_s : 0.0;
    return bandwidth_at(fallback_order, fallback_hz, 1e6,
                        span > 0.0 ? span / static_cast<double>(sights.size() - 1) : 0.01);
  }
  Bandwidth best;
  best.sure = std::numeric_limits<double>::infinity();
  for (const int order : {3, 4, 5}) {
    if (options.order > 0 && order != options.order) continue;
    const auto at = [&](double log_hz) {
      auto b = bandwidth_at(order, std::exp(log_hz), problem.information, problem.interval_s);
      b.sure = risk(problem, b);
      return b;
    };
    const double top = std::log(0.35 / problem.interval_s);
    Bandwidth found;
    if (options.half_gain_hz > 0.0)
      found = at(std::log(options.half_gain_hz));
    else if (options.around_hz > 0.0)
      found = search(at, std::min(top, std::log(2.0 * options.around_hz)), 3);
    else
      found = search(at, top, 8);
    if (found.sure < best.sure) best = found;
  }
  if (best.sure < std::numeric_limits<double>::infinity()) return best;
  return bandwidth_at(fallback_order, fallback_hz, problem.information, problem.interval_s);
}

}  // namespace kinemark::trajectory
