// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/channel_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

constexpr std::size_t kFewestSamples = 100;
constexpr double kNearZero = 0.5;  // the least of the median's distance
constexpr double kSkewed = 0.6;    // from the least to the median over from there to the largest
constexpr double kSmooth = 0.2;    // of the deviation: steps from sample to sample of an envelope

// Root mean square of the steps from sample to sample over the deviation about the mean.
double roughness(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0, steps = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (std::size_t i = 1; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    steps += (values[i] - values[i - 1]) * (values[i] - values[i - 1]);
  }
  return std::sqrt(steps / squares);
}

}  // namespace

std::string why_rectified(const EmgChannel& channel) {
  std::vector<double> sizes;
  double sum = 0.0;
  for (const double v : channel.volts)
    if (std::isfinite(v)) sizes.push_back(v), sum += v;
  if (sizes.size() < kFewestSamples) return {};
  const bool below = sum < 0.0;
  if (below)
    for (double& v : sizes) v = -v;
  const auto [least, most] = std::ranges::minmax(sizes);
  if (least < 0.0 || !(most > least)) return {};
  const double middle = math::median(sizes);
  const bool skewed = middle - least <= kSkewed * (most - middle);
  if (least > kNearZero * middle || !(skewed || roughness(sizes) < kSmooth)) return {};
  return below ? fmt::format(
                     "{} holds no value above zero: a rectified channel or an envelope with its sign "
                     "reversed; this needs the channel as it was amplified",
                     channel.name)
               : fmt::format(
                     "{} holds no value below zero: it was rectified or is an envelope; this needs the "
                     "channel as it was amplified",
                     channel.name);
}

std::string why_above_maximum(const std::string& name, const Eigen::VectorXd& envelope) {
  double sum = 0.0;
  std::int64_t count = 0;
  for (const double v : envelope)
    if (std::isfinite(v)) sum += v, ++count;
  if (count == 0 || !(sum > static_cast<double>(count))) return {};
  return fmt::format(
      "{}: the mean of the whole recording is {:.0f} % of the maximum: that is of another channel, gain or "
      "unit, or the muscle was not at its maximum there",
      name, 100.0 * sum / static_cast<double>(count));
}

}  // namespace kinemark::analysis
