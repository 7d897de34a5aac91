// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Selects the usable sightings of a recording.
#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "kinemark/math/statistics.h"
#include "kinemark/stages/reconstruction/reconstruct.h"

namespace kinemark::reconstruction {

Status check_fit(const data::Counts& counts, const data::Rig& rig) {
  if (auto s = counts.validate(); !s) return s;
  if (auto s = rig.validate(); !s) return s;
  if (!counts.rig_id.empty() && !rig.id.empty() && counts.rig_id != rig.id)
    return fail(Code::bad_input,
                fmt::format("the recording was made with rig '{}', this rig is '{}'", counts.rig_id, rig.id));
  if (counts.camera_count() != rig.camera_count())
    return fail(Code::bad_input,
                fmt::format("the recording has {} cameras and the rig {}; they must be the same",
                            counts.camera_count(), rig.camera_count()));
  if (rig.camera_count() < 2) return fail(Code::bad_input, "points need two cameras or more");
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    if (rig.cameras[c].kind != data::CameraKind::lateral_effect)
      return fail(Code::not_supported,
                  fmt::format("camera '{}' is no lateral-effect camera", rig.cameras[c].name));
    if (rig.cameras[c].name != counts.cameras[c])
      return fail(Code::bad_input, fmt::format("camera {} is '{}' in the recording and '{}' in the rig",
                                               c + 1, counts.cameras[c], rig.cameras[c].name));
  }
  return {};
}

Result<Array<std::uint8_t>> usable_sightings(const data::Counts& counts, double dim_share) {
  constexpr std::uint8_t kUnusable = data::kCountSaturated | data::kCountOccluded | data::kCountLost;
  constexpr double kDark = 60.0;  // counts of all four channels: reached by offsets and stray light alone
  Array<std::uint8_t> out(counts.flags.size(), 0);
  std::vector<std::int64_t> of_camera(counts.cameras.size(), 0);
  std::vector<double> light;
  for (std::int64_t led = 0; led < counts.led_count(); ++led)
    for (std::int64_t c = 0; c < counts.camera_count(); ++c) {
      light.clear();
      for (std::int64_t f = 0; f < counts.frames(); ++f)
        if ((counts.flags[counts.index(f, led, c)] & (data::kCountOccluded | data::kCountLost)) == 0)
          light.push_back(counts.at(f, led, c).sum());
      if (light.empty()) continue;
      const double least = std::max(dim_share * math::upper_median(light), kDark);
      for (std::int64_t f = 0; f < counts.frames(); ++f) {
        const auto i = counts.index(f, led, c);
        out[i] = (counts.flags[i] & kUnusable) == 0 && counts.at(f, led, c).sum() > least;
        of_camera[static_cast<std::size_t>(c)] += out[i];
      }
    }
  if (std::ranges::all_of(of_camera, [](std::int64_t n) { return n == 0; }))
    return fail(Code::bad_input, "all LEDs are dark: no camera saw light in any frame");
  for (std::size_t c = 0; c < of_camera.size(); ++c)
    if (of_camera[c] == 0 && counts.camera_count() == 2)
      return fail(
          Code::bad_input,
          fmt::format("camera '{}' saw no light in any frame; points need two cameras", counts.cameras[c]));
  return out;
}

}  // namespace kinemark::reconstruction
