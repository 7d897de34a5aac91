// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/consistency/motion_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMostTurn_rad = 10.0 * kDegree, kMostWay_m = 0.03, kMostShare = 0.05;
constexpr double kUnlimited = 1e29;
constexpr std::int64_t kFewestFrames = 3, kOneIn = 20;
constexpr std::size_t kMostSentences = 5;

/// 1 for coordinates of joints that let a body go through space.
std::vector<char> are_free(const data::ModelDescription& model) {
  std::vector<char> out(model.coordinates.size(), 0);
  for (const auto& joint : model.joints) {
    const auto translates = [](const data::AxisDescription& axis) {
      return !axis.is_rotation && axis.coordinate_idx >= 0;
    };
    if (joint.parent_body_idx != data::kGround || std::ranges::none_of(joint.axes, translates)) continue;
    for (const auto& axis : joint.axes)
      if (axis.coordinate_idx >= 0) out[at(axis.coordinate_idx)] = 1;
  }
  return out;
}

struct Excess {
  double most = 0.0;  ///< beyond the nearer end, above 0 beyond the upper one
  std::int64_t frames = 0, at = 0;
};

Excess excess_of(const data::CoordinateDescription& limits, const data::JointMotion& motion,
                 std::int64_t column) {
  Excess out;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    if (!motion.determined.empty() && motion.determined[motion.index(f, column)] == 0) continue;
    const double q = motion.q[motion.index(f, column)];
    const double beyond = q > limits.range_max   ? q - limits.range_max
                          : q < limits.range_min ? q - limits.range_min
                                                 : 0.0;
    out.frames += std::abs(beyond) > 0.0;
    if (std::abs(beyond) > std::abs(out.most)) out.most = beyond, out.at = f;
  }
  return out;
}

bool counts(const Excess& excess, const data::CoordinateDescription& limits, std::int64_t frames) {
  const double least = limits.is_rotation ? kMostTurn_rad : kMostWay_m;
  return std::abs(excess.most) > std::max(least, kMostShare * (limits.range_max - limits.range_min)) &&
         excess.frames >= kFewestFrames && kOneIn * excess.frames >= frames;
}

}  // namespace

std::vector<std::string> coordinates_out_of_range(const data::ModelDescription& model,
                                                  const data::JointMotion& motion) {
  std::vector<std::string> out;
  std::size_t others = 0;
  const auto free = are_free(model);
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    const auto found = model.find_coordinate(motion.coordinates[at(c)]);
    if (found < 0 || free[at(found)] != 0) continue;
    const auto& limits = model.coordinates[at(found)];
    if (limits.held() || limits.range_min < -kUnlimited || limits.range_max > kUnlimited ||
        !(limits.range_max > limits.range_min))
      continue;
    const auto excess = excess_of(limits, motion, c);
    if (!counts(excess, limits, motion.frames())) continue;
    if (out.size() == kMostSentences) {
      ++others;
      continue;
    }
    const double unit = limits.is_rotation ? 1.0 / kDegree : 1e3;
    const char* const word = limits.is_rotation ? "deg" : "mm";
    out.push_back(fmt::format(
        "'{}' lies up to {:.0f} {} {} its range in the model, {:.4g} to {:.4g} {}{}, in {} of {} frames, "
        "farthest at {:.3f} s",
        limits.name, unit * std::abs(excess.most), word, excess.most > 0.0 ? "above" : "below",
        unit * limits.range_min, unit * limits.range_max, word, limits.clamped ? " (clamped)" : "",
        excess.frames, motion.frames(), motion.time.time_s(excess.at)));
  }
  if (others > 0)
    out.push_back(fmt::format("{} more coordinates leave their range in the model as far", others));
  return out;
}

}  // namespace kinemark::analysis
