// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/derivatives.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace kinemark::data {

Status Derivatives::validate(const Trajectories& of) const {
  const std::size_t numbers = of.x_in_world.size();
  const std::pair<const char*, const Array<double>*> all[] = {
      {"velocity", &velocity},       {"acceleration", &acceleration}, {"jerk", &jerk},
      {"velocity_sd", &velocity_sd}, {"jerk_sd", &jerk_sd},           {"acceleration_sd", &acceleration_sd}};
  for (const auto& [name, values] : all)
    if (!values->empty() && values->size() != numbers)
      return fail(Code::bad_input, fmt::format("derivatives hold {} numbers of {}; need {} or none",
                                               values->size(), name, numbers));
  for (const auto& [name, values] : {all[3], all[4], all[5]})
    if (std::ranges::any_of(*values, [](double sd) { return sd < 0.0; }))
      return fail(Code::bad_input, fmt::format("derivatives hold a negative {}", name));
  if (filters.size() != of.names.size())
    return fail(Code::bad_input,
                fmt::format("derivatives name {} filters for {} markers", filters.size(), of.names.size()));
  return {};
}

}  // namespace kinemark::data
