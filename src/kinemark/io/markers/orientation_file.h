// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Orientations of sensors, segments and rigid bodies, whatever file they come in.
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/orientations.h"

namespace kinemark::io {

/// Whether a file holds orientations that read_orientation_file() reads, beside markers or alone. False also
/// for a file that cannot be read: its own reader says why.
[[nodiscard]] bool has_orientations(const std::filesystem::path& path);

/// Read them, world_from_sensor:
///
/// | ending | from |
/// |---|---|
/// | .sto, .mot | OpenSense, DataType=Quaternion |
/// | .c3d | the ROTATION group of Theia and Visual3D |
/// | .tsv | rigid bodies of QTM, 6D |
/// | .csv | rigid bodies and bones of Motive, as quaternions; tables of quaternions |
///
/// Code::not_supported, with this list, for other endings and for tables without orientations; else as the
/// reader of the format.
[[nodiscard]] Result<data::Orientations> read_orientation_file(const std::filesystem::path& path);

}  // namespace kinemark::io
