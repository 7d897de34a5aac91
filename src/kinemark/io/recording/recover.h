// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/reader.h"

namespace kinemark::io {

/// What recover_recording() kept and what not.
struct RecoverReport {
  std::int64_t messages = 0;                ///< kept
  std::uint64_t bytes_left_out = 0;         ///< of the original
  RecordingEnd end = RecordingEnd::closed;  ///< how the original ended
  std::vector<RecordingDamage> damage;      ///< pieces that were left out
  std::vector<std::string> warnings;        ///< irregularities of the original, one sentence each
};

/// Write everything that can be read of a recording, past damage too, as a new closed recording with summary
/// and index; the original is only read. A closed, undamaged recording gives the same messages again, any
/// other also metadata "kinemark.recovered" that lists what was left out. The new file appears whole or not
/// at all. Errors as RecordingReader::open(); Code::usage when both are one file; Code::io when `out` exists
/// (unless `force`) or cannot be written.
[[nodiscard]] Result<RecoverReport> recover_recording(const std::filesystem::path& in,
                                                      const std::filesystem::path& out, bool force);

}  // namespace kinemark::io
