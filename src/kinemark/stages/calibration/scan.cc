// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/scan.h"

#include <fmt/core.h>

namespace kinemark::calibration {

Result<StillPoses> scan_observations(const data::Counts& counts, const data::Rig& rig,
                                     const ScanPositions& positions, const StillOptions& options) {
  constexpr Eigen::Index kFewest = 12, kMost = 100'000;
  if (auto s = counts.validate(); !s) return std::unexpected(s.error());
  if (auto s = data::check_same_rig(counts, rig); !s) return std::unexpected(s.error());
  if (counts.led_count() != 1)
    return fail(Code::bad_input,
                fmt::format("a scan has one LED; this recording has {}", counts.led_count()));
  const auto count = positions.x_in_stage.cols();
  if (count < kFewest || count > kMost || !positions.x_in_stage.allFinite())
    return fail(Code::bad_input, fmt::format("a scan of {} positions; {} to {} finite ones were expected",
                                             count, kFewest, kMost));
  if (positions.frames_per_position < 1 || counts.frames() > count * positions.frames_per_position)
    return fail(Code::bad_input, fmt::format("{} frames do not fit {} positions of {} frames",
                                             counts.frames(), count, positions.frames_per_position));
  const Eigen::Index visited = counts.frames() / positions.frames_per_position;
  if (visited < kFewest)
    return fail(Code::bad_input,
                fmt::format("{} frames hold {} whole positions of {} frames; {} or more were expected",
                            counts.frames(), visited, positions.frames_per_position, kFewest));
  StillPoses out{.tree = {},
                 .cameras = rig.camera_count(),
                 .observations = {},
                 .frames_left_over = counts.frames() % positions.frames_per_position};
  for (Eigen::Index position = 0; position < visited; ++position) {
    out.tree.emplace_back(positions.x_in_stage.col(position));
    for (int c = 0; c < out.cameras; ++c)
      out.observations.push_back(still_observation(
          counts, rig.electronics, {position * positions.frames_per_position, positions.frames_per_position},
          0, c, options));
  }
  return out;
}

Result<BundleResult> calibrate_scan(const data::Rig& nominal, const data::Counts& counts,
                                    const ScanPositions& positions, const BundleOptions& options,
                                    const Progress& progress) {
  const auto seen = scan_observations(counts, nominal, positions);
  if (!seen) return std::unexpected(seen.error());
  auto result = calibrate_bundle(nominal, *seen, {}, options, progress);
  if (result) result->rig.method = "scan";
  return result;
}

}  // namespace kinemark::calibration
