// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Frames as a rig writes them, from docs/formats/serial-rig.md and nothing of the decoder's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinemark::stream::testing {

using Bytes = std::vector<std::uint8_t>;

/// A frame of S slots and C cameras; counts S x C x 4, each below 1024.
Bytes frame_bytes(int slots, int cameras, std::uint32_t sequence, std::uint32_t dropped,
                  std::span<const std::int16_t> counts);
/// Counts that tell frame and place: no two neighbours are alike.
std::vector<std::int16_t> telling_counts(int slots, int cameras, std::uint32_t sequence);
/// frame_bytes() of telling_counts()
Bytes telling_frame(int slots, int cameras, std::uint32_t sequence, std::uint32_t dropped = 0);

}  // namespace kinemark::stream::testing
