// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/choose.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kinemark/math/golden_section.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

namespace kinemark::trajectory::smoothing {
namespace {

constexpr double kRefineWider = 1.6, kRefineLowest = 0.7,
                 kRefineHighest = 1.2;  ///< of the cut-off for positions
constexpr int kTried = 9;
constexpr double kRefineInterior =
    1.2;  ///< variance of velocity up to this times the least: samples all around

struct Velocities {
  std::vector<double> state, variance;
  Velocities(const Series& part, int order, double cutoff_hz)
      : state(static_cast<std::size_t>(part.frames * part.axes * 4)),
        variance(static_cast<std::size_t>(part.frames * 4)) {
    smooth_series(part, order, cutoff_hz, {state.data(), variance.data()});
  }
};

/// sigma^2 dt / pi times the integral of w^2 H H_wide for sigma = 1: velocity noise that both filters share.
double shared_noise(int order, double cutoff_hz, double wide_hz, double interval_s) {
  const double corner = corner_rad_s(order, cutoff_hz), wide = corner_rad_s(order, wide_hz);
  const double top = std::min(M_PI / interval_s, 6.0 * wide);
  constexpr int kSteps = 1000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double w = top * (i + 0.5) / kSteps;
    sum += w * w / (1.0 + std::pow(w / corner, 2 * order)) / (1.0 + std::pow(w / wide, 2 * order));
  }
  return interval_s / M_PI * sum * top / kSteps;
}

constexpr std::int64_t kWhole = 16384, kWindow = 2048, kWindows = 8;
constexpr double kLowest = 0.0005, kHighest = 0.4;  ///< cut-offs tried, of the rate
constexpr double kGrid = 0.45, kRefined = 0.02;  ///< steps of ln(cut-off): coarse, and where the search ends
constexpr double kNoJerkPenalty = 0.05;
constexpr int kDefaultOrder = 4;
constexpr double kDefaultCutoffHz = 6.0;

/// Runs of one order, remembered: SURE and GCV ask for the same ones.
class Family {
 public:
  Family(std::span<const Series> parts, int order) : parts_(parts), order_(order) {}

  const Scores& at(double log_cutoff) {
    for (const auto& [where, scores] : known_)
      if (where == log_cutoff) return scores;
    Scores sum;
    for (const Series& part : parts_) {
      const Scores s = smooth_series(part, order_, std::exp(log_cutoff), {});
      sum.rss += s.rss;
      sum.trace += s.trace;
      sum.values += s.values;
    }
    return known_.emplace_back(log_cutoff, sum).second;
  }
  [[nodiscard]] int order() const { return order_; }

 private:
  std::span<const Series> parts_;
  int order_;
  std::vector<std::pair<double, Scores>> known_;
};

struct Best {
  double log_cutoff = 0.0, value = std::numeric_limits<double>::infinity();
};

/// Coarse grid, then golden section between the neighbours of its best point.
Best minimise(Family& family, Criterion criterion, double sigma, double low, double high) {
  Best best;
  const auto evaluate = [&](double x) {
    const double value = criterion_value(criterion, family.at(x), sigma);
    if (value < best.value) best = {x, value};
    return value;
  };
  const int steps = std::max(1, static_cast<int>(std::ceil((high - low) / kGrid)));
  const double step = (high - low) / steps;
  for (int i = 0; i <= steps; ++i) evaluate(low + i * step);
  (void)math::golden_section(evaluate, std::max(low, best.log_cutoff - step),
                             std::min(high, best.log_cutoff + step), {.width = kRefined});
  return best;
}

}  // namespace

double refine_cutoff(std::span<const Series> parts, int order, double cutoff_hz, double noise_sd_m) {
  const double wide_hz = kRefineWider * cutoff_hz;
  std::vector<Velocities> base, wide;
  double least_variance = std::numeric_limits<double>::infinity();
  for (const Series& part : parts) {
    base.emplace_back(part, order, cutoff_hz);
    wide.emplace_back(part, order, wide_hz);
    const auto& variance = base.back().variance;
    for (std::size_t i = 1; i < variance.size(); i += 4)
      if (variance[i] < least_variance) least_variance = variance[i];
  }
  double best = cutoff_hz, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTried; ++i) {
    const double tried =
        cutoff_hz * kRefineLowest * std::pow(kRefineHighest / kRefineLowest, i / (kTried - 1.0));
    double sum = 0.0, count = 0.0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Series& part = parts[p];
      const Velocities now(part, order, tried);
      for (std::int64_t k = 0; k < part.frames; ++k) {
        if (!(base[p].variance[static_cast<std::size_t>(4 * k + 1)] <= kRefineInterior * least_variance))
          continue;
        for (int axis = 0; axis < part.axes; ++axis) {
          const auto at = static_cast<std::size_t>((k * part.axes + axis) * 4 + 1);
          const double difference = wide[p].state[at] - now.state[at];
          if (std::isnan(difference)) continue;
          sum += difference * difference;
          count += 1.0;
        }
      }
    }
    if (count == 0.0) return cutoff_hz;
    const double risk = sum / count + 2.0 * noise_sd_m * noise_sd_m *
                                          shared_noise(order, tried, wide_hz, parts.front().interval_s);
    if (risk >= least) continue;
    least = risk;
    best = tried;
  }
  return std::sqrt(best * cutoff_hz);
}

