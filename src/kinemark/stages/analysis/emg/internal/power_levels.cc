// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/internal/power_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

constexpr double kLevelStep = 0.25;   // natural logarithm of power
constexpr double kStepCost = 2.0;     // beside the logarithm of the bins
constexpr std::int64_t kBlock = 5;    // bins whose scatter tells the freedom
constexpr double kActivePower = 2.0;  // of rest
constexpr double kValley = 0.15;      // natural logarithm: outer over inner parts of what is quiet
constexpr double kModulated = 0.5;    // degrees of freedom of an even strength
constexpr std::int64_t kTrim = 3;     // bins beside a burst that may hold its beginning

std::vector<PowerLevel> likeliest(const std::vector<double>& power, double freedom) {
  const auto n = std::ssize(power);
  auto sorted = power;
  std::ranges::sort(sorted);
  std::vector<double> log_level;
  for (double x = std::log(sorted[sorted.size() / 200]) - 1.0; x <= std::log(sorted.back()) + kLevelStep;
       x += kLevelStep)
    log_level.push_back(x);
  const auto k = log_level.size();
  std::vector<double> weight(k), best(k), cost(k);
  for (std::size_t j = 0; j < k; ++j) weight[j] = std::exp(-log_level[j]);
  const double change = std::log(static_cast<double>(n)) + kStepCost;
  std::vector<char> stepped(at(n) * k, 0);
  std::vector<std::size_t> from(at(n), 0);
  for (std::int64_t i = 0; i < n; ++i) {
    const auto least = static_cast<std::size_t>(std::ranges::min_element(best) - best.begin());
    from[at(i)] = least;
    for (std::size_t j = 0; j < k; ++j) {
      const bool steps = i > 0 && best[j] > best[least] + change;
      stepped[at(i) * k + j] = steps ? 1 : 0;
      cost[j] = (steps ? best[least] + change : best[j]) +
                0.5 * freedom * (log_level[j] + power[at(i)] * weight[j]);
    }
    best.swap(cost);
  }
  std::vector<PowerLevel> out;
  auto state = static_cast<std::size_t>(std::ranges::min_element(best) - best.begin());
  std::int64_t end = n;
  for (std::int64_t i = n - 1; i >= 0; --i) {
    const bool begins = i == 0 || stepped[at(i) * k + state] != 0;
    if (!begins) continue;
    out.push_back({.first = i, .end = end});
    end = i;
    state = from[at(i)];
  }
  std::ranges::reverse(out);
  for (auto& level : out) {
    for (auto i = level.first; i < level.end; ++i) level.power += power[at(i)];
    level.power /= static_cast<double>(level.end - level.first);
  }
  return out;
}

double freedom_within(const std::vector<double>& power, const std::vector<PowerLevel>& levels) {
  double squares = 0.0, count = 0.0;
  for (const auto& level : levels) {
    const auto blocks = (level.end - level.first) / kBlock;
    if (blocks < 3) continue;
    std::vector<double> mean(at(blocks), 0.0);
    double whole = 0.0;
    for (std::int64_t b = 0; b < blocks; ++b) {
      for (std::int64_t i = 0; i < kBlock; ++i) mean[at(b)] += power[at(level.first + b * kBlock + i)];
      whole += mean[at(b)] / static_cast<double>(blocks);
    }
    for (const double m : mean) squares += std::pow(m / whole - 1.0, 2);
    count += static_cast<double>(blocks - 1);
  }
  return squares > 0.0 ? 2.0 * count / (squares * static_cast<double>(kBlock))
                       : std::numeric_limits<double>::infinity();
}

template <typename F>
void each_run(const std::vector<char>& active, char which, F&& f) {
  const auto n = std::ssize(active);
  for (std::int64_t i = 0; i < n; ++i) {
    if (active[at(i)] != which) continue;
    const auto first = i;
    while (i < n && active[at(i)] == which) ++i;
    f(first, i);
  }
}

