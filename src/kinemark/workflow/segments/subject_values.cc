// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/subject_values.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "kinemark/core/length_unit.h"
#include "kinemark/data/foreign_number.h"
#include "kinemark/data/name_index.h"

namespace kinemark::workflow {
namespace {

using analysis::SubjectQuantity;

bool is_leg_length(const std::string& name) { return name.ends_with("LegLength"); }

// A marker set of the group SUBJECTS by its name.
bool names_device(const data::ForeignParameter& parameter) {
  if (!parameter.name.starts_with("MARKER_SET")) return false;
  std::string text;
  for (const auto byte : parameter.values)
    text += static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
  return text.find("KAD") != std::string::npos || text.find("MED") != std::string::npos;
}

}  // namespace

double per_shown(SubjectQuantity quantity) {
  if (quantity == SubjectQuantity::length) return 1e-3;
  return quantity == SubjectQuantity::angle ? std::numbers::pi / 180.0 : 1.0;
}

std::string_view shown_unit(SubjectQuantity quantity) {
  switch (quantity) {
    case SubjectQuantity::length:
      return "mm";
    case SubjectQuantity::angle:
      return "deg";
    case SubjectQuantity::mass:
      return "kg";
    case SubjectQuantity::number:
      break;
  }
  return "";
}

const analysis::SegmentDefinition::Parameter* find_parameter(const analysis::SegmentDefinition& definition,
                                                             const std::string& name) {
  const auto at = std::ranges::find_if(definition.parameters, [&](const auto& p) {
    return p.name == name || std::ranges::find(p.also, name) != p.also.end();
  });
  return at == definition.parameters.end() ? nullptr : &*at;
}

std::vector<analysis::SubjectValue> subject_values(const data::Trial& trial,
                                                   const analysis::SegmentDefinition& definition) {
  std::vector<analysis::SubjectValue> out;
  const double metres = metres_per_unit(trial.units_in_file).value_or(1e-3);
  for (const auto& group : trial.foreign) {
    if (group.name != "PROCESSING") continue;
    for (const auto& parameter : group.parameters) {
      const auto* known = find_parameter(definition, parameter.name);
      const auto value = data::number_of(parameter);
      if (known == nullptr || !value) continue;
      out.push_back(
          {known->name, *value * (known->quantity == SubjectQuantity::length ? metres : 1.0), trial.source});
    }
  }
  return out;
}

bool measures_offsets(const data::Trial& trial) {
  for (const auto& group : trial.foreign)
    if (group.name == "SUBJECTS" && std::ranges::any_of(group.parameters, names_device)) return true;
  return std::ranges::any_of(trial.markers.names, [](const std::string& name) {
    const auto plain = data::without_prefix(name);
    return plain.size() >= 4 && (plain.substr(1) == "KAX" || plain.substr(1) == "MED" ||
                                 plain.substr(1) == "KNEMED" || plain.substr(1) == "KD1");
  });
}

void mend_units(std::vector<analysis::SubjectValue>& values, const analysis::SegmentDefinition& definition,
                std::vector<std::string>& warnings) {
  constexpr double kLargest_rad = 1.2, kShortest_m = 0.2, kLongest_m = 1.5;
  const auto quantity = [&](const analysis::SubjectValue& v) {
    const auto* known = find_parameter(definition, v.name);
    return known == nullptr ? SubjectQuantity::number : known->quantity;
  };
  double angle = 0.0, leg = 0.0;
  for (const auto& v : values) {
    if (quantity(v) == SubjectQuantity::angle) angle = std::max(angle, std::abs(v.value));
    if (is_leg_length(v.name)) leg = std::max(leg, v.value);
  }
  if (angle > kLargest_rad) {
    for (auto& v : values)
      if (quantity(v) == SubjectQuantity::angle) v.value *= std::numbers::pi / 180.0;
    warnings.push_back(fmt::format("{}: its angles are taken as degrees: {:g} rad is no offset of a marker",
                                   values.front().from, angle));
  }
  if (!(leg > 0.0) || (leg >= kShortest_m && leg <= kLongest_m)) return;
  for (const double factor : {1e-3, 1e3, 1e-2, 10.0}) {
    if (leg * factor < kShortest_m || leg * factor > kLongest_m) continue;
    for (auto& v : values)
      if (quantity(v) == SubjectQuantity::length) v.value *= factor;
    warnings.push_back(fmt::format("{}: its lengths are taken times {:g}: no leg is {:g} m long",
                                   values.front().from, factor, leg));
    return;
  }
}

}  // namespace kinemark::workflow
