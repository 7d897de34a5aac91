// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text_dialect.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/number.h"
#include "kinemark/io/clock_time.h"
#include "kinemark/io/number_cell.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kLookedAt = 64UL << 10;

/// Which byte of a pair is the low one; none: no UTF-16.
enum class Utf16 : std::uint8_t { none, low_first, high_first };

Utf16 utf16_of(std::string_view text) {
  if (text.starts_with("\xFF\xFE")) return Utf16::low_first;
  if (text.starts_with("\xFE\xFF")) return Utf16::high_first;
  const auto begin = text.substr(0, 64);
  if (begin.size() < 8) return Utf16::none;
  for (std::size_t i = 0; i + 1 < begin.size(); i += 2)
    if (begin[i] == '\0' || begin[i + 1] != '\0') return Utf16::none;
  return Utf16::low_first;
}

void append_utf8(std::string& out, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { out += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6));
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3F));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

std::string utf8_of(std::string_view text, Utf16 order) {
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(text[i]), second = static_cast<unsigned char>(text[i + 1]);
    return order == Utf16::low_first ? static_cast<std::uint32_t>(first | (second << 8))
                                     : static_cast<std::uint32_t>((first << 8) | second);
  };
  constexpr std::uint32_t kByteOrderMark = 0xFEFF, kReplacement = 0xFFFD;
  std::string out;
  out.reserve(text.size() / 2 + 16);
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    const std::uint32_t code = unit(i);
    if (i == 0 && code == kByteOrderMark) continue;
    const bool is_high = code >= 0xD800 && code < 0xDC00;
    if (is_high && i + 3 < text.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
      append_utf8(out, 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00));
      i += 2;
    } else {
      append_utf8(out, code >= 0xD800 && code < 0xE000 ? kReplacement : code);
    }
  }
  return out;
}

/// Calls `use(line, end)` for each line and what ends it.
template <class Use>
void for_lines(std::string_view text, const Use& use) {
  while (!text.empty()) {
    const auto end = std::min(text.find_first_of("\r\n"), text.size());
    auto after = end;
    while (after < text.size() && (text[after] == '\r' || text[after] == '\n')) ++after;
    use(text.substr(0, end), text.substr(end, after - end));
    text.remove_prefix(after);
  }
}

/// How cells of a text are separated: by one of these, or by runs of blanks and tabs.
enum class Between : std::uint8_t { semicolons, tabs, commas, blanks };

/// Calls `use(cell)` for each cell of a line, with its quotes and blanks; quotes hold separators.
template <class Use>
void for_cells(std::string_view line, Between between, const Use& use) {
  const auto separates = [&](char c) {
    switch (between) {
      case Between::semicolons:
        return c == ';';
      case Between::tabs:
        return c == '\t';
      case Between::commas:
        return c == ',';
      case Between::blanks:
        return c == ' ' || c == '\t';
    }
    return false;
  };
  bool quoted = false;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || !separates(line[i]))) continue;
    if (between != Between::blanks || i > first) use(line.substr(first, i - first));
    first = i + 1;
  }
}

/// A cell without blanks and quotes around it.
std::string_view bare(std::string_view cell) {
  cell = trim(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    cell = trim(cell.substr(1, cell.size() - 2));
  return cell;
}

/// What is special about a text.
struct Dialect {
  Between between = Between::commas;
  bool decimal_commas = false;
  char thousands = 0;  ///< ',' or '.' between groups of three digits
  bool quoted_numbers = false;
  bool odd_signs = false;  ///< with_usual_signs() makes numbers of cells
  bool table_of_blanks = false;
};

std::size_t count_outside_quotes(std::string_view line, char wanted) {
  std::size_t count = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    count += !quoted && c == wanted ? 1 : 0;
  }
  return count;
}

