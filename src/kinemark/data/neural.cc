// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/neural.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace kinemark::data {
namespace {

Status check_unit(const SpikeTrain& unit) {
  double last = -std::numeric_limits<double>::infinity();
  for (const double time : unit.times_s) {
    if (!std::isfinite(time) || time < last)
      return fail(Code::bad_input,
                  fmt::format("unit {}: spike times must be numbers that ascend; {} s comes after {} s",
                              unit.id, time, last));
    last = time;
  }
  return {};
}

bool same_columns(const std::vector<LabelledValue>& a, const std::vector<LabelledValue>& b) {
  return std::ranges::equal(a, b, {}, &LabelledValue::column, &LabelledValue::column);
}

Status check_intervals(const IntervalTable& table) {
  for (const auto& row : table.rows) {
    if (row.start_s > row.stop_s || std::isinf(row.start_s) || std::isinf(row.stop_s))
      return fail(Code::bad_input, fmt::format("intervals '{}': one goes from {} to {} s; need an interval",
                                               table.name, row.start_s, row.stop_s));
    if (!same_columns(row.labels, table.rows.front().labels))
      return fail(Code::bad_input, fmt::format("intervals '{}': rows have different columns", table.name));
  }
  return {};
}

Status check_field(const FieldEnvelope& field) {
  const auto size = static_cast<std::size_t>(std::max<std::int64_t>(0, field.bins)) * field.channels.size();
  if (field.bins < 0 || field.low.size() != size || field.high.size() != size || !(field.rate_hz > 0.0) ||
      !(field.bin_s > 0.0) || !std::isfinite(field.start_s))
    return fail(Code::bad_input,
                fmt::format("field potential '{}': has no clock, or not {} numbers", field.name, size));
  for (std::size_t i = 0; i < size; ++i)
    if (std::isnan(field.low[i]) != std::isnan(field.high[i]) || field.low[i] > field.high[i])
      return fail(Code::bad_input,
                  fmt::format("field potential '{}': the least value is above the largest", field.name));
  return {};
}

}  // namespace

const IntervalTable* Neural::find_intervals(std::string_view name) const {
  const auto at = std::ranges::find(intervals, name, &IntervalTable::name);
  return at == intervals.end() ? nullptr : &*at;
}

const SpikeTrain* Neural::find_unit(std::string_view id) const {
  const auto at = std::ranges::find(units, id, &SpikeTrain::id);
  return at == units.end() ? nullptr : &*at;
}

Status Neural::validate() const {
  std::set<std::string_view> ids, names;
  for (const auto& unit : units) {
    if (!ids.insert(unit.id).second)
      return fail(Code::bad_input, fmt::format("two units are called '{}'", unit.id));
    if (auto s = check_unit(unit); !s) return s;
  }
  for (const auto& table : intervals) {
    if (!names.insert(table.name).second)
      return fail(Code::bad_input, fmt::format("two tables of intervals are called '{}'", table.name));
    if (auto s = check_intervals(table); !s) return s;
  }
  for (const auto& field : fields)
    if (auto s = check_field(field); !s) return s;
  return {};
}

}  // namespace kinemark::data
