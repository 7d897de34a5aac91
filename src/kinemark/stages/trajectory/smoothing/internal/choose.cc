// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/choose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/math/golden_section.h"

namespace kinemark::trajectory::smoothing {
namespace {

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
