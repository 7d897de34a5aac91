// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/point_types.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace kinemark::io {
namespace {

using data::ChannelKind;

struct Type {
  ChannelKind kind;
  std::string unit;
};

Type type_of(const C3dParameters& parameters, ChannelKind kind, std::string_view singular) {
  std::string unit = parameters.text("POINT", std::string(singular) + "_UNITS");
  if (unit.empty() && kind == ChannelKind::modeled_marker) unit = parameters.text("POINT", "UNITS");
  return {kind, std::move(unit)};
}

/// Type of each label that a list names; the first list that names it decides.
std::map<std::string, Type, std::less<>> listed_types(const C3dParameters& parameters) {
  std::map<std::string, Type, std::less<>> types;
  const auto add = [&](std::string_view list, std::string_view singular, ChannelKind kind) {
    for (const std::string& label : parameters.texts("POINT", list))
      if (!label.empty()) types.try_emplace(label, type_of(parameters, kind, singular));
  };
  for (const C3dPointType& type : kC3dPointTypes) add(type.list, type.singular, type.kind);
  // Pairs of a list's name and its singular. Those of our own choice above are there already.
  const std::vector<std::string> pairs = parameters.texts("POINT", "TYPE_GROUPS");
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    if (pairs[i] != "LABELS" && pairs[i] != "DESCRIPTIONS") add(pairs[i], pairs[i + 1], ChannelKind::other);
  return types;
}

/// A list may name a point with its subject ("Anna:LKneeAngles") or without.
const Type* find_type(const std::map<std::string, Type, std::less<>>& types, std::string_view name) {
  auto found = types.find(name);
  if (found == types.end() && name.find(':') != std::string_view::npos)
    found = types.find(name.substr(name.find(':') + 1));
  return found == types.end() ? nullptr : &found->second;
}

}  // namespace

void sort_points(const C3dParameters& parameters, C3dLayout& layout, data::Trial& trial) {
  const auto types = listed_types(parameters);
  std::vector<std::string> points = std::exchange(trial.markers.names, {});
  layout.runs.clear();
  layout.channel_points.clear();
  for (std::int64_t p = 0; p < layout.points; ++p) {
    std::string& name = points[static_cast<std::size_t>(p)];
    if (const Type* type = find_type(types, name)) {
      layout.channel_points.push_back(p);
      trial.channels.names.push_back(std::move(name));
      trial.channels.kinds.push_back(type->kind);
      trial.channels.units.push_back(type->unit);
      trial.channels.rate_hz = layout.rate_hz;
      continue;
    }
    if (layout.runs.empty() || layout.runs.back().first + layout.runs.back().count < p)
      layout.runs.push_back({.first = p});
    ++layout.runs.back().count;
    trial.markers.names.push_back(std::move(name));
  }
  layout.markers = std::ssize(trial.markers.names);
}

}  // namespace kinemark::io
