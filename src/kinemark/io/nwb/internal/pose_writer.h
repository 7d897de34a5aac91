// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers as a pose of the extension ndx-pose, beside Position and sharing its numbers. docs/formats/nwb.md
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/metadata.h"

namespace kinemark::io::internal {

/// The series of a marker, whose times are still to be written, and its confidence, a number a frame.
struct PoseSeries {
  Handle series, confidence;
};

/// Write a skeleton of the markers and a PoseEstimation of them, the data linked to those of Position.
/// @param room          path of the module
/// @param series_names  of the markers, as Position has them
[[nodiscard]] std::vector<PoseSeries> write_pose(Output& out, hid_t module, const std::string& room,
                                                 const NwbMetadata& metadata,
                                                 const std::vector<std::string>& series_names,
                                                 std::int64_t frames, int compression);

/// What ndx-pose says of a sample: 1 measured, 0.5 made from measured ones, 0 not there.
[[nodiscard]] float confidence_of(data::SampleState state);

}  // namespace kinemark::io::internal
