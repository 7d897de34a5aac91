// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/internal/words.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io::animation {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Takes the first line with its end.
std::string_view take_line(std::string_view& text) {
  const auto end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(text.substr(end).starts_with("\r\n") ? end + 2 : std::min(end + 1, text.size()));
  return line;
}

std::string_view without_blanks(std::string_view line) {
  const auto first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

TextLines::TextLines(std::string_view text) : text_(text) {
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

bool TextLines::next(std::string_view& line) {
  while (!text_.empty()) {
    line = without_blanks(take_line(text_));
    ++number_;
    if (!line.empty()) return true;
  }
  return false;
}

std::string_view TextLines::peek() const {
  TextLines ahead = *this;
  std::string_view line;
  return ahead.next(line) ? line : std::string_view{};
}

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const auto end = std::min(line.find_first_of(kBlanks), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

std::string in_lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

std::string in_quotes(std::string_view text) { return "'" + printable(text, 40) + "'"; }

std::unexpected<Error> fail_in_line(std::int64_t number, const std::string& what) {
  return fail(Code::bad_input, fmt::format("line {}: {}", number, what));
}

Result<double> take_number(std::string_view& line, std::int64_t number, std::string_view what) {
  const std::string_view word = take_word(line);
  const auto value = parse_number(word);
  if (!value || !std::isfinite(*value))
    return fail_in_line(number, word.empty()
                                    ? fmt::format("ends before {}", what)
                                    : fmt::format("{} is {}; expected a number", what, in_quotes(word)));
  return *value;
}

}  // namespace kinemark::io::animation