std::vector<Series> windows(const Series& series) {
  if (series.frames <= kWhole) return {series};
  std::int64_t seen = 0;
  for (std::int64_t k = 0; k < series.frames; ++k) seen += series.seen[k] != 0;
  std::vector<Series> parts;
  std::int64_t count = 0, begin = 0;
  for (std::int64_t k = 0; k < series.frames && std::ssize(parts) < kWindows; ++k) {
    if (series.seen[k] == 0) continue;
    if (count++ * kWindows < std::ssize(parts) * seen || k < begin) continue;
    parts.push_back(series.part(k, std::min(kWindow, series.frames - k)));
    begin = k + kWindow;
  }
  return parts;
}

double criterion_value(Criterion criterion, const Scores& scores, double sigma) {
  const auto n = static_cast<double>(scores.values);
  if (criterion == Criterion::sure) return (scores.rss + 2.0 * sigma * sigma * scores.trace) / n;
  const double left = std::max(1.0 - scores.trace / n, 1e-9);
  return scores.rss / n / (left * left);
}

Choice choose(std::span<const Series> parts, const ChooseOptions& options) {
  std::int64_t samples = 0, longest = 1;
  for (const Series& part : parts) {
    std::int64_t seen = 0;
    for (std::int64_t k = 0; k < part.frames; ++k) seen += part.seen[k] != 0;
    samples += seen;
    longest = std::max(longest, part.frames);
  }
  const double rate = options.rate_hz;
  const double low = std::log(std::max(kLowest * rate, 0.5 * rate / static_cast<double>(longest)));
  const double high = std::max(low, std::log(kHighest * rate));
  Choice choice;
  choice.noise_sd_m = options.noise_sd_m;
  if (samples < kFewestSamples) {
    choice.enough = false;
    choice.order = options.order > 0 ? options.order : kDefaultOrder;
    choice.cutoff_hz =
        options.cutoff_hz > 0.0 ? options.cutoff_hz : std::min(kDefaultCutoffHz, kHighest * rate);
    if (choice.noise_sd_m <= 0.0) choice.noise_sd_m = std::numeric_limits<double>::quiet_NaN();
    return choice;
  }

  std::vector<Family> families;
  const int lowest = options.criterion == Criterion::gcv ? 3 : 2;
  for (const int order :
       {kDefaultOrder, 5, 3, 2})  // where all are equal (a marker at rest), the first is taken
    if (options.order == 0 && order >= lowest) families.emplace_back(parts, order);
  if (options.order != 0) families.emplace_back(parts, options.order);
  const bool fixed = options.cutoff_hz > 0.0;
  const auto best_of = [&](Family& family, Criterion criterion, double sigma) {
    if (!fixed) return minimise(family, criterion, sigma, low, high);
    const double x = std::log(options.cutoff_hz);
    return Best{x, criterion_value(criterion, family.at(x), sigma)};
  };

  // The noise that is left once cross-validation has taken the movement out.
  if (choice.noise_sd_m <= 0.0) {
    Best least;
    for (Family& family : families) {
      const Best best = best_of(family, Criterion::gcv, 0.0);
      if (best.value >= least.value) continue;
      least = best;
      const Scores& scores = family.at(best.log_cutoff);
      choice.noise_sd_m =
          std::sqrt(scores.rss / std::max(static_cast<double>(scores.values) - scores.trace, 1.0));
    }
  }
  const double sigma = choice.noise_sd_m;
  double least = std::numeric_limits<double>::infinity();
  for (Family& family : families) {
    const Best best = best_of(family, options.criterion, sigma);
    choice.candidates.push_back({family.order(), std::exp(best.log_cutoff), best.value});
    const double risk = best.value - (options.criterion == Criterion::sure ? sigma * sigma : 0.0);
    const double weighed = risk + (options.criterion == Criterion::sure && family.order() < kDefaultOrder
                                       ? kNoJerkPenalty * std::abs(risk)
                                       : 0.0);
    if (choice.order != 0 && weighed >= least) continue;
    least = weighed;
    choice.order = family.order();
    choice.cutoff_hz = std::exp(best.log_cutoff);
  }
  std::ranges::sort(choice.candidates, {}, &data::FilterCandidate::order);
  return choice;
}

}  // namespace kinemark::trajectory::smoothing
