// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// Write what can be read of a recording as a new closed one; the original is only read.
///
/// Returns what was done: original, written, messages (kept), end (of the original: closed, open, cut,
/// damaged), bytes_left_out, damage (a list of offset, bytes, what) and warnings. Errors as
/// io::recover_recording().
[[nodiscard]] Result<nlohmann::ordered_json> recover_file(const std::filesystem::path& in,
                                                          const std::filesystem::path& out, bool force);

}  // namespace kinemark::pipeline
