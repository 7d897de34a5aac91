// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/reader.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// What `kinemark recover` is asked to do.
struct RecoverJob : JobSettings {
  std::filesystem::path in;   ///< recording (.mcap) that was cut, damaged or never closed
  std::filesystem::path out;  ///< recording to write
};

/// What `kinemark recover` kept and what not.
struct RecoverOutcome : JobOutcome {
  std::filesystem::path original;                   ///< as asked
  std::int64_t messages = 0;                        ///< kept
  io::RecordingEnd end = io::RecordingEnd::closed;  ///< of the original
  std::uint64_t bytes_left_out = 0;                 ///< the gate "bytes_left_out": 0
  std::vector<io::RecordingDamage> damage;          ///< pieces that were left out
};

/// Write what can be read of a recording as a new closed one; the original is only read. Fails as
/// io::recover_recording().
[[nodiscard]] Result<RecoverOutcome> run_recover(const RecoverJob& job);

}  // namespace kinemark::pipeline
