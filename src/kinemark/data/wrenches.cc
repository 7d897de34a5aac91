// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/wrenches.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinemark::data {

Status Wrenches::validate() const {
  if (!(time.rate_hz > 0.0) || !std::isfinite(time.rate_hz))
    return fail(Code::bad_input, fmt::format("wrenches have a rate of {} Hz", time.rate_hz));
  const auto numbers = 3 * static_cast<std::size_t>(std::max<std::int64_t>(0, frames()));
  for (const auto& wrench : items) {
    const std::pair<const char*, const Array<double>*> all[] = {
        {"force", &wrench.force}, {"moment", &wrench.moment}, {"point", &wrench.point}};
    for (const auto& [name, values] : all)
      if (values->size() != numbers)
        return fail(Code::bad_input, fmt::format("wrench '{}' holds {} numbers of {}; need {}", wrench.name,
                                                 values->size(), name, numbers));
    for (std::size_t i = 0; i < numbers; i += 3) {
      const auto acts = [i](const Array<double>& values) {
        return std::any_of(values.begin() + static_cast<std::ptrdiff_t>(i),
                           values.begin() + static_cast<std::ptrdiff_t>(i + 3),
                           [](double f) { return std::isfinite(f) && f != 0.0; });
      };
      const bool placed = std::all_of(wrench.point.begin() + static_cast<std::ptrdiff_t>(i),
                                      wrench.point.begin() + static_cast<std::ptrdiff_t>(i + 3),
                                      [](double p) { return std::isfinite(p); });
      if (!placed && (acts(wrench.force) || acts(wrench.moment)))
        return fail(Code::bad_input,
                    fmt::format("wrench '{}' acts in frame {}, but not at a point", wrench.name, i / 3));
    }
  }
  return {};
}

}  // namespace kinemark::data
