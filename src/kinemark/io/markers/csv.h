// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

namespace kinemark::io {

/// Write the markers of a trial as comma-separated values (RFC 4180): one header line
///   frame,time_s,<marker>.x,<marker>.y,<marker>.z,<marker>.state,...
/// and one line per frame, metres, the shortest numbers that read back exactly. Coordinates of missing and
/// rejected samples are empty; the state column tells which ("measured", "missing", "interpolated", ...).
/// Code::bad_input when the trial is invalid; Code::io as OutputFile.
[[nodiscard]] Status write_csv(const std::filesystem::path& path, const data::Trial& trial, bool force);

}  // namespace kinemark::io
