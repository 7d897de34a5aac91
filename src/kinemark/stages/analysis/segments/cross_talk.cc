// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/cross_talk.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kinemark::analysis {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::int64_t kFewest = 10;

}  // namespace

bool CrossTalk::follows() const { return correlation * correlation >= 0.5; }

bool CrossTalk::suspicious() const { return follows() && std::abs(carried_rad) >= 5.0 * kDegree; }

std::string CrossTalk::sentence(const std::string& name) const {
  const auto figures =
      fmt::format("r^2 = {:.2f}, {:.1f} deg over {:.0f} deg of flexion", correlation * correlation,
                  std::abs(carried_rad) / kDegree, flexion_rad / kDegree);
  if (suspicious())
    return fmt::format("{}: varus follows flexion ({}): the knee's axis is probably turned.", name, figures);
  if (follows()) return fmt::format("{}: varus follows flexion, by less than 5 deg ({}).", name, figures);
  return fmt::format("{}: varus does not follow flexion ({}).", name, figures);
}

std::optional<CrossTalk> find_cross_talk(const SegmentSeries& knee) {
  const auto n = knee.size();
  double sum_x = 0.0, sum_y = 0.0, low = std::numeric_limits<double>::infinity(), high = -low;
  CrossTalk out;
  const auto each = [&](auto&& take) {
    for (std::size_t i = 0; n >= 2 && i + n <= knee.value.size(); i += n)
      if (std::isfinite(knee.value[i]) && std::isfinite(knee.value[i + 1]))
        take(knee.value[i], knee.value[i + 1]);
  };
  each([&](double x, double y) {
    sum_x += x;
    sum_y += y;
    low = std::min(low, x);
    high = std::max(high, x);
    ++out.frames;
  });
  if (out.frames < kFewest || high - low < 20.0 * kDegree) return std::nullopt;
  const auto frames = static_cast<double>(out.frames);
  double xx = 0.0, xy = 0.0, yy = 0.0;
  each([&](double x, double y) {
    const double dx = x - sum_x / frames, dy = y - sum_y / frames;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  });
  out.flexion_rad = high - low;
  out.correlation = yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
  out.carried_rad = xy / xx * out.flexion_rad;
  return out;
}

}  // namespace kinemark::analysis