/// Below titles with commas: half of all lines hold the same number of semicolons, two or more, and one of
/// them fewer commas.
bool is_table_of_semicolons(std::string_view sample) {
  std::map<std::size_t, std::size_t> lines_with;  // a number of semicolons
  std::size_t lines = 0;
  for_lines(sample, [&](std::string_view line, std::string_view) {
    if (trim(line).empty()) return;
    ++lines;
    ++lines_with[count_outside_quotes(line, ';')];
  });
  const auto most =
      std::ranges::max_element(lines_with, {}, [](const auto& counted) { return counted.second; });
  if (most == lines_with.end() || most->first < 2 || 2 * most->second < lines) return false;
  bool fewer_commas = false;
  for_lines(sample, [&](std::string_view line, std::string_view) {
    fewer_commas = fewer_commas || (count_outside_quotes(line, ';') == most->first &&
                                    count_outside_quotes(line, ',') < most->first);
  });
  return fewer_commas;
}

bool has_semicolons(std::string_view sample) {
  if (is_table_of_semicolons(sample)) return true;
  std::size_t lines = 0, with = 0;
  bool settled = false, more = false;
  for_lines(sample, [&](std::string_view line, std::string_view) {
    if (trim(line).empty()) return;
    ++lines;
    const auto count = count_outside_quotes(line, ';');
    with += count > 0 ? 1 : 0;
    if (const auto commas = count_outside_quotes(line, ','); !settled && count != commas) {
      settled = true;
      more = count > commas;
    }
  });
  return more && with > 1 && 2 * with >= lines;
}

bool has_tabs(std::string_view sample) {
  std::size_t lines = 0, with = 0;
  for_lines(sample, [&](std::string_view line, std::string_view) {
    if (trim(line).empty()) return;
    ++lines;
    with += line.find('\t') == std::string_view::npos ? 0 : 1;
  });
  return 2 * with >= lines && with > 0;
}

/// Of rows that hold two cells or more and nothing but numbers and the time of a clock.
void judge_rows(std::string_view sample, Dialect& dialect) {
  NumberKinds kinds;
  std::vector<std::pair<Number, std::string>> row;
  for_lines(sample, [&](std::string_view line, std::string_view) {
    row.clear();
    std::size_t quoted = 0;
    bool all = true, odd = false;
    for_cells(line, dialect.between, [&](std::string_view cell) {
      const auto inside = bare(cell);
      auto number = inside.empty() ? Number::none : number_in(inside);
      row.emplace_back(number, inside);
      if (inside.empty()) return;
      if (number == Number::none && is_decimal(inside.back())) {
        row.back().second = with_usual_signs(inside);
        row.back().first = number = number_in(row.back().second);
        odd = odd || number != Number::none;
      }
      all = all && (number != Number::none || parse_clock_time(inside));
      quoted += inside.size() < trim(cell).size() ? 1 : 0;
    });
    if (!all || row.size() < 2) return;
    kinds.add(row);
    dialect.odd_signs = dialect.odd_signs || odd;
    dialect.quoted_numbers = dialect.quoted_numbers || quoted > 0;
  });
  dialect.thousands = kinds.thousands();
  dialect.decimal_commas = kinds.have_decimal_commas();
}

/// What stands between the cells of its format; nothing: either may.
std::optional<char> separator_of(std::string_view text) {
  for (const std::string_view before : {"\xEF\xBB\xBF", "\""})
    if (text.starts_with(before)) text.remove_prefix(before.size());
  constexpr std::array<std::string_view, 4> kTabs{"PathFileType", "NO_OF_FRAMES", "NO_OF_CAMERAS",
                                                  "FILE_VERSION"};
  constexpr std::array<std::string_view, 7> kCommas{
      "Format Version", "Trajectories", "Devices", "Model Outputs", "Joints", "Segments", "Events"};
  const auto begins = [&](std::string_view word) { return text.starts_with(word); };
  if (std::ranges::any_of(kTabs, begins) ||
      text.substr(0, kLookedAt).find("endheader") != std::string_view::npos)
    return '\t';
  if (std::ranges::any_of(kCommas, begins)) return ',';
  return std::nullopt;
}

/// Rows of as many numbers between blanks, four or more, below a line of as many labels, perhaps behind a
/// '#': as numpy.savetxt() writes them.
bool is_table_of_blanks(std::string_view sample) {
  std::size_t width = 0, rows = 0, labels = 0, others = 0;
  for_lines(sample, [&](std::string_view line, std::string_view) {
    std::size_t cells = 0;
    bool all = true;
    for_cells(line, Between::blanks, [&](std::string_view cell) {
      ++cells;
      all = all && number_in(cell) != Number::none;
    });
    if (cells == 0) return;
    if (!all && rows == 0) labels = cells - (line.starts_with("# ") ? 1 : 0);
    if (!all) {
      others += rows > 0 ? 1 : 0;
      return;
    }
    if (rows == 0) width = cells;
    others += cells == width ? 0 : 1;
    ++rows;
  });
  return width >= 4 && rows >= 2 && others == 0 && labels == width;
}

