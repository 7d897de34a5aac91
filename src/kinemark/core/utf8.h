// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Bytes of files and names of files as text that JSON, pages and terminals take.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinemark {

/// Bytes of the UTF-8 character that begins at text[i], 1 to 4; 0 where none does: a stray byte, an overlong
/// form, a surrogate, a number beyond the last code point.
[[nodiscard]] std::size_t utf8_length(std::string_view text, std::size_t i);

/// Whether all of it is UTF-8. O(bytes).
[[nodiscard]] bool is_utf8(std::string_view text);

/// UTF-8 as it is; anything else read as ISO-8859-1, byte by byte.
[[nodiscard]] std::string to_utf8(std::string_view bytes);

/// A name as files hold them: to_utf8(), control characters as blanks, none of these at its ends. May be
/// empty.
[[nodiscard]] std::string name_of_bytes(std::string_view bytes);

/// For people, on one line and safe on a terminal: bytes that are no UTF-8, control characters and those that
/// are not seen (marks of the direction of writing, soft hyphens) become U+FFFD; of more than `most`
/// characters (at least 8) the middle becomes "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = std::string_view::npos);

/// A sentence for people: printable(), words of more than 300 characters and sentences of more than 4000
/// shortened.
[[nodiscard]] std::string printable_sentence(std::string_view text);

}  // namespace kinemark
