// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The ROTATION group of a C3D file: orientations of segments, as Theia and Visual3D write them.
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"
#include "kinemark/io/c3d/byte_source.h"
#include "kinemark/io/c3d/reader.h"

namespace kinemark::io {

/// Read the rotations: 17 numbers each, a 4 x 4 matrix column by column (world_from_segment) and how far it
/// can be trusted; negative or not a number: missing. "_4X4" behind a label goes. Positions of the segments
/// are not taken. Rates other than that of the points are those of ROTATION:RATIO.
///
/// Code::bad_input where the file has none, states no labels or start, or the data end before they should, or
/// a matrix turns nothing (columns that are not of length 1 and at right angles, to a hundredth).
[[nodiscard]] Result<data::Orientations> read_c3d_rotations(const std::filesystem::path& path);

/// The same of a file that is open. @param source  of the bytes that `reader` was opened with
[[nodiscard]] Result<data::Orientations> read_rotations(const C3dReader& reader, const ByteSource& source);

}  // namespace kinemark::io
