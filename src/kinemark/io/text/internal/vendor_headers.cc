// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/vendor_headers.h"

#include <fmt/core.h>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/length_unit.h"

namespace kinemark::io::internal {

Result<double> units_per_metre(std::string_view unit, std::int64_t line) {
  const auto metres = metres_per_unit(unit);
  if (!metres)
    return fail(
        Code::bad_input,
        fmt::format("line {}: length unit '{}' is unknown; expected millimetres, centimetres or metres", line,
                    excerpt(unit)));
  return 1.0 / *metres;
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
