// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/core/number.h"
#include "kinemark/io/text/internal/coordinate_labels.h"
#include "kinemark/io/text/internal/csv_line.h"

namespace kinemark::io::internal {
namespace {

using Label = CoordinateLabel;

bool is_between(char c) { return kBetweenNameAndAxis.find(c) != std::string_view::npos; }

/// "LASI_1", "LASI.2", "LASI[0]": a name and a number of one digit. Words for a point of any name have
/// numbers to tell markers apart.
std::optional<std::pair<std::string, int>> numbered_component(const Label& label) {
  constexpr std::array<std::string_view, 14> kAnyPoint{"marker", "markers", "point", "points", "mkr",
                                                       "m",      "p",       "pt",    "sensor", "channel",
                                                       "ch",     "column",  "col",   "unnamed"};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string_view stem = label.name;
  char digit = 0;
  if (label.unit.size() == 1 && is_digit(label.unit.front())) {
    digit = label.unit.front();
  } else if (stem.size() > 2 && is_digit(stem.back()) && is_between(stem[stem.size() - 2])) {
    digit = stem.back();
    stem.remove_suffix(1);
  }
  while (!stem.empty() && is_between(stem.back())) stem.remove_suffix(1);
  if (digit == 0 || stem.empty() || std::ranges::find(kAnyPoint, lower(stem)) != kAnyPoint.end())
    return std::nullopt;
  return std::pair{std::string(stem), digit - '0'};
}

}  // namespace

bool take_numbered_axes(std::vector<Label>& labels, const std::vector<std::string>& first_row) {
  std::map<std::string, std::vector<std::size_t>> columns;  // of a name
  int lowest = 2;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    if (labels[c].is_clock()) continue;
    const auto component = numbered_component(labels[c]);
    if (!component) return false;
    columns[component->first].push_back(c);
    lowest = std::min(lowest, component->second);
  }
  const auto axis = [&](std::size_t c) { return numbered_component(labels[c])->second - lowest; };
  const auto is_one = [&](std::size_t c) {
    return c < first_row.size() && parse_number(first_row[c]) == 1.0;
  };
  const bool threes =
      lowest < 2 && std::ranges::all_of(
                        columns,
                        [&](const auto& named) {
                          std::set<int> axes;
                          for (const std::size_t c : named.second) axes.insert(axis(c));
                          const auto& last = named.second.back();
                          return axes.size() == named.second.size() &&
                                 (axes == std::set{0, 1, 2} ||
                                  (axes == std::set{0, 1, 2, 3} && axis(last) == 3 && is_one(last)));
                        });
  if (columns.empty() || !threes) return false;
  for (const auto& [name, of_name] : columns)
    for (const std::size_t c : of_name) {
      const int of = axis(c);
      if (of == Label::kW) continue;
      labels[c].axis = of;
      if (labels[c].unit.size() == 1 && !metres_per_unit(labels[c].unit)) labels[c].unit.clear();
      labels[c].name = name;
    }
  return true;
}

}  // namespace kinemark::io::internal
