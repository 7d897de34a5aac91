// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/internal/plot_points.h"

namespace kinemark::report::internal {

PlotPoints::PlotPoints(std::int64_t frames, std::int64_t max_points) : frames_(frames), size_(frames) {
  check(frames >= 0, "a plot needs a frame count of 0 or more");
  check(max_points >= 2, "a plot needs room for 2 points or more");
  if (frames <= max_points) return;
  const std::int64_t even = max_points / 2 * 2;
  step_ = (frames + even - 1) / even;
  size_ = (frames + 2 * step_ - 1) / (2 * step_) * 2;
}

std::vector<float> PlotPoints::extremes(std::span<const double> values) const {
  check(std::ssize(values) == frames_, "extremes() needs one value per frame");
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> out(static_cast<std::size_t>(size()), kNaN);
  if (step_ == 1) {
    std::transform(values.begin(), values.end(), out.begin(), [](double v) { return static_cast<float>(v); });
    return out;
  }
  for (std::size_t i = 0; i < out.size(); i += 2) {
    const std::int64_t begin = static_cast<std::int64_t>(i) * step_;
    const std::int64_t end = std::min(frames_, begin + 2 * step_);
    std::int64_t low = -1, high = -1;
    for (std::int64_t f = begin; f < end; ++f) {
      const double v = values[static_cast<std::size_t>(f)];
      if (std::isnan(v)) continue;
      if (low < 0 || v < values[static_cast<std::size_t>(low)]) low = f;
      if (high < 0 || v > values[static_cast<std::size_t>(high)]) high = f;
    }
    if (low < 0) continue;
    out[i] = static_cast<float>(values[static_cast<std::size_t>(std::min(low, high))]);
    out[i + 1] = static_cast<float>(values[static_cast<std::size_t>(std::max(low, high))]);
  }
  return out;
}

std::vector<float> PlotPoints::largest(std::span<const double> values) const {
  check(std::ssize(values) == frames_, "largest() needs one value per frame");
  std::vector<float> out(static_cast<std::size_t>(size()), std::numeric_limits<float>::quiet_NaN());
  const std::size_t group = step_ == 1 ? 1 : 2;
  for (std::size_t i = 0; i < out.size(); i += group) {
    const auto begin = static_cast<std::int64_t>(i) * step_;
    const std::int64_t end = std::min(frames_, begin + static_cast<std::int64_t>(group) * step_);
    double most = std::numeric_limits<double>::quiet_NaN();
    for (std::int64_t f = begin; f < end; ++f) most = std::fmax(most, values[static_cast<std::size_t>(f)]);
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(i), group, static_cast<float>(most));
  }
  return out;
}

std::vector<std::uint8_t> PlotPoints::worst(std::span<const std::uint8_t> codes) const {
  check(std::ssize(codes) == frames_, "worst() needs one code per frame");
  std::vector<std::uint8_t> out(static_cast<std::size_t>(size()), 0);
  for (std::size_t f = 0; f < codes.size(); ++f) {
    auto& code = out[f / static_cast<std::size_t>(step_)];
    code = std::max(code, codes[f]);
  }
  // The second point of the last pair may lie behind the last frame.
  if (size_ * step_ - frames_ >= step_) out[out.size() - 1] = out[out.size() - 2];
  return out;
}

std::vector<float> PlotPoints::extremes(std::span<const float> values) const {
  return extremes(std::vector<double>(values.begin(), values.end()));
}

std::vector<float> PlotPoints::largest(std::span<const float> values) const {
  return largest(std::vector<double>(values.begin(), values.end()));
}

}  // namespace kinemark::report::internal
