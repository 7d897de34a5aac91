// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/enum_names.h"

namespace kinemark::data {
namespace {

constexpr EnumNames<Quantity::count> kQuantities{"length",
                                                 "area",
                                                 "curvature",
                                                 "time",
                                                 "frequency",
                                                 "speed",
                                                 "acceleration",
                                                 "jerk",
                                                 "angle",
                                                 "angular velocity",
                                                 "angular acceleration",
                                                 "force",
                                                 "moment",
                                                 "power",
                                                 "energy",
                                                 "angular momentum",
                                                 "rate",
                                                 "voltage",
                                                 "impulse",
                                                 "force rate",
                                                 "moment per mass",
                                                 "power per mass",
                                                 "energy per mass",
                                                 "ratio",
                                                 "share",
                                                 "count"};
constexpr EnumNames<IntervalKind::at_least> kIntervalKinds{"none", "two-sided", "at most", "at least"};

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::array<Unit, decltype(kQuantities)::kCount> kUnits{{
    {"mm", 1e3},
    {"cm^2", 1e4},
    {"1/m", 1.0},
    {"s", 1.0},
    {"Hz", 1.0},
    {"mm/s", 1e3},
    {"mm/s^2", 1e3},
    {"mm/s^3", 1e3},
    {"deg", kDegrees},
    {"deg/s", kDegrees},
    {"deg/s^2", kDegrees},
    {"N", 1.0},
    {"N m", 1.0},
    {"W", 1.0},
    {"J", 1.0},
    {"kg m^2/s", 1.0},
    {"1/min", 60.0},
    {"V", 1.0},
    {"N s", 1.0},
    {"N/s", 1.0},
    {"N m/kg", 1.0},
    {"W/kg", 1.0},
    {"J/kg", 1.0},
    {"", 1.0},
    {"%", 100.0},
    {"", 1.0},
}};

// What the ends of an interval must be: there or not, and in order.
bool ends_fit(const Interval& interval) {
  const bool low = !std::isnan(interval.low), high = !std::isnan(interval.high);
  switch (interval.kind) {
    case IntervalKind::none:
      return !low && !high;
    case IntervalKind::two_sided:
      return low && high && interval.low <= interval.high;
    case IntervalKind::at_most:
      return !low && high;
    case IntervalKind::at_least:
      return low && !high;
  }
  return false;
}

}  // namespace

Unit shown_unit(Quantity quantity) { return kUnits[static_cast<std::size_t>(quantity)]; }
std::string_view to_string(Quantity quantity) { return kQuantities[quantity]; }
std::string_view to_string(IntervalKind kind) { return kIntervalKinds[kind]; }

Status Measure::validate() const {
  if (id.empty()) return fail(Code::bad_input, "a measure has no id; need the id of its definition");
  if (!(share_not_measured >= 0.0 && share_not_measured <= 1.0))
    return fail(Code::bad_input, fmt::format("measure '{}' rests on a share not measured of {}; need 0 to 1",
                                             id, share_not_measured));
  if (!(interval.level > 0.0 && interval.level < 1.0))
    return fail(Code::bad_input,
                fmt::format("measure '{}' has an interval of level {}; need one between 0 and 1", id,
                            interval.level));
  if (!ends_fit(interval))
    return fail(Code::bad_input,
                fmt::format("measure '{}' has an interval of kind '{}' from {} to {}; need the ends "
                            "of that kind, in order",
                            id, to_string(interval.kind), interval.low, interval.high));
  if (sd < 0.0)
    return fail(Code::bad_input,
                fmt::format("measure '{}' has a deviation of {}; need none below 0", id, sd));
  if (std::isnan(value) && remark.empty())
    return fail(Code::bad_input, fmt::format("measure '{}' is not determined and does not say why", id));
  return {};
}

Status CycleCurves::validate() const {
  const std::size_t need = cycles.size() * static_cast<std::size_t>(std::max<std::int64_t>(points, 0));
  if (points < 2 || values.size() != need || (!sd.empty() && sd.size() != need))
    return fail(
        Code::bad_input,
        fmt::format("curves '{}' of {} cycles at {} points hold {} values and {} deviations; need at least 2 "
                    "points, {} values, and as many deviations or none",
                    id, cycles.size(), points, values.size(), sd.size(), need));
  if (std::ranges::any_of(sd, [](double s) { return s < 0.0; }))
    return fail(Code::bad_input, fmt::format("curves '{}' have a deviation below 0", id));
  return {};
}

}  // namespace kinemark::data
