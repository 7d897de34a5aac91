// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/nwb.h"

namespace kinemark::io::internal {

/// The file's identity: its identifier, or all of its metadata.
[[nodiscard]] std::string identity_of(const NwbMetadata& metadata, const NwbOutline& outline);

/// Dates are ISO 8601 with a time zone, texts are UTF-8 without zero bytes, a sex is one that NWB knows.
[[nodiscard]] Status check_metadata(const NwbMetadata& metadata);

/// Write everything of a file but its samples and their tables; returns the processing module for those.
/// @param room  its path
Handle write_root(Output& out, const NwbMetadata& metadata, const NwbOutline& outline,
                  const std::string& room);

}  // namespace kinemark::io::internal
