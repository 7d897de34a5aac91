// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/bandwidth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/math/golden_section.h"

namespace kinemark::trajectory {
namespace {

using Scalars = std::vector<math::PositionObservation<1>>;

/// Pieces of a record on three axes along which its observations are nearly independent.
struct Problem {
  std::vector<Scalars> series;  // each piece, each axis
  double information = 0.0;     // typical, per axis
  double interval_s = 0.0;
};

Problem split(std::span<const LedObservation> observations, std::size_t max_observations) {
  Problem problem;
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const auto& s : observations) mean += s.information;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(mean);
  const Eigen::Matrix3d& axes = eigen.eigenvectors();
  const double least = 1e-3 * eigen.eigenvalues()(0) / static_cast<double>(observations.size());
  const auto add = [&](std::size_t first, std::size_t last) {
    std::array<Scalars, 3> piece;
    bool begun = false;
    for (std::size_t k = first; k < last; ++k) {
      const Eigen::Matrix3d h = axes.transpose() * observations[k].information * axes;
      const Eigen::Vector3d z = axes.transpose() * observations[k].position;
      const Eigen::Matrix3d c = h.inverse();
      // Incomplete observations stay as instants without information; they may not begin a piece, whose first
      // value starts the filter.
      const bool complete =
          c.allFinite() && c.diagonal().minCoeff() > 0.0 && c.diagonal().maxCoeff() * least < 1.0;
      begun = begun || complete;
      if (!begun) continue;
      for (int a = 0; a < 3; ++a) {
        math::PositionObservation<1> s;
        s.time_s = observations[k].time_s;
        s.information(0) = complete ? 1.0 / c(a, a) : 0.0;
        s.position(0) = complete ? z(a) : 0.0;
        piece[static_cast<std::size_t>(a)].push_back(s);
      }
    }
    for (auto& p : piece)
      if (!p.empty()) problem.series.push_back(std::move(p));
  };
  const std::size_t n = observations.size();
  if (n <= max_observations) {
    add(0, n);
  } else {
    const std::size_t length = max_observations / 4;
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

double risk(const Problem& problem, const Bandwidth& at, double most_squares) {
  const math::WienerProcess process{
      .order = at.order, .spectral_density = at.spectral_density, .time_scale_s = at.time_constant_s};
  math::WienerOptions<1> options;
  options.covariance = math::WienerCovariance::position;
  double sum = 0.0;
  for (const auto& series : problem.series) {
    const std::span<const math::PositionObservation<1>> observations(series);
    for (const auto& [first, count] : math::runs_between_gaps(observations, kLongestGap * problem.interval_s))
      math::smooth_wiener<1>(process, observations.subspan(first, count), options,
                             [&, first](std::size_t k, const math::WienerEstimate<1>& x) {
                               const auto& sight = observations[first + k];
                               const double h = sight.information(0),
                                            r = sight.position(0) - x.derivatives(0);
                               if (h > 0.0)
                                 sum += std::min(most_squares, h * r * r) + 2.0 * h * x.covariance(0, 0);
                             });
  }
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
  const double octave = std::log(2.0);
  Bandwidth found;
  found.sure = std::numeric_limits<double>::infinity();
  const auto risk = [&](double log_hz) {
    const Bandwidth at = risk_at(log_hz);
    if (at.sure < found.sure) found = at;
    return at.sure;
  };
  int best = 0;
  double least = found.sure;
  for (int i = 0; i < octaves; ++i)
    if (const double sure = risk(highest - i * octave); sure < least) least = sure, best = i;
  std::ignore = math::golden_section(risk, highest - (best + 1) * octave,
                                     highest - std::max(best - 1, 0) * octave, {.sections = 4});
  return found;
}

}  // namespace

Bandwidth choose_bandwidth(std::span<const LedObservation> observations, const BandwidthOptions& options) {
  const Problem problem = observations.empty()
                              ? Problem{}
                              : split(observations, std::max<std::size_t>(options.max_observations, 48));
  const int fallback_order = options.order > 0 ? options.order : 4;
  const double fallback_hz = options.half_gain_hz > 0.0 ? options.half_gain_hz : 6.0;
  if (problem.series.empty()) {
    const double span =
        observations.size() > 1 ? observations.back().time_s - observations.front().time_s : 0.0;
    return bandwidth_at(fallback_order, fallback_hz, 1e6,
                        span > 0.0 ? span / static_cast<double>(observations.size() - 1) : 0.01);
  }
  Bandwidth best;
  best.sure = std::numeric_limits<double>::infinity();
  for (const int order : {3, 4, 5}) {
    if (options.order > 0 && order != options.order) continue;
    const auto at = [&](double log_hz) {
      auto b = bandwidth_at(order, std::exp(log_hz), problem.information, problem.interval_s);
      b.sure = risk(problem, b, options.most_squares);
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
