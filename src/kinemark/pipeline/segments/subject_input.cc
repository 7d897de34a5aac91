// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/subject_input.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/number.h"
#include "kinemark/io/file.h"
#include "kinemark/workflow/segments/subject_values.h"

namespace kinemark::pipeline {
namespace {

using analysis::SubjectQuantity;
using workflow::find_parameter;

}  // namespace

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
  const double unit = workflow::per_shown(parameter->quantity);
  analysis::SubjectValue out{parameter->name, *value * unit, "--subject"};
  if (sd) out.sd = *sd * unit;
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

}  // namespace kinemark::pipeline
