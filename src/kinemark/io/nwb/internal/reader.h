// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/nwb.h"

namespace kinemark::io::internal {

/// read_nwb() of a file that is open.
[[nodiscard]] Result<NwbFile> read_nwb(Input& in);

/// read_nwb() in this process: for files that cannot hurt, for tests, and for the program that reads for
/// others.
[[nodiscard]] Result<NwbFile> read_nwb_here(const std::filesystem::path& path);

/// The metadata of a file: dates, subject, and the tables of provenance and sources.
[[nodiscard]] NwbMetadata read_metadata(Input& in);

}  // namespace kinemark::io::internal
