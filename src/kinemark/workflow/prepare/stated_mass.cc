// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/stated_mass.h"

#include <string_view>

#include "kinemark/core/missing.h"
#include "kinemark/data/foreign_number.h"

namespace kinemark::workflow {
namespace {

constexpr double kLeast_kg = 1.0, kMost_kg = 500.0;

bool is_mass(std::string_view group, std::string_view parameter) {
  if (group == "PROCESSING") return parameter == "BODYMASS";
  return (group == "SUBJECT" || group == "SUBJECTS") &&
         (parameter == "WEIGHT" || parameter == "MASS" || parameter == "BODYMASS");
}

}  // namespace

double stated_mass_kg(const data::Trial& trial) {
  for (const auto& group : trial.foreign)
    for (const auto& parameter : group.parameters) {
      if (!is_mass(data::foreign_name(group.name), data::foreign_name(parameter.name))) continue;
      const auto value = data::number_of(parameter);
      if (value && *value >= kLeast_kg && *value <= kMost_kg) return *value;
    }
  return kNaN;
}

}  // namespace kinemark::workflow
