// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/segment_definition.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace kinemark::analysis {
namespace {

constexpr std::size_t kMostEntries = 2000;
constexpr std::array<std::string_view, 4> kQuantities{"number", "length", "angle", "mass"};

Status check_bodies(const SegmentDefinition& d, const std::set<std::string>& frames) {
  std::set<std::string> names;
  for (const auto& b : d.bodies) {
    if (b.name.empty() || !names.insert(b.name).second)
      return fail(Code::bad_input, fmt::format("body '{}': every body needs a name of its own", b.name));
    if (!frames.contains(b.segment))
      return fail(Code::bad_input, fmt::format("body '{}': no segment is called '{}'", b.name, b.segment));
  }
  for (const auto& j : d.joints) {
    for (const auto& end : {j.parent, j.child})
      if (!frames.contains(end))
        return fail(Code::bad_input, fmt::format("joint '{}': no segment is called '{}'", j.name, end));
    if (j.bodies.empty())
      return fail(Code::bad_input, fmt::format("joint '{}': no body is beyond it", j.name));
    std::set<std::string> beyond;
    for (const auto& b : j.bodies)
      if (!names.contains(b) || !beyond.insert(b).second)
        return fail(Code::bad_input, names.contains(b)
                                         ? fmt::format("joint '{}': body '{}' stands there twice", j.name, b)
                                         : fmt::format("joint '{}': no body is called '{}'", j.name, b));
  }
  return {};
}

}  // namespace

std::optional<SubjectQuantity> subject_quantity_of(std::string_view word) {
  const auto* const at = std::ranges::find(kQuantities, word);
  if (at == kQuantities.end()) return std::nullopt;
  return static_cast<SubjectQuantity>(at - kQuantities.begin());
}

std::string_view to_string(SubjectQuantity quantity) {
  return kQuantities[static_cast<std::size_t>(quantity)];
}

Status SegmentDefinition::check() const {
  if (const auto entries = parameters.size() + points.size() + landmarks.size() + segments.size() +
                           angles.size() + values.size() + bodies.size() + joints.size();
      entries > kMostEntries)
    return fail(Code::bad_input, fmt::format("{} entries; expected {} at most", entries, kMostEntries));
  std::set<std::pair<std::string, InTrial>> named;
  std::set<std::string> outputs, frames{"lab", "progression"};
  const auto once = [&](std::string_view kind, const std::string& name, InTrial trial) -> Status {
    if (name.empty()) return fail(Code::bad_input, fmt::format("a {} has no name", kind));
    const auto clash = [&](InTrial other) { return named.contains({name, other}); };
    const bool twice = trial == InTrial::any
                           ? clash(InTrial::any) || clash(InTrial::fixed) || clash(InTrial::moving)
                           : clash(InTrial::any) || clash(trial);
    if (twice || name == "lab" || name == "progression" || name == "pi" || name == "up")
      return fail(Code::bad_input,
                  fmt::format("{} '{}': the name stands for something else already", kind, name));
    named.emplace(name, trial);
    return {};
  };
  for (const auto& p : parameters)
    if (auto s = once("parameter", p.name, InTrial::any); !s) return s;
  for (const auto& p : points)
    if (auto s = once("point", p.name, p.trial); !s) return s;
  for (const auto& l : landmarks)
    if (auto s = once("landmark", l.name, InTrial::any); !s) return s;
  for (const auto& g : segments) {
    if (auto s = once("segment", g.name, g.trial); !s) return s;
    if (g.first == g.second)
      return fail(Code::bad_input, fmt::format("segment '{}': both directions are for one axis", g.name));
    frames.insert(g.name);
  }
  const auto output = [&](const std::string& name) -> Status {
    if (!name.empty() && outputs.insert(name).second) return {};
    return fail(Code::bad_input, fmt::format("'{}': every angle and value needs a name of its own", name));
  };
  for (const auto& a : angles) {
    if (auto s = output(a.name); !s) return s;
    for (const auto& end : {a.parent, a.child})
      if (!frames.contains(end))
        return fail(Code::bad_input, fmt::format("angle '{}': no segment is called '{}'", a.name, end));
  }
  for (const auto& l : landmarks)
    if (!frames.contains(l.segment))
      return fail(Code::bad_input,
                  fmt::format("landmark '{}': no segment is called '{}'", l.name, l.segment));
  for (const auto& v : values)
    if (auto s = output(v.name); !s) return s;
  if (auto s = check_bodies(*this, frames); !s) return s;
  for (const auto& b : bodies)
    if (!b.ground_reaction.empty())
      if (auto s = output(b.ground_reaction); !s) return s;
  for (const auto& j : joints)
    for (const auto* what : {"Force", "Moment", "Power"})
      if (auto s = output(j.name + what); !s) return s;
  if (angles.empty() && values.empty() && std::ranges::none_of(points, &Point::written) &&
      std::ranges::none_of(landmarks, &Landmark::written))
    return fail(Code::bad_input,
                "no [[angle]], no [[value]] and no point that is written: nothing to compute");
  return {};
}

}  // namespace kinemark::analysis
