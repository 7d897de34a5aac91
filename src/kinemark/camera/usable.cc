// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/usable.h"

#include <algorithm>

#include "kinemark/math/statistics.h"

namespace kinemark::camera {

std::vector<std::uint8_t> usable_views(const data::Counts& counts, double dim_share) {
  constexpr std::uint8_t kDarkened = data::kCountOccluded | data::kCountLost;
  constexpr double kFewestKept = 3.0;  // channels below the highest code: what a point needs
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
        const Eigen::Vector4d read = counts.at(f, led, c);
        const double kept = kept_channels(read, counts.highest_code).sum();
        const bool saturated = (counts.flags[i] & data::kCountSaturated) != 0;
        out[i] = (counts.flags[i] & kDarkened) == 0 && read.sum() > least &&
                 (saturated ? kept == kFewestKept : kept > kFewestKept);
      }
    }
  return out;
}

}  // namespace kinemark::camera
