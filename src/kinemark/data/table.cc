// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace kinemark::data {

std::int64_t Table::find(std::string_view column) const {
  const auto it = std::ranges::find(columns, column);
  return it == columns.end() ? -1 : it - columns.begin();
}

Status Table::validate() const {
  if (values.size() != time_s.size() * columns.size())
    return fail(Code::bad_input, fmt::format("table of {} rows and {} columns holds {} values", time_s.size(),
                                             columns.size(), values.size()));
  std::set<std::string_view> seen;
  for (const std::string& column : columns)
    if (!seen.insert(column).second)
      return fail(Code::bad_input, fmt::format("column '{}' occurs twice", column));
  for (std::size_t r = 0; r < time_s.size(); ++r)
    if (!(r == 0 ? time_s[0] == time_s[0] : time_s[r] > time_s[r - 1]))
      return fail(Code::bad_input,
                  fmt::format("time of row {} is {} and does not increase", r + 1, time_s[r]));
  return {};
}

}  // namespace kinemark::data
