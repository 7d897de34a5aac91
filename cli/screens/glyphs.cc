// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/glyphs.h"

#include <algorithm>
#include <array>

#include "kinemark/core/utf8.h"

namespace kinemark::screens {

std::u32string glyphs_of(std::string_view given) {
  const std::string text = printable(given);
  std::u32string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = std::max<std::size_t>(utf8_length(text, i), 1);
    const auto first = static_cast<unsigned char>(text[i]);
    char32_t code = length == 1 ? first : first & (0x7FU >> length);
    for (std::size_t k = 1; k < length; ++k)
      code = (code << 6U) | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    out.push_back(code);
    i += length;
  }
  return out;
}

void append_utf8(char32_t code, std::string& text) {
  if (code < 0x80) {
    text.push_back(static_cast<char>(code));
    return;
  }
  const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  const std::array<unsigned, 4> lead = {0, 0xC0, 0xE0, 0xF0};
  text.push_back(
      static_cast<char>(lead[static_cast<std::size_t>(more)] | (code >> (6U * static_cast<unsigned>(more)))));
  for (int k = more - 1; k >= 0; --k)
    text.push_back(static_cast<char>(0x80U | ((code >> (6U * static_cast<unsigned>(k))) & 0x3FU)));
}

}  // namespace kinemark::screens
