// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/number_cell.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "kinemark/core/number.h"

namespace kinemark::io {
namespace {

/// Digits in groups of three: "1,234" of `group` ','; no group begins with a zero.
bool is_grouped(std::string_view digits, char group) {
  if (digits.empty() || digits.front() == '0') return false;
  std::size_t first = digits.find(group);
  if (first == std::string_view::npos || first == 0 || first > 3) return false;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const bool separates = i >= first && (i - first) % 4 == 0;
    if (separates ? digits[i] != group : !is_decimal(digits[i])) return false;
  }
  return (digits.size() - first) % 4 == 0;
}

/// Thousands between `group`, perhaps a part of one behind `point`.
Number grouped_number(std::string_view cell, char group, char point, Number groups, Number three) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const auto end = cell.find(point);
  const auto part = end == std::string_view::npos ? std::string_view() : cell.substr(end + 1);
  const auto before = cell.substr(0, end);
  if (!std::ranges::all_of(part, is_decimal) || !is_grouped(before, group)) return Number::none;
  return end != std::string_view::npos || std::ranges::count(before, group) > 1 ? groups : three;
}

}  // namespace

Number number_in(std::string_view cell) {
  if (cell.size() > 64) return parse_number(cell) ? Number::whole : Number::none;
  const bool has_comma = cell.find(',') != std::string_view::npos,
             has_point = cell.find('.') != std::string_view::npos;
  if (has_comma)
    if (const auto found =
            grouped_number(cell, ',', '.', Number::groups_with_commas, Number::three_behind_comma);
        found != Number::none)
      return found;
  if (has_point)
    if (const auto found =
            grouped_number(cell, '.', ',', Number::groups_with_points, Number::three_behind_point);
        found != Number::none)
      return found;
  if (!has_comma) {
    if (!parse_number(cell)) return Number::none;
    return has_point ? Number::with_point : Number::whole;
  }
  const auto comma = cell.find(',');
  if (comma + 1 >= cell.size() || !is_decimal(cell[comma + 1])) return Number::none;
  std::string pointed(cell);
  pointed[comma] = '.';
  return pointed.find(',') == std::string::npos && parse_number(pointed) ? Number::with_comma : Number::none;
}

std::string with_usual_signs(std::string_view cell) {
  constexpr std::array<std::string_view, 2> kMinus{"\xE2\x88\x92", "\xEF\xBC\x8D"};  // U+2212, U+FF0D
  constexpr std::array<std::string_view, 7> kGroups{
      "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89", "\xE2\x80\x99", "\xA0", " ", "'"};
  std::string out;
  for (std::size_t i = 0; i < cell.size();) {
    const auto rest = cell.substr(i);
    const auto begins = [&](std::string_view sign) { return rest.starts_with(sign); };
    if (const auto minus = std::ranges::find_if(kMinus, begins); minus != kMinus.end()) {
      out += '-';
      i += minus->size();
      continue;
    }
    const auto group = std::ranges::find_if(kGroups, begins);
    const auto digits = group == kGroups.end() ? std::string_view() : rest.substr(group->size(), 4);
    const bool three = digits.size() >= 3 && std::ranges::all_of(digits.substr(0, 3), is_decimal) &&
                       (digits.size() == 3 || !is_decimal(digits[3]));
    if (three && !out.empty() && is_decimal(out.back()) && out.find_first_of(".,") == std::string::npos) {
      i += group->size();
      continue;
    }
    const char c = rest.front();
    const bool exponent = (c == 'D' || c == 'd') && !out.empty() &&
                          (is_decimal(out.back()) || out.back() == '.') && rest.size() > 1 &&
                          (is_decimal(rest[1]) || rest[1] == '+' || rest[1] == '-');
    out += exponent ? 'e' : c;
    ++i;
  }
  return out;
}

}  // namespace kinemark::io
