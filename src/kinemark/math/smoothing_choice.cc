// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/smoothing_choice.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"

namespace kinemark::math {
namespace {

// Step of ln r between the two factors whose determinants give the trace; error 1e-4 of a parameter.
constexpr double kStep = 0.02;

// Risk and trace at one cut-off; NaN where double precision does not reach.
SmoothingChoice judge(DifferenceSmoother& smoother, const SeriesMatrix& series, double half_power) {
  SmoothingChoice out{.order = smoother.order(), .half_power = half_power};
  // ln r goes with 2m ln f.
  const double factor = std::exp(kStep / (2.0 * smoother.order()));
  if (!smoother.factor(half_power / factor)) return out;
  const double below = smoother.log_determinant();
  if (!smoother.factor(half_power * factor)) return out;
  const double above = smoother.log_determinant();
  if (!smoother.factor(half_power)) return out;
  SeriesMatrix smoothed = series;
  smoother.smooth(smoothed);
  double squares = 0.0;
  std::int64_t seen = 0;
  for (std::int64_t i = 0; i < smoother.samples(); ++i)
    if (smoother.seen()[at(i)]) {
      squares += (series.row(i) - smoothed.row(i)).squaredNorm();
      ++seen;
    }
  const double count = static_cast<double>(seen), axes = static_cast<double>(series.cols());
  out.parameters = smoother.order() + (above - below) / (2.0 * kStep);
  out.risk = squares / (count * axes) + 2.0 * out.parameters / count - 1.0;
  if (!std::isfinite(out.risk)) out.risk = kNaN;
  return out;
}

bool better(const SmoothingChoice& a, const SmoothingChoice& b) {
  return !std::isnan(a.risk) && (std::isnan(b.risk) || a.risk < b.risk);
}

SmoothingChoice best_of_order(DifferenceSmoother& smoother, const SeriesMatrix& series,
                              const SmoothingSearch& search) {
  SmoothingChoice best;
  const double ratio = std::log(search.highest / search.lowest) / std::max(1, search.frequencies - 1);
  for (int i = 0; i < search.frequencies; ++i) {
    const auto judged = judge(smoother, series, search.lowest * std::exp(ratio * i));
    if (better(judged, best)) best = judged;
  }
  if (std::isnan(best.risk)) return best;
  const double middle = best.half_power;
  for (const double shift : std::array{-0.6, -0.3, 0.3, 0.6}) {
    const double half_power = middle * std::exp(ratio * shift);
    if (half_power < search.lowest || half_power > search.highest) continue;
    const auto judged = judge(smoother, series, half_power);
    if (better(judged, best)) best = judged;
  }
  return best;
}

}  // namespace

std::optional<SmoothingChoice> choose_smoothing(const SeriesMatrix& series, const std::vector<bool>& seen,
                                                const SmoothingSearch& search) {
  check(search.lowest > 0.0 && search.lowest < search.highest && search.highest < 0.5,
        "cut-offs lie between 0 and half the sampling rate");
  SmoothingChoice best;
  for (const int order : search.orders) {
    if (std::ranges::count(seen, true) <= 2 * order) continue;
    DifferenceSmoother smoother(seen, order);
    const auto found = best_of_order(smoother, series, search);
    if (better(found, best)) best = found;
  }
  if (std::isnan(best.risk)) return std::nullopt;
  return best;
}

double noise_from_differences(const SeriesMatrix& series, const std::vector<bool>& seen) {
  constexpr std::array kSixth{1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};
  constexpr double kVariance = 924.0;  // sum of their squares
  double squares = 0.0;
  std::int64_t count = 0, run = 0;
  for (std::int64_t i = 0; i < series.rows(); ++i) {
    run = seen[at(i)] ? run + 1 : 0;
    if (run < 7) continue;
    Eigen::RowVectorXd difference = Eigen::RowVectorXd::Zero(series.cols());
    for (std::int64_t k = 0; k < 7; ++k) difference += kSixth[at(k)] * series.row(i - 6 + k);
    squares += difference.squaredNorm();
    count += series.cols();
  }
  return count > 0 ? std::sqrt(squares / (kVariance * static_cast<double>(count))) : kNaN;
}

}  // namespace kinemark::math
