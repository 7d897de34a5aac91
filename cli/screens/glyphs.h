// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Code points of Unicode to and from UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace kinemark::screens {

/// Its bytes at the end of a text.
void append_utf8(char32_t code, std::string& text);
/// Code points of a text that is safe on a terminal; see printable().
[[nodiscard]] std::u32string glyphs_of(std::string_view text);

}  // namespace kinemark::screens