// Are quiet parts louder beside bursts than half-way between them, more than by chance?
bool is_valley(const std::vector<double>& power, const std::vector<char>& active, double freedom) {
  const auto n = std::ssize(power);
  double outer = 0.0, inner = 0.0, count = 0.0;
  each_run(active, 0, [&](std::int64_t first, std::int64_t end) {
    const auto begin = first > 0 ? first + kTrim : 0, last = end < n ? end - kTrim : n;
    const auto quarter = (last - begin) / 4;
    for (std::int64_t i = 0; i < quarter; ++i) {
      if (first > 0) outer += power[at(begin + i)], inner += power[at(begin + quarter + i)], count += 1.0;
      if (end < n) outer += power[at(last - 1 - i)], inner += power[at(last - 1 - quarter - i)], count += 1.0;
    }
  });
  if (!(count > 0.0) || !(inner > 0.0)) return false;
  return std::log(outer / inner) > std::max(kValley, 2.0 * std::sqrt(4.0 / (freedom * count)));
}

}  // namespace

std::vector<PowerLevel> power_levels(const std::vector<double>& power, double& freedom) {
  auto first = likeliest(power, freedom);
  const double within = freedom_within(power, first);
  if (!std::isfinite(within)) return first;
  freedom = within;
  return likeliest(power, freedom);
}

Quiet find_quiet(const std::vector<double>& power, const std::vector<PowerLevel>& levels, double freedom,
                 double freedom_still, const QuietBins& bins) {
  const auto n = std::ssize(power);
  std::vector<double> of_bin(at(n));
  for (const auto& level : levels)
    for (auto i = level.first; i < level.end; ++i) of_bin[at(i)] = level.power;
  auto sorted = of_bin;
  std::ranges::sort(sorted);
  Quiet out;
  out.power = sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(bins.rest))];
  for (int turn = 0; turn < 5; ++turn) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < of_bin.size(); ++i)
      if (of_bin[i] < std::numbers::sqrt2 * out.power && of_bin[i] > 0.5 * out.power)
        sum += power[i], count += 1.0;
    if (count > 0.0) out.power = sum / count;
  }
  double at_it = 0.0, above = 0.0;
  for (const double level : of_bin) {
    at_it += level < std::numbers::sqrt2 * out.power ? 1.0 : 0.0;
    above +=
        level >= std::numbers::sqrt2 * out.power && level < 2.0 * std::numbers::sqrt2 * out.power ? 1.0 : 0.0;
  }
  out.active.resize(at(n));
  std::ranges::transform(of_bin, out.active.begin(),
                         [&](double level) { return level >= kActivePower * out.power ? 1 : 0; });
  for (const char which : {char{0}, char{1}}) {  // short interruptions, then short bursts
    const auto before = out.active;
    each_run(before, which, [&](std::int64_t first, std::int64_t end) {
      if (static_cast<double>(end - first) >= bins.burst || (which == 0 && (first == 0 || end == n))) return;
      std::fill(out.active.begin() + first, out.active.begin() + end, which == 0 ? char{1} : char{0});
    });
  }
  const auto active = std::ranges::count(out.active, 1);
  double judged = 0.0;
  std::vector<PowerLevel> parts;  // that are quiet
  each_run(out.active, 0, [&](std::int64_t first, std::int64_t end) {
    parts.push_back({.first = first, .end = end});
    if (const auto length = static_cast<double>(end - first); length >= bins.judged) judged += length;
  });
  if (active == 0 || levels.size() == 1)
    out.found = freedom_within(power, parts) < kModulated * freedom_still ? Quiet::Found::no_rest
                                                                          : Quiet::Found::steady;
  else if (active == n || at_it < bins.rest || judged < bins.rest || above > at_it ||
           is_valley(power, out.active, freedom))
    out.found = Quiet::Found::no_rest;
  else
    out.found = Quiet::Found::bursts;
  return out;
}

}  // namespace kinemark::analysis
