// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"

// XDF, what LabRecorder writes of streams of the lab streaming layer. docs/formats/xdf.md
namespace kinemark::io {

/// Whether a file that begins like this is XDF.
[[nodiscard]] bool is_xdf(std::string_view begin);

/// Read the stream with most positions (channels PositionX, PositionY, PositionZ of a marker). Its times are
/// corrected by the clock offsets and put on even frames, of the stated rate where that is right to half a
/// frame over the recording, else of the one found; frames that the stream dropped are missing. The first
/// frame is at 0 s; strings of other streams are events. What was corrected or left out stands among the
/// warnings. Code::not_supported for a file without positions; Code::bad_input, with the byte, for one that
/// is damaged (a file that ends in the middle of a chunk is read up to there); Code::io when it cannot be
/// read. Memory: the file and 8 bytes for each position.
[[nodiscard]] Result<data::Trial> read_xdf(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages and in Trial::source.
[[nodiscard]] Result<data::Trial> parse_xdf(std::span<const std::byte> bytes, std::string_view name);

}  // namespace kinemark::io
