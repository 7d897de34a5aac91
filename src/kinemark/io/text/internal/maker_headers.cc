// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/maker_headers.h"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "kinemark/core/distinct_names.h"

namespace kinemark::io::internal {

Result<double> units_per_metre(std::string_view unit, std::int64_t line) {
  static constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{{{"mm", 1000.0},
                                                                              {"millimeters", 1000.0},
                                                                              {"cm", 100.0},
                                                                              {"centimeters", 100.0},
                                                                              {"m", 1.0},
                                                                              {"meters", 1.0}}};
  const std::string word = lower(unit);
  for (const auto& [name, per_metre] : kUnits)
    if (word == name) return per_metre;
  return fail(Code::bad_input, fmt::format("line {}: length unit '{}' is unknown; expected millimetres, "
                                           "centimetres or metres",
                                           line, excerpt(unit)));
}

void settle_marker_names(std::vector<std::string>& names, std::int64_t line, data::Trial& trial) {
  std::size_t unnamed = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].empty()) continue;
    ++unnamed;
    names[i] = fmt::format("point {}", i + 1);
  }
  if (unnamed > 0)
    trial.warnings.push_back(fmt::format("line {} names {} of {} markers; the others are called 'point n'",
                                         line, names.size() - unnamed, names.size()));
  if (const auto repeated = make_distinct(names); repeated.changed > 0)
    trial.warnings.push_back(
        fmt::format("line {} repeats {} marker names ('{}' is the first); a number is added "
                    "to each",
                    line, repeated.changed, excerpt(repeated.example)));
}

}  // namespace kinemark::io::internal
