// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/length_unit.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string>

namespace kinemark::io {

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

}  // namespace kinemark::io
