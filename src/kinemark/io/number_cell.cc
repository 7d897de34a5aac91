// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/number_cell.h"

#include <algorithm>
#include <cmath>

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

void NumberKinds::add(const std::vector<std::pair<Number, std::string>>& row) {
  if (columns_.size() < row.size()) columns_.resize(row.size());
  for (std::size_t c = 0; c < row.size(); ++c) {
    const auto& [kind, cell] = row[c];
    ++count_[static_cast<std::size_t>(kind)];
    std::string digits(cell);
    std::ranges::replace(digits, ',', '.');
    const double size = std::abs(parse_number(digits).value_or(0.0));
    auto& column = columns_[c];
    if (kind == Number::whole) column.whole = std::max(column.whole, size);
    if (kind == Number::three_behind_point) column.by_point = std::max(column.by_point, size);
    if (kind == Number::three_behind_comma) column.by_comma = std::max(column.by_comma, size);
  }
}

// Whether some column goes on from 987 to 1234 rather than to 1.234: numbers of one column are alike.
bool NumberKinds::are_thousands(double Column::* three) const {
  constexpr double kLeast = 100.0, kMost = 1000.0;
  return std::ranges::any_of(columns_, [&](const Column& column) {
    const double part = column.*three;
    return part > 0.0 && column.whole >= kLeast && column.whole < kMost &&
           column.whole * column.whole > 1e3 * part * part;
  });
}

char NumberKinds::thousands() const {
  const auto commas = of(Number::three_behind_comma), points = of(Number::three_behind_point);
  const bool by_commas = of(Number::groups_with_commas) > 0 ||
                         (commas > 0 && (of(Number::with_point) > 0 || are_thousands(&Column::by_comma)));
  const bool by_points = of(Number::groups_with_points) > 0 ||
                         (points > 0 && (of(Number::with_comma) > 0 || are_thousands(&Column::by_point)));
  if (by_commas && of(Number::with_comma) + of(Number::groups_with_points) == 0) return ',';
  if (by_points && of(Number::with_point) + of(Number::groups_with_commas) == 0) return '.';
  return 0;
}

bool NumberKinds::have_decimal_commas() const {
  const auto commas =
      of(Number::with_comma) + of(Number::three_behind_comma) + of(Number::groups_with_points);
  const auto points =
      of(Number::with_point) + of(Number::three_behind_point) + of(Number::groups_with_commas);
  const char group = thousands();
  return group == '.' ? commas > 0 : group == 0 && commas > 0 && points == 0;
}

}  // namespace kinemark::io
