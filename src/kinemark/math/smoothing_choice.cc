// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/smoothing_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"

namespace kinemark::math {
namespace {

// Step of ln r between the two factors whose determinants give the trace; error 1e-4 of a parameter.
constexpr double kStep = 0.02;
constexpr std::int64_t kPieces = 4;  // of a long series

// A stretch of the series and its smoother.
struct Piece {
  DifferenceSmoother smoother;
  SeriesMatrix series;
};

// Trace of the smoother times the covariance of noise, over a sample: mean of gain times spectrum, with as
// many points below the cut-off as above.
double coloured_share(int order, double half_power, const NoiseModel& noise) {
  constexpr int kSteps = 256;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps, f = 0.5 * u * u;
    sum += gain_of(LowPass::spline, order, half_power, f) * noise.power(f) * 2.0 * u / kSteps;
  }
  return sum;
}

// Risk and trace at one cut-off over all pieces; NaN where double precision does not reach.
SmoothingChoice judge(std::vector<Piece>& pieces, double half_power, const NoiseModel* noise) {
  const int order = pieces.front().smoother.order();
  SmoothingChoice out{.order = order, .half_power = half_power};
  // ln r goes with 2m ln f.
  const double factor = std::exp(kStep / (2.0 * order));
  double squares = 0.0, parameters = 0.0, trace = 0.0;
  const double share = noise == nullptr ? 0.0 : coloured_share(order, half_power, *noise);
  const double slow = noise == nullptr ? 0.0 : noise->power(0.01 * half_power);
  std::int64_t seen = 0;
  for (auto& [smoother, series] : pieces) {
    if (!smoother.factor(half_power / factor)) return out;
    const double below = smoother.log_determinant();
    if (!smoother.factor(half_power * factor)) return out;
    const double above = smoother.log_determinant();
    if (!smoother.factor(half_power)) return out;
    SeriesMatrix smoothed = series;
    smoother.smooth(smoothed);
    const std::int64_t before = seen;
    for (std::int64_t i = 0; i < smoother.samples(); ++i)
      if (smoother.seen()[at(i)]) {
        squares += (series.row(i) - smoothed.row(i)).squaredNorm();
        ++seen;
      }
    const double own = order + (above - below) / (2.0 * kStep);
    parameters += own;
    trace += noise == nullptr ? own : static_cast<double>(seen - before) * share + 0.5 * order * slow;
  }
  const double count = static_cast<double>(seen), axes = static_cast<double>(pieces.front().series.cols());
  out.parameters = parameters;
  out.risk = squares / (count * axes) + 2.0 * trace / count - 1.0;
  if (!std::isfinite(out.risk)) out.risk = kNaN;
  return out;
}

bool better(const SmoothingChoice& a, const SmoothingChoice& b) {
  return !std::isnan(a.risk) && (std::isnan(b.risk) || a.risk < b.risk);
}

SmoothingChoice best_of_order(std::vector<Piece>& pieces, const SmoothingSearch& search) {
  SmoothingChoice best;
  const double ratio = std::log(search.highest / search.lowest) / std::max(1, search.frequencies - 1);
  for (int i = 0; i < search.frequencies; ++i) {
    const auto judged = judge(pieces, search.lowest * std::exp(ratio * i), search.noise);
    if (better(judged, best)) best = judged;
  }
  if (std::isnan(best.risk)) return best;
  const double middle = best.half_power;
  for (const double shift : std::array{-0.6, -0.3, 0.3, 0.6}) {
    const double half_power = middle * std::exp(ratio * shift);
    if (half_power < search.lowest || half_power > search.highest) continue;
    const auto judged = judge(pieces, half_power, search.noise);
    if (better(judged, best)) best = judged;
  }
  return best;
}

// The series itself, or of a long one kPieces stretches at even distances, those that have samples enough.
std::vector<Piece> pieces_of(const SeriesMatrix& series, const std::vector<bool>& seen, int order,
                             std::int64_t most) {
  const std::int64_t n = series.rows();
  const bool whole = n <= most;
  const std::int64_t count = whole ? 1 : kPieces, length = whole ? n : most / kPieces;
  std::vector<Piece> out;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t first = whole ? 0 : k * (n - length) / (count - 1);
    std::vector<bool> part(seen.begin() + first, seen.begin() + first + length);
    if (std::ranges::count(part, true) <= 2 * order) continue;
    out.push_back(
        {.smoother = DifferenceSmoother(std::move(part), order), .series = series.middleRows(first, length)});
  }
  return out;
}

}  // namespace

std::optional<SmoothingChoice> choose_smoothing(const SeriesMatrix& series, const std::vector<bool>& seen,
                                                const SmoothingSearch& search) {
  check(search.lowest > 0.0 && search.lowest < search.highest && search.highest < 0.5,
        "cut-offs lie between 0 and half the sampling rate");
  check(search.samples >= 1000 * kPieces, "a choice needs a thousand samples of each span");
  SmoothingChoice best;
  for (const int order : search.orders) {
    auto pieces = pieces_of(series, seen, order, search.samples);
    if (pieces.empty()) continue;
    const auto found = best_of_order(pieces, search);
    if (better(found, best)) best = found;
  }
  if (std::isnan(best.risk)) return std::nullopt;
  return best;
}

double noise_from_differences(const SeriesMatrix& series, const std::vector<bool>& seen) {
  constexpr std::array kSixth{1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};
  constexpr double kVariance = 924.0;  // sum of their squares
  const Eigen::Index columns = series.cols();
  double squares = 0.0;
  std::int64_t count = 0, run = 0;
  for (std::int64_t i = 0; i < series.rows(); ++i) {
    run = seen[at(i)] ? run + 1 : 0;
    if (run < 7) continue;
    for (Eigen::Index c = 0; c < columns; ++c) {
      double difference = 0.0;
      for (std::int64_t k = 0; k < 7; ++k) difference += kSixth[at(k)] * series(i - 6 + k, c);
      squares += difference * difference;
    }
    count += columns;
  }
  return count > 0 ? std::sqrt(squares / (kVariance * static_cast<double>(count))) : kNaN;
}

}  // namespace kinemark::math
