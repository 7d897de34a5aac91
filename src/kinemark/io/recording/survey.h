// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/reader.h"

namespace kinemark::io {

/// The clock of a channel that does not fit its message numbers.
struct ClockJump {
  std::uint16_t channel = 0;   ///< index of the channel
  std::uint32_t sequence = 0;  ///< of the message after the jump
  double time_s = 0.0;         ///< its log time
  double jump_s = 0.0;         ///< negative: backwards
};

/// What one channel holds.
struct ChannelSurvey {
  std::int64_t messages = 0;                     ///< that can be read
  std::int64_t bytes = 0;                        ///< of their data
  std::int64_t lost = 0;                         ///< numbers that were stepped over
  std::int64_t out_of_order = 0;                 ///< numbers that repeat or go back
  std::int64_t clock_jumps = 0;                  ///< number of jumps
  double first_time_s = 0.0, last_time_s = 0.0;  ///< earliest and latest log time
};

/// Contents and irregularities of a recording.
struct RecordingSurvey {
  std::uint64_t bytes = 0;                  ///< bytes of the file
  std::int64_t messages = 0;                ///< of all channels
  std::vector<RecordingChannel> channels;   ///< in the order of the file
  std::vector<ChannelSurvey> per_channel;   ///< as channels
  std::vector<RecordingMetadata> metadata;  ///< in the order of the file
  RecordingEnd end = RecordingEnd::open;    ///< how the file ends
  std::vector<RecordingDamage> damage;      ///< pieces that cannot be read
  std::vector<ClockJump> clock_jumps;       ///< the first hundred
  std::vector<std::string> warnings;        ///< all irregularities, one sentence each
};

/// Reads the whole file, past damage where it can, and keeps no message. Errors as RecordingReader::open().
/// About 0.5 GB/s.
[[nodiscard]] Result<RecordingSurvey> survey_recording(const std::filesystem::path& path);
/// The same of a recording that is open already and of which nothing was read.
[[nodiscard]] Result<RecordingSurvey> survey_recording(RecordingReader reader);

/// Sentences on how a recording ended and what was left out, once it has been read to its end; empty when all
/// is well.
[[nodiscard]] std::vector<std::string> describe_end(const RecordingReader& reader);

}  // namespace kinemark::io
