// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/subject_values.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "kinemark/core/nearest_name.h"
#include "kinemark/io/length_unit.h"
#include "kinemark/io/number.h"

namespace kinemark::pipeline {
namespace {

using analysis::SubjectQuantity;
using Parameter = analysis::SegmentDefinition::Parameter;

const Parameter* find_parameter(const analysis::SegmentDefinition& definition, const std::string& name) {
  const auto at = std::ranges::find_if(definition.parameters, [&](const Parameter& p) {
    return p.name == name || std::ranges::find(p.also, name) != p.also.end();
  });
  return at == definition.parameters.end() ? nullptr : &*at;
}

std::optional<double> one_number(const data::ForeignParameter& parameter) {
  const bool one = std::ranges::all_of(parameter.dims, [](std::uint8_t size) { return size == 1; });
  if (!one || parameter.type != 4 || parameter.values.size() != sizeof(float)) return std::nullopt;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < sizeof bits; ++k)
    bits |= static_cast<std::uint32_t>(parameter.values[k]) << (8 * k);
  return std::bit_cast<float>(bits);
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

Result<analysis::SubjectValue> parse_subject_value(const std::string& text,
                                                   const analysis::SegmentDefinition& definition) {
  const auto equals = text.find('=');
  const auto value = equals == std::string::npos ? std::nullopt : io::parse_number(text.substr(equals + 1));
  if (equals == 0 || !value || !std::isfinite(*value))
    return fail(Code::usage, fmt::format("'{}' is not NAME=VALUE; lengths are in mm, angles in deg", text));
  const auto name = text.substr(0, equals);
  const auto* parameter = find_parameter(definition, name);
  if (parameter == nullptr) {
    std::vector<std::string> names;
    for (const auto& p : definition.parameters) names.push_back(p.name);
    const auto near = nearest_names(name, names);
    return fail(Code::usage, fmt::format("the definition has no parameter '{}'; it has {}", name,
                                         fmt::join(near.empty() ? names : near, ", ")));
  }
  return analysis::SubjectValue{parameter->name, *value * per_shown(parameter->quantity), "--subject"};
}

std::vector<analysis::SubjectValue> subject_values(const data::Trial& trial,
                                                   const analysis::SegmentDefinition& definition) {
  std::vector<analysis::SubjectValue> out;
  const double metres = io::metres_per_unit(trial.units_in_file).value_or(1e-3);
  for (const auto& group : trial.foreign) {
    if (group.name != "PROCESSING") continue;
    for (const auto& parameter : group.parameters) {
      const auto* known = find_parameter(definition, parameter.name);
      const auto value = one_number(parameter);
      if (known == nullptr || !value) continue;
      out.push_back(
          {known->name, *value * (known->quantity == SubjectQuantity::length ? metres : 1.0), trial.source});
    }
  }
  return out;
}

std::vector<analysis::SubjectValue> subject_values(const io::Vsk& vsk, const std::string& name) {
  std::vector<analysis::SubjectValue> out;
  for (const auto& parameter : vsk.parameters)
    if (parameter.value) out.push_back({parameter.name, *parameter.value, name});
  return out;
}

}  // namespace kinemark::pipeline
