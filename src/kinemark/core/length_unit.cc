// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/length_unit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string>
#include <utility>

#include "kinemark/core/nearest_name.h"

namespace kinemark {

std::optional<double> metres_per_unit(std::string_view unit) {
  std::string name(unit);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.size() > 2 && name.ends_with('s')) name.pop_back();
  if (name.ends_with("metre")) name.replace(name.size() - 2, 2, "er");
  static const std::map<std::string_view, double> kUnits{
      {"um", 1e-6},         {"micrometer", 1e-6}, {"mm", 1e-3},   {"millimeter", 1e-3}, {"cm", 1e-2},
      {"centimeter", 1e-2}, {"dm", 1e-1},         {"m", 1.0},     {"meter", 1.0},       {"in", 0.0254},
      {"inch", 0.0254},     {"inche", 0.0254},    {"ft", 0.3048}, {"foot", 0.3048},     {"feet", 0.3048}};
  const auto found = kUnits.find(name);
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

std::vector<LengthUnitName> units_like(std::string_view word) {
  static const std::vector<std::string> kWords{"mm",    "millimeter", "cm",     "centimeter", "m",
                                               "meter", "inch",       "inches", "foot",       "feet"};
  std::vector<LengthUnitName> units;
  for (const std::string& name : nearest_names(word, kWords, kWords.size())) {
    const double metres = metres_per_unit(name).value();
    const auto same = [&](const LengthUnitName& unit) { return unit.metres == metres; };
    if (std::ranges::any_of(units, same)) continue;
    units.push_back({name, metres});
  }
  return units;
}

std::optional<LengthUnitName> unit_of_body_size(std::span<const LengthUnitName> units, double extent) {
  constexpr double kLeast_m = 0.1, kMost_m = 20.0;
  std::optional<LengthUnitName> found;
  for (const LengthUnitName& unit : units) {
    if (const double extent_m = extent * unit.metres; !(extent_m >= kLeast_m && extent_m <= kMost_m))
      continue;
    if (found) return std::nullopt;
    found = unit;
  }
  return found;
}

}  // namespace kinemark