Dialect dialect_of(std::string_view text) {
  auto sample = text.substr(0, kLookedAt);
  // A row that is cut may end in half a number.
  if (sample.size() < text.size())
    sample = sample.substr(0, std::min(sample.find_last_of("\r\n"), sample.size()));
  Dialect out;
  if (has_semicolons(sample))
    out.between = Between::semicolons;
  else if (has_tabs(sample))
    out.between = Between::tabs;
  else if (sample.find(',') == std::string_view::npos || sample.find("endheader") != std::string_view::npos ||
           sample.starts_with("PathFileType"))
    out.between = Between::blanks;
  judge_rows(sample, out);
  out.table_of_blanks = out.between == Between::blanks && !separator_of(text) && is_table_of_blanks(sample);
  // Rows of pairs: "1,2" is no number there.
  if (sample.find("DataType=Vec") != std::string_view::npos) {
    out.decimal_commas = false;
    out.thousands = 0;
  }
  return out;
}

/// What stands between the thousands of a cell; 0: nothing, or nobody knows.
char thousands_in(Number number, const Dialect& dialect) {
  switch (number) {
    case Number::groups_with_commas:
      return dialect.decimal_commas ? 0 : ',';
    case Number::groups_with_points:
      return dialect.decimal_commas || dialect.thousands == '.' ? '.' : 0;
    case Number::three_behind_comma:
      return dialect.thousands == ',' ? ',' : 0;
    case Number::three_behind_point:
      return dialect.decimal_commas || dialect.thousands == '.' ? '.' : 0;
    default:
      return 0;
  }
}

/// One cell as it is written again.
void append_cell(std::string& out, std::string_view cell, const Dialect& dialect, char separator) {
  const auto inside = bare(cell);
  auto number = number_in(inside);
  std::string plain(inside);
  if (number == Number::none && dialect.odd_signs && !inside.empty() && is_decimal(inside.back())) {
    auto usual = with_usual_signs(inside);
    number = number_in(usual);
    if (number != Number::none) plain = std::move(usual);
  }
  if (const char group = thousands_in(number, dialect); group != 0) std::erase(plain, group);
  const bool is_clock = number == Number::none && parse_clock_time(inside);
  if (is_clock || (number != Number::none && dialect.decimal_commas)) std::ranges::replace(plain, ',', '.');
  if (plain.find(separator) != std::string::npos || plain.find('"') != std::string::npos)
    out += '"' + plain + '"';
  else
    out += plain;
}

std::string rewritten(std::string_view text, const Dialect& dialect) {
  const char separator = separator_of(text).value_or(
      dialect.between == Between::semicolons || dialect.between == Between::commas ? ',' : '\t');
  std::string out;
  out.reserve(text.size() + 16);
  for_lines(text, [&](std::string_view line, std::string_view end) {
    bool first = true;
    for_cells(line, dialect.between, [&](std::string_view cell) {
      if (!first) out += separator;
      first = false;
      append_cell(out, cell, dialect, separator);
    });
    out += end;
  });
  return out;
}

}  // namespace

bool is_utf16(std::string_view begin) { return utf16_of(begin) != Utf16::none; }

std::string in_plain_dialect(std::string text) {
  if (const auto order = utf16_of(text); order != Utf16::none) text = utf8_of(text, order);
  const auto dialect = dialect_of(text);
  if (text.starts_with("\xEF\xBB\xBF") && text.find('"') == 3)
    text.erase(0, 3);  // else it is no quote that begins the cell
  const bool moved = dialect.between == Between::semicolons ||
                     (dialect.between == Between::tabs && separator_of(text) == ',') ||
                     dialect.table_of_blanks;
  if (!moved && !dialect.decimal_commas && dialect.thousands == 0 && !dialect.quoted_numbers &&
      !dialect.odd_signs)
    return text;
  return rewritten(text, dialect);
}

}  // namespace kinemark::io
