// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/usable.h"

#include <algorithm>

#include "kinemark/math/statistics.h"

namespace kinemark::camera {

std::vector<std::uint8_t> usable_views(const data::Counts& counts, double dim_share) {
  constexpr std::uint8_t kDarkened = data::kCountOccluded | data::kCountLost;
  constexpr std::uint8_t kUnusable = data::kCountSaturated | kDarkened;
  constexpr double kDark = 60.0;  // counts of all four channels: reached by offsets and stray light alone
  std::vector<std::uint8_t> out(counts.flags.size(), 0);
  std::vector<double> light;
  for (std::int64_t led = 0; led < counts.led_count(); ++led)
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
      light.clear();
      for (std::int64_t f = 0; f < counts.frames(); ++f)
        if ((counts.flags[counts.index(f, led, c)] & kDarkened) == 0)
          light.push_back(counts.at(f, led, c).sum());
      if (light.empty()) continue;
      const double least = std::max(dim_share * math::upper_median(light), kDark);
      for (std::int64_t f = 0; f < counts.frames(); ++f) {
        const auto i = counts.index(f, led, c);
        out[i] = (counts.flags[i] & kUnusable) == 0 && counts.at(f, led, c).sum() > least;
      }
    }
  return out;
}

}  // namespace kinemark::camera
