// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Read a marker file, C3D, TRC, NWB or CSV, in metres. The content decides which (a C3D has 0x50 in its
/// second byte, a TRC begins with PathFileType, an NWB file with the signature of HDF5); the extension
/// decides where the content does not tell, so that a broken file gets its format's own sentence. Of an NWB
/// file a trial holds positions with their provenance; read_nwb() gives the rest. Code::not_supported for any
/// other file, naming what is supported; else as read_c3d(), read_trc(), read_nwb() and
/// read_trajectories_csv().
[[nodiscard]] Result<data::Trial> read_markers(const std::filesystem::path& path);

/// Write a trial in the format of the extension: .c3d, .trc (millimetres), .nwb (positions with their
/// provenance; write_nwb() takes more) or .csv (write_trajectories_csv()). Code::usage for any other; else as
/// the writer of that format. An existing file is replaced only with `force`.
[[nodiscard]] Status write_markers(const std::filesystem::path& path, const data::Trial& trial, bool force);

}  // namespace kinemark::io
