// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

namespace kinemark::studies {
namespace {

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string table_cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

std::string bound(const StudyRow& row) {
  if (row.at_least && row.at_most) return fmt::format("{:.4g} to {:.4g}", *row.at_least, *row.at_most);
  if (row.at_least) return fmt::format(">= {:.4g}", *row.at_least);
  return row.at_most ? fmt::format("<= {:.4g}", *row.at_most) : "figure";
}

constexpr std::array<std::string_view, 4> kExpectations{"right value", "Cramer-Rao bound",
                                                        "Cramer-Rao bound of a frame alone", "predicted SD"};
constexpr std::array<std::string_view, 4> kMarks{"", " CR", " CR1", " SD"};
constexpr std::array<std::string_view, 4> kMeanings{
    "a number alone: of error bars that are right, or of an estimate at its bound",
    "CR: Cramer-Rao bound, the least standard deviation of an unbiased estimate from the same samples; what "
    "is measured scatters about the estimate's own",
    "CR1: the same for one frame at a time, below which an estimate from several frames may lie",
    "SD: the standard deviation that ours states for the same samples; errors scatter about it"};

std::size_t index_of(Expectation expectation) { return static_cast<std::size_t>(expectation); }

}  // namespace

std::string_view to_string(Expectation expectation) { return kExpectations.at(index_of(expectation)); }

bool StudyTable::has_bound() const { return std::ranges::any_of(rows, &StudyRow::has_bound); }

bool StudyTable::pass() const {
  return std::ranges::all_of(rows, [](const StudyRow& row) { return row.pass(); });
}

Result<std::vector<std::uint64_t>> parse_seeds(std::string_view text) {
  constexpr std::size_t kMost = 1000;
  std::vector<std::uint64_t> out;
  const auto wrong = [&] {
    return fail(
        Code::usage,
        fmt::format("--seeds: '{}'; numbers and ranges such as 1-10 or 1,4,7-9 were expected, {} at most",
                    text, kMost));
  };
  for (std::size_t at = 0; at <= text.size();) {
    const auto comma = std::min(text.find(',', at), text.size());
    const auto part = text.substr(at, comma - at);
    const auto dash = part.find('-');
    const auto first = number(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : number(part.substr(dash + 1));
    if (!first || !last || *last < *first || *last - *first >= kMost ||
        out.size() + (*last - *first) >= kMost)
      return wrong();
    // Counted, as no seed is larger than the last of all.
    for (std::uint64_t i = 0; i <= *last - *first; ++i) out.push_back(*first + i);
    at = comma + 1;
  }
  return out;
}

nlohmann::ordered_json study_json(const StudyTable& table) {
  using Json = nlohmann::ordered_json;
  const auto value = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    const Json bounds =
        row.at_least ? Json::array({value(row.at_least), value(row.at_most)}) : value(row.at_most);
    rows.push_back({{"quantity", row.quantity},
                    {"unit", row.unit},
                    {"paper", value(row.paper)},
                    {"classic", value(row.classic)},
                    {"ours", row.ours},
                    {"expected", value(row.expected)},
                    {"expected_is", row.expected ? Json(to_string(row.expected_is)) : Json(nullptr)},
                    {"bound", bounds},
                    {"pass", row.has_bound() ? Json(row.pass()) : Json(nullptr)}});
  }
  return {{"seeds", table.seeds},
          {"rows", rows},
          {"pass", table.has_bound() ? Json(table.pass()) : Json(nullptr)}};
}

std::string_view unit_text(const StudyRow& row) { return row.unit == "1" ? std::string_view() : row.unit; }

std::string expected_text(const StudyRow& row) {
  if (!row.expected) return "";
  return fmt::format("{:.4g}{}", *row.expected, kMarks.at(index_of(row.expected_is)));
}

std::string column_text(const StudyTable& table) {
  std::string out = "paper: as published";
  std::string_view before = "; expected: ";
  for (std::size_t i = 0; i < kMeanings.size(); ++i)
    if (std::ranges::any_of(table.rows, [&](const StudyRow& row) {
          return row.expected && index_of(row.expected_is) == i;
        })) {
      out += fmt::format("{}{}", before, kMeanings[i]);
      before = "; ";
    }
  out += "; bound: what is asked of ours";
  if (!std::ranges::all_of(table.rows, &StudyRow::has_bound))
    out += ", figure: a number of which nothing is asked";
  return out;
}

std::string missed_text(const StudyTable& table) {
  std::string missed;
  std::size_t asked = 0, count = 0;
  for (const auto& row : table.rows) {
    asked += row.has_bound() ? 1 : 0;
    if (row.pass()) continue;
    missed += fmt::format("{}{}", count++ > 0 ? "; " : "", row.quantity);
  }
  if (asked == 0) return "";
  const auto free = table.rows.size() - asked;
  const auto figures =
      free == 0 ? "" : fmt::format(" {} more {} no bound.", free, free == 1 ? "row has" : "rows have");
  if (count == 0) return fmt::format("None of {} bounds is missed.{}", asked, figures);
  return fmt::format("{} of {} bounds {} missed: {}.{}", count, asked, count == 1 ? "is" : "are", missed,
                     figures);
}

std::string study_text(const StudyTable& table) {
  constexpr std::size_t kColumns = 7;
  std::vector<std::array<std::string, kColumns>> lines{
      {"", "unit", "paper", "classic", "ours", "expected", "bound"}};
  for (const auto& row : table.rows)
    lines.push_back({row.quantity, std::string(unit_text(row)), table_cell(row.paper),
                     table_cell(row.classic), table_cell(row.ours), row.expected ? expected_text(row) : "-",
                     bound(row)});
  std::array<std::size_t, kColumns> width{};
  for (const auto& line : lines)
    for (std::size_t i = 0; i < kColumns; ++i) width[i] = std::max(width[i], line[i].size());
  std::string out;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    out += fmt::format("{:<{}}", lines[row][0], width[0]);
    for (std::size_t i = 1; i < kColumns; ++i) out += fmt::format("  {:>{}}", lines[row][i], width[i]);
    out += row > 0 && !table.rows[row - 1].pass() ? "  FAILS\n" : "\n";
  }
  out += column_text(table) + "\n";
  const std::string missed = missed_text(table);
  return missed.empty() ? out : out + missed + "\n";
}

}  // namespace kinemark::studies
