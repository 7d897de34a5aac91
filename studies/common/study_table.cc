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
  return row.at_most ? fmt::format("<= {:.4g}", *row.at_most) : "-";
}

}  // namespace

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
    const Json limits =
        row.at_least ? Json::array({value(row.at_least), value(row.at_most)}) : value(row.at_most);
    rows.push_back({{"quantity", row.quantity},
                    {"unit", row.unit},
                    {"paper", value(row.paper)},
                    {"classic", value(row.classic)},
                    {"ours", row.ours},
                    {"limit", value(row.limit)},
                    {"bound", limits},
                    {"pass", row.pass()}});
  }
  return {{"seeds", table.seeds}, {"rows", rows}, {"pass", table.pass()}};
}

std::string_view unit_text(const StudyRow& row) { return row.unit == "1" ? std::string_view() : row.unit; }

std::string study_text(const StudyTable& table) {
  constexpr std::size_t kColumns = 7;
  std::vector<std::array<std::string, kColumns>> lines{
      {"", "unit", "paper", "classic", "ours", "limit", "bound"}};
  for (const auto& row : table.rows)
    lines.push_back({row.quantity, std::string(unit_text(row)), table_cell(row.paper),
                     table_cell(row.classic), table_cell(row.ours), table_cell(row.limit), bound(row)});
  std::array<std::size_t, kColumns> width{};
  for (const auto& line : lines)
    for (std::size_t i = 0; i < kColumns; ++i) width[i] = std::max(width[i], line[i].size());
  std::string out;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    out += fmt::format("{:<{}}", lines[row][0], width[0]);
    for (std::size_t i = 1; i < kColumns; ++i) out += fmt::format("  {:>{}}", lines[row][i], width[i]);
    out += row > 0 && !table.rows[row - 1].pass() ? "  FAILS\n" : "\n";
  }
  return out + "limit: the best that any method can reach on these data; bound: what is asked of ours\n";
}

}  // namespace kinemark::studies
