// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Lists of frames: in words, whose pattern is computed from them, and as the text that edits hold.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::data {

/// Frames, in order, by their numbers: "frame 7", "frames 7 to 9", "every third frame from 1 to 127" where
/// all lie equally far apart (three frames at least), "nearly every third frame from 1 to 122" where four in
/// five do, else "frames 3, 8 to 14, 20 and 3 more spans". Empty for none.
[[nodiscard]] std::string words_of_frames(std::span<const std::int64_t> frames, const TimeBase& time);

/// Frame numbers, in order, as short text: "1,4,19-20", and "1-127/3" for every third from 1 to 127.
[[nodiscard]] std::string format_frame_list(std::span<const std::int64_t> frames);
/// The frame numbers of such a text, in order, at most `most`. Code::bad_input, one sentence: what is no
/// list, is not in order, or is longer.
[[nodiscard]] Result<std::vector<std::int64_t>> parse_frame_list(std::string_view text,
                                                                 std::size_t most = 10'000'000);

}  // namespace kinemark::data
