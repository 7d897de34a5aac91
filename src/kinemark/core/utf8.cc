// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/utf8.h"

#include <algorithm>

namespace kinemark {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
constexpr std::size_t kMostOfWord = 300;
constexpr std::size_t kMostOfSentence = 4000;

/// Number of the character of so many bytes at text[i].
char32_t code_point(std::string_view text, std::size_t i, std::size_t length) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[i + k]); };
  if (length == 1) return byte(0);
  char32_t code = byte(0) & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) code = code << 6U | (byte(k) & 0x3FU);
  return code;
}

/// C0, delete, C1.
bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

/// Characters that are not seen themselves: those that direct writing, line and paragraph separators, soft
/// hyphens, spaces without width, tags. The two joiners are left, as words of some languages need them.
bool is_layout(char32_t code) {
  return code == 0xAD || code == 0x61C || code == 0x180E || code == 0x200B ||
         (code >= 0x200E && code <= 0x200F) || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2060 && code <= 0x206F) || code == 0xFEFF || (code >= 0xFFF9 && code <= 0xFFFB) ||
         (code >= 0xE0001 && code <= 0xE007F);
}

void append_latin1(std::string& out, unsigned char byte) {
  if (byte < 0x80) {
    out += static_cast<char>(byte);
  } else {
    out += static_cast<char>(0xC0U | byte >> 6U);
    out += static_cast<char>(0x80U | (byte & 0x3FU));
  }
}

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// UTF-8 of at most `most` characters.
std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  const auto count =
      static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return !is_continuation(c); }));
  if (count <= most) return text;
  const std::size_t tail = (most - 3) / 2, head = most - 3 - tail;
  std::size_t head_bytes = 0, tail_begin = text.size();
  for (std::size_t seen = 0; seen <= head; ++head_bytes)
    if (!is_continuation(text[head_bytes]) && ++seen > head) break;
  for (std::size_t seen = 0; seen < tail;)
    if (!is_continuation(text[--tail_begin])) ++seen;
  return text.substr(0, head_bytes) + "..." + text.substr(tail_begin);
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned lead = byte(i);
  const std::size_t n = lead < 0x80                   ? 1
                        : lead >= 0xC2 && lead < 0xE0 ? 2
                        : lead >= 0xE0 && lead < 0xF0 ? 3
                        : lead >= 0xF0 && lead < 0xF5 ? 4
                                                      : 0;
  for (std::size_t k = 1; k < n; ++k)
    if ((byte(i + k) & 0xC0U) != 0x80U) return 0;
  // Overlong forms, surrogates and numbers past the last code point.
  const unsigned second = byte(i + 1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second >= 0xA0) ||
      (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second >= 0x90))
    return 0;
  return n;
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t n = utf8_length(text, i);
    if (n == 0) return false;
    i += n;
  }
  return true;
}

std::string to_utf8(std::string_view bytes) {
  if (is_utf8(bytes)) return std::string(bytes);
  std::string out;
  out.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) append_latin1(out, static_cast<unsigned char>(c));
  return out;
}

std::string name_of_bytes(std::string_view bytes) {
  const std::string text = to_utf8(bytes);
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t n = utf8_length(text, i);
    if (is_control(code_point(text, i, n)))
      out += ' ';
    else
      out.append(text, i, n);
    i += n;
  }
  const std::size_t first = out.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return out.substr(first, out.find_last_not_of(' ') - first + 1);
}

std::string printable(std::string_view text, std::size_t most) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t n = utf8_length(text, i);
    const char32_t code = n == 0 ? 0 : code_point(text, i, n);
    if (is_control(code) || is_layout(code))
      out += kReplacement;
    else
      out += text.substr(i, n);
    i += std::max<std::size_t>(n, 1);
  }
  return shortened(out, std::max<std::size_t>(most, 8));
}

std::string printable_sentence(std::string_view text) {
  std::string out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (begin > 0) out += ' ';
    out += printable(text.substr(begin, end - begin), kMostOfWord);
    begin = end + 1;
  }
  return shortened(out, kMostOfSentence);
}

}  // namespace kinemark
