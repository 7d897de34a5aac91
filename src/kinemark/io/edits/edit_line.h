// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One operation as a line of a journal: a JSON object, and the checksum of what stands before it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"

namespace kinemark::io {

/// The operation as JSON on one line, without checksum and newline: what its kind has no use for, and what is
/// empty, is left out. It passes its check().
[[nodiscard]] std::string format_edit(const data::Edit& edit);

/// The operation of a JSON object, with its checksum or without. Code::bad_input, one sentence: no JSON, a
/// key that its kind does not have, a value of another type, a wrong checksum, or what Edit::check() says.
[[nodiscard]] Result<data::Edit> parse_edit(std::string_view line);

/// The first line of a journal, likewise.
[[nodiscard]] std::string format_recording(const data::EditedRecording& recording);
/// The recording that a journal's first line names; fails as parse_edit().
[[nodiscard]] Result<data::EditedRecording> parse_recording(std::string_view line);

/// A JSON object with its checksum as the last value: XXH3-64 of the object as it was.
[[nodiscard]] std::string with_sum(std::string_view object);

/// Checksum of what operations do: neither ids nor who made them and when count. Of operations in force it
/// tells whether two lists come to the same. 16 lower-case digits.
[[nodiscard]] std::string digest_of(std::span<const data::Edit> edits);

}  // namespace kinemark::io
