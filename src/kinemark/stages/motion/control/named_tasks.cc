// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/motion/control/track_options.h"

namespace kinemark::motion {
namespace {

using Kind = NamedTask::Kind;
using Unit = NamedTask::Unit;

constexpr std::array<std::pair<std::string_view, Kind>, 4> kKinds{{{"orientation:", Kind::orientation},
                                                                   {"coordinate:", Kind::coordinate},
                                                                   {"distance:", Kind::distance},
                                                                   {"com:", Kind::mass_centre}}};

struct UnitName {
  std::string_view ending;
  Unit unit;
  double factor;
};
// "mm" before "m".
constexpr std::array<UnitName, 4> kUnits{{{"deg", Unit::angle, kRadPerDeg},
                                          {"rad", Unit::angle, 1.0},
                                          {"mm", Unit::length, 1e-3},
                                          {"m", Unit::length, 1.0}}};

/// Number with or without its unit; false: it is none.
bool read_value(std::string_view text, NamedTask& task) {
  double factor = 1.0;
  for (const auto& unit : kUnits)
    if (text.ends_with(unit.ending)) {
      text.remove_suffix(unit.ending.size());
      task.unit = unit.unit;
      factor = unit.factor;
      break;
    }
  const auto number = parse_number(text);
  if (!number || !std::isfinite(*number)) return false;
  task.value = factor * *number;
  return true;
}

Result<NamedTask> read_task(std::string_view word, std::string_view rest, Kind kind) {
  NamedTask task{.kind = kind, .name = std::string(rest), .text = std::string(word)};
  const bool is_held = kind == Kind::coordinate || kind == Kind::mass_centre;
  if (!is_held) {
    const bool is_pair = kind != Kind::distance || rest.find('-') != std::string_view::npos;
    if (!rest.empty() && is_pair) return task;
    return fail(Code::usage, fmt::format("task '{}' names no {}", word,
                                         kind == Kind::distance ? "two markers; need distance:MARKER-MARKER"
                                                                : "body; need orientation:BODY"));
  }
  const auto equals = rest.rfind('=');
  const auto need = kind == Kind::coordinate ? "coordinate:NAME=VALUE, as coordinate:elbow=90deg"
                                             : "com:AXIS=VALUE, as com:x=0.12m";
  if (equals == std::string_view::npos || equals == 0)
    return fail(Code::usage, fmt::format("task '{}' holds nothing at a value; need {}", word, need));
  task.name = std::string(rest.substr(0, equals));
  const auto value = rest.substr(equals + 1);
  if (kind == Kind::coordinate && value == "rest") {
    task.value = kNaN;
    return task;
  }
  if (!read_value(value, task))
    return fail(Code::usage,
                fmt::format("task '{}' has the value '{}', which is no number; need {}", word, value, need));
  return task;
}

}  // namespace

std::vector<std::string> TrackLevel::names() const {
  std::vector<std::string> out;
  for (const auto& task : named) out.push_back(task.text);
  out.insert(out.end(), markers.begin(), markers.end());
  return out;
}

Result<TrackLevel> TrackLevel::parse(std::string_view text) {
  TrackLevel level;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(',', begin), text.size());
    const auto word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty())
      return fail(Code::usage, fmt::format("level '{}' has an empty name; need MARKER,MARKER,...", text));
    std::optional<Result<NamedTask>> task;
    for (const auto& [prefix, kind] : kKinds)
      if (word.starts_with(prefix)) task = read_task(word, word.substr(prefix.size()), kind);
    if (!task) {
      level.markers.emplace_back(word);
      continue;
    }
    if (!*task) return std::unexpected(task->error());
    level.named.push_back(std::move(**task));
  }
  return level;
}

}  // namespace kinemark::motion
