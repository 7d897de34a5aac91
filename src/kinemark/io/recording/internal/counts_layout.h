// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Description of counts in the metadata of the channel that carries them.
#pragma once

#include <cstddef>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/io/recording/recording.h"

namespace kinemark::io::internal {

/// The channel /counts for counts like these.
[[nodiscard]] RecordingChannel channel_of(const data::Counts& like);
[[nodiscard]] bool is_counts(const RecordingChannel& channel);

/// Counts without frames as the channel describes them, or what is wrong with its description.
[[nodiscard]] Result<data::Counts> counts_like(const RecordingChannel& channel);

/// Bytes of one frame's message.
[[nodiscard]] std::size_t frame_bytes(const data::Counts& like);

/// The time that log time 0 stands for: 0, or the first frame's when that is earlier.
[[nodiscard]] double epoch_s_of(const data::Counts& like);

}  // namespace kinemark::io::internal
