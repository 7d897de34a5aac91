// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/scan.h"

#include <fmt/core.h>

namespace kinemark::calibration {

Result<StillPoses> scan_sightings(const data::Counts& counts, const data::Rig& rig, const ScanPlaces& places,
                                  const StillOptions& options) {
  constexpr Eigen::Index kFewest = 12, kMost = 100'000;
  if (auto s = counts.validate(); !s) return std::unexpected(s.error());
  if (counts.camera_count() != rig.camera_count())
    return fail(Code::bad_input,
                fmt::format("the recording has {} cameras and the rig {}; they must be the same",
                            counts.camera_count(), rig.camera_count()));
  if (!counts.rig_id.empty() && !rig.id.empty() && counts.rig_id != rig.id)
    return fail(Code::bad_input,
                fmt::format("the scan was recorded with rig '{}', this rig is '{}'", counts.rig_id, rig.id));
  if (counts.led_count() != 1)
    return fail(Code::bad_input,
                fmt::format("a scan has one LED; this recording has {}", counts.led_count()));
  const auto count = places.x_in_stage.cols();
  if (count < kFewest || count > kMost || !places.x_in_stage.allFinite())
    return fail(Code::bad_input, fmt::format("a scan of {} positions; {} to {} finite ones were expected",
                                             count, kFewest, kMost));
  if (places.frames_per_place < 1 || counts.frames() != count * places.frames_per_place)
    return fail(Code::bad_input, fmt::format("{} frames do not fit {} positions of {} frames",
                                             counts.frames(), count, places.frames_per_place));
  StillPoses out{.tree = {}, .cameras = rig.camera_count(), .sightings = {}};
  for (Eigen::Index place = 0; place < count; ++place) {
    out.tree.emplace_back(places.x_in_stage.col(place));
    for (int c = 0; c < out.cameras; ++c)
      out.sightings.push_back(still_sighting(counts, rig.electronics,
                                             {place * places.frames_per_place, places.frames_per_place}, 0, c,
                                             options));
  }
  return out;
}

Result<BundleResult> calibrate_scan(const data::Rig& nominal, const data::Counts& counts,
                                    const ScanPlaces& places, const BundleOptions& options,
                                    const Progress& progress) {
  const auto seen = scan_sightings(counts, nominal, places);
  if (!seen) return std::unexpected(seen.error());
  auto result = calibrate_bundle(nominal, *seen, {}, options, progress);
  if (result) result->rig.method = "scan";
  return result;
}

}  // namespace kinemark::calibration
