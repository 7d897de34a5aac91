// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/subject_values.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/number.h"
#include "kinemark/io/file.h"
#include "kinemark/io/length_unit.h"

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

// A float, or a whole number of two bytes.
std::optional<double> one_number(const data::ForeignParameter& parameter) {
  const bool one = std::ranges::all_of(parameter.dims, [](std::uint8_t size) { return size == 1; });
  const auto size = static_cast<std::size_t>(parameter.type == 4 ? 4 : 2);
  if (!one || (parameter.type != 4 && parameter.type != 2) || parameter.values.size() != size)
    return std::nullopt;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < size; ++k) bits |= static_cast<std::uint32_t>(parameter.values[k]) << (8 * k);
  if (parameter.type == 2) return static_cast<std::int16_t>(bits);
  return std::bit_cast<float>(bits);
}

bool is_leg_length(const std::string& name) { return name.ends_with("LegLength"); }

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
  const auto plus = equals == std::string::npos ? equals : text.find("+-", equals + 1);
  const auto number = [&](std::size_t begin, std::size_t end) {
    return parse_number(std::string_view(text).substr(begin, end - begin));
  };
  const auto value =
      equals == std::string::npos ? std::nullopt : number(equals + 1, std::min(plus, text.size()));
  const auto sd = plus == std::string::npos ? std::nullopt : number(plus + 2, text.size());
  const bool sd_wrong = plus != std::string::npos && !(sd && std::isfinite(*sd) && *sd >= 0.0);
  if (equals == 0 || !value || !std::isfinite(*value) || sd_wrong)
    return fail(
        Code::usage,
        fmt::format("'{}' is not NAME=VALUE or NAME=VALUE+-SD; lengths are in mm, angles in deg", text));
  const auto name = text.substr(0, equals);
  const auto* parameter = find_parameter(definition, name);
  if (parameter == nullptr) {
    std::vector<std::string> names;
    for (const auto& p : definition.parameters) names.push_back(p.name);
    const auto near = nearest_names(name, names);
    return fail(Code::usage, fmt::format("the definition has no parameter '{}'; it has {}", name,
                                         fmt::join(near.empty() ? names : near, ", ")));
  }
  const double unit = per_shown(parameter->quantity);
  analysis::SubjectValue out{parameter->name, *value * unit, "--subject"};
  if (sd) out.sd = *sd * unit;
  return out;
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

Result<std::vector<analysis::SubjectValue>> parse_mp(std::string_view text, const std::string& name,
                                                     const analysis::SegmentDefinition& definition) {
  std::vector<analysis::SubjectValue> out;
  bool some = false;
  while (!text.empty()) {
    const auto end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trim(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto equals = line.find('=');
    if (!line.starts_with('$') || equals == std::string_view::npos) continue;
    const auto value = parse_number(trim(line.substr(equals + 1)));
    some = some || value;
    const auto* known = find_parameter(definition, std::string(trim(line.substr(1, equals - 1))));
    if (known == nullptr || !value || !std::isfinite(*value)) continue;
    out.push_back({known->name, *value * (known->quantity == SubjectQuantity::length ? 1e-3 : 1.0), name});
  }
  if (!some)
    return fail(Code::bad_input, name + ": no line '$NAME = VALUE', as a parameter file of Vicon has");
  return out;
}

Result<std::vector<analysis::SubjectValue>> read_subject_file(const std::filesystem::path& path,
                                                              const analysis::SegmentDefinition& definition) {
  constexpr std::size_t kMostBytes = 1UL << 20;
  const std::string name = path.filename().string();
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".mp") {
    const auto text = io::read_text(path, kMostBytes);
    if (!text) return std::unexpected(text.error());
    return parse_mp(*text, name, definition);
  }
  const auto vsk = io::read_vsk(path);
  if (!vsk) return std::unexpected(vsk.error());
  return subject_values(*vsk, name);
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

}  // namespace kinemark::pipeline
