// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/segmentation.h"

#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"

namespace kinemark::skeleton {
namespace {

constexpr std::size_t kMarkersListed = 8, kRivalsListed = 3;

std::string list_of(const std::vector<int>& which, const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const int m : which) out.push_back(names[at(m)]);
  return join_some(out, kMarkersListed);
}

std::string side_of(const std::string& segment, const std::vector<int>& which,
                    const std::vector<std::string>& names) {
  return segment.empty() ? fmt::format("[{}]", list_of(which, names))
                         : fmt::format("{} [{}]", segment, list_of(which, names));
}

}  // namespace

Status SegmentationOptions::check() const {
  for (const double v : {least_turn_rad, most_gap_m, most_spread_m, most_sd_m, most_distance_sd_m, skin_sd_m})
    if (!(v > 0.0) || !std::isfinite(v))
      return fail(Code::usage,
                  fmt::format("a bound of {} for segments from unnamed markers; need more than 0", v));
  if (!(least_weight >= 0.0) || !(least_weight <= 1.0) || !(most_rival_weight >= 0.0))
    return fail(Code::usage, fmt::format("weights of rivals {} and {}; need 0 to 1 and 0 or more",
                                         least_weight, most_rival_weight));
  return {};
}

std::string JudgedJoint::sentence(const std::vector<std::string>& markers) const {
  std::string out =
      fmt::format("Not determined: joint '{}' between {} and {}: {}", name,
                  side_of(parent_name, parent, markers), side_of(child_name, child, markers), reason);
  std::vector<std::string> others;
  for (const auto& rival : rivals) {
    if (others.size() == kRivalsListed) break;
    others.push_back(fmt::format("[{}] and [{}], {:.0f} mm away", list_of(rival.parent, markers),
                                 list_of(rival.child, markers), 1e3 * rival.distance_m));
  }
  if (!others.empty())
    out += fmt::format("; {}: {}", rivals.size() == 1 ? "a rival" : "rivals", join(others, "; "));
  return out + ".";
}

}  // namespace kinemark::skeleton
