// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/foreign_groups.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "kinemark/io/c3d/point_types.h"
#include "kinemark/io/c3d/provenance.h"
#include "kinemark/io/c3d/writer.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kMaxGroups = 120;
constexpr std::size_t kMaxBytes = 32'000;

using Names = std::span<const std::string_view>;

// Of the groups that are written anew: what the trial holds, or what is true of the samples as this file
// stores them.
constexpr std::array<std::string_view, 11> kPoint = {"USED",   "FRAMES",       "LONG_FRAMES", "FRAME",
                                                     "SCALE",  "RATE",         "DATA_START",  "UNITS",
                                                     "LABELS", "DESCRIPTIONS", "TYPE_GROUPS"};
constexpr std::array<std::string_view, 13> kAnalog = {
    "USED",  "RATE",         "GEN_SCALE", "SCALE", "OFFSET", "OFFSETS", "LABELS",
    "UNITS", "DESCRIPTIONS", "FORMAT",    "BITS",  "GAIN",   "RATIO"};
constexpr std::array<std::string_view, 8> kForcePlatform = {"USED",   "TYPE",    "ZERO",       "CORNERS",
                                                            "ORIGIN", "CHANNEL", "CAL_MATRIX", "FPCOPPOLY"};
constexpr std::array<std::string_view, 8> kEvent = {"USED",         "TIMES",    "LABELS",   "CONTEXTS",
                                                    "DESCRIPTIONS", "SUBJECTS", "ICON_IDS", "GENERIC_FLAGS"};
constexpr std::array<std::string_view, 2> kTrial = {"ACTUAL_START_FIELD", "ACTUAL_END_FIELD"};

/// A group that is written anew, and its parameters that are not carried.
struct WrittenAnew {
  std::string_view group;
  Names parameters;
};
constexpr std::array<WrittenAnew, 5> kWrittenAnew = {{{"POINT", kPoint},
                                                      {"ANALOG", kAnalog},
                                                      {"FORCE_PLATFORM", kForcePlatform},
                                                      {"EVENT", kEvent},
                                                      {"TRIAL", kTrial}}};
// EVENTS is read as EVENT. ROTATION tells where samples are that are not carried.
constexpr std::array<std::string_view, 3> kNotCarried = {"EVENTS", "ROTATION", kProvenanceGroup};

bool among(Names names, std::string_view name) { return std::ranges::find(names, name) != names.end(); }

/// "LABELS" of "LABELS2": lists of more than 255 go on in numbered parameters.
std::string_view stem(std::string_view name) {
  return name.substr(0, name.find_last_not_of("0123456789") + 1);
}

/// "ANGLE_UNITS" where there are ANGLES: the units of channels, which are written anew.
bool is_unit_of_channels(const C3dParameters& parameters, std::string_view name) {
  constexpr std::string_view kUnits = "_UNITS";
  if (!name.ends_with(kUnits)) return false;
  const auto type =
      std::ranges::find(kC3dPointTypes, name.substr(0, name.size() - kUnits.size()), &C3dPointType::singular);
  return type != kC3dPointTypes.end() && !parameters.texts("POINT", type->list).empty();
}

/// Lists of points that are no markers; they are channels of the trial.
bool lists_channels(const C3dParameters& parameters, std::string_view name) {
  const auto pairs = parameters.texts("POINT", "TYPE_GROUPS");
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    if (pairs[i] == name) return true;
  return std::ranges::find(kC3dPointTypes, name, &C3dPointType::list) != kC3dPointTypes.end();
}

/// The group that a writer of ours makes where nobody else recorded the trial.
bool names_us_alone(const C3dGroup& group) {
  return group.name == kC3dRecorderGroup && group.parameters.size() == 1 &&
         group.parameters.front().name == "SOFTWARE" &&
         group.parameters.front().texts == std::vector<std::string>{C3dWriteOptions{}.software};
}

bool is_carried(const C3dParameters& parameters, const C3dGroup& group, const C3dParameter& p) {
  if (p.stored.name.empty()) return false;  // it is cut short, which has been said
  const auto anew = std::ranges::find(kWrittenAnew, group.name, &WrittenAnew::group);
  if (anew == kWrittenAnew.end()) return true;
  const auto name = stem(p.name);
  return !among(anew->parameters, name) && p.name != kC3dResidualsParameter &&
         !(group.name == "POINT" &&
           (lists_channels(parameters, name) || is_unit_of_channels(parameters, name)));
}

/// Bytes of a group or parameter at most, with lengths, pointer, type and sizes.
std::size_t bytes_of(const data::ForeignParameter& p) {
  return 8 + p.name.size() + p.dims.size() + p.values.size() + p.description.size();
}

}  // namespace

std::vector<data::ForeignGroup> find_foreign_groups(const C3dParameters& parameters,
                                                    std::vector<std::string>& warnings) {
  std::vector<data::ForeignGroup> found;
  std::size_t total = 0;
  std::size_t left_out = 0;
  for (const C3dGroup& group : parameters.groups) {
    if (group.stored.name.empty() || among(kNotCarried, group.name) || names_us_alone(group)) continue;
    data::ForeignGroup foreign = group.stored;
    std::size_t bytes = 8 + foreign.name.size() + foreign.description.size();
    for (const C3dParameter& p : group.parameters) {
      if (!is_carried(parameters, group, p)) continue;
      bytes += bytes_of(p.stored);
      foreign.parameters.push_back(p.stored);
    }
    const bool is_written =
        std::ranges::find(kWrittenAnew, group.name, &WrittenAnew::group) != kWrittenAnew.end();
    if (is_written && foreign.parameters.empty()) continue;
    if (found.size() == kMaxGroups || total + bytes > kMaxBytes) {
      ++left_out;
      continue;
    }
    total += bytes;
    found.push_back(std::move(foreign));
  }
  if (left_out > 0)
    warnings.push_back(fmt::format(
        "{} that kinemark does not read {} too large to be carried into a copy",
        left_out == 1 ? "1 group of parameters" : fmt::format("{} groups of parameters", left_out),
        left_out == 1 ? "is" : "are"));
  return found;
}

}  // namespace kinemark::io
