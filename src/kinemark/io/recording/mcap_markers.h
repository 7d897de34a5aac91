// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/io/c3d/byte_source.h"

// MCAP files of other programs: positions in messages of JSON. docs/formats/mcap.md
namespace kinemark::io {

/// Whether a file that begins like this is MCAP, a recording of ours included.
[[nodiscard]] bool is_mcap(std::string_view begin);

/// Whether it is MCAP of another program: its header, which 512 bytes hold, names another profile than ours.
[[nodiscard]] bool is_mcap_of_others(std::string_view begin);

/// Read the positions in messages of JSON with the schemas foxglove.FrameTransform, FrameTransforms,
/// PoseInFrame, PosesInFrame, SceneUpdate (spheres, cubes, cylinders, models) and Point3; chunks of zstd and
/// lz4 too. Times are those in the messages, else the log's. The marker with most samples gives even frames
/// (find_clock()); those of others belong to the nearest frame. The first frame is at 0 s; frames without a
/// sample are missing. Of points in several coordinate frames those of the frame with most points are read.
/// What was left out stands among the warnings. A file that ends within a record is read up to there, with a
/// warning. A recording of ours is read as
/// read_markers_recording(). Code::not_supported for a file without such messages;
/// Code::bad_input, with the byte or the topic, for one that is damaged; Code::io when it cannot be read.
/// Memory: the largest chunk, of at most 64 MiB when unpacked, and what the samples need.
[[nodiscard]] Result<data::Trial> read_mcap_markers(const std::filesystem::path& path);

/// The same from any bytes; Code::not_supported for a recording of ours.
[[nodiscard]] Result<data::Trial> read_mcap_markers(const ByteSource& source);

}  // namespace kinemark::io
