// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Description of counts in the metadata of the channel that carries them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

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

/// A frame's message into its place: counts L x C x 4, dark C x 4, flags L x C. Observations with a count
/// that the converter cannot give are flagged lost; how many there are.
/// @param data  frame_bytes() long
[[nodiscard]] int decode_frame(std::span<const std::byte> data, const data::Counts& like,
                               std::int16_t* counts, std::int16_t* dark, std::uint8_t* flags);

/// The time that log time 0 stands for: 0, or the first frame's when that is earlier.
[[nodiscard]] double epoch_s_of(const data::Counts& like);

}  // namespace kinemark::io::internal
