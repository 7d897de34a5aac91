// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Selects the usable observations of a recording.
#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "kinemark/camera/usable.h"
#include "kinemark/stages/reconstruction/reconstruct.h"

namespace kinemark::reconstruction {

Status check_fit(const data::Counts& counts, const data::Rig& rig) {
  if (auto s = counts.validate(); !s) return s;
  if (auto s = rig.validate(); !s) return s;
  if (auto s = data::check_same_rig(counts, rig); !s) return s;
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

Result<Array<std::uint8_t>> usable_observations(const data::Counts& counts, double dim_share) {
  const auto views = camera::usable_views(counts, dim_share);
  Array<std::uint8_t> out(views.begin(), views.end());
  std::vector<std::int64_t> of_camera(counts.cameras.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) of_camera[i % of_camera.size()] += out[i];
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
