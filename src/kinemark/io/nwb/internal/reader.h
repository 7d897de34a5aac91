// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/io/nwb/internal/input.h"
#include "kinemark/io/nwb/nwb.h"

namespace kinemark::io::internal {

/// read_nwb() of a file that is open.
[[nodiscard]] Result<NwbFile> read_nwb(Input& in);

/// The metadata of a file: dates, subject, and the tables of provenance and sources.
[[nodiscard]] NwbMetadata read_metadata(Input& in);

}  // namespace kinemark::io::internal
