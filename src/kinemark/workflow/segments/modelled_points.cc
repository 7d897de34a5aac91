// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/internal/modelled_points.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/data/name_index.h"

namespace kinemark::workflow {
namespace {

using analysis::Formula;

void collect(const Formula& formula, std::set<std::string>& names) {
  if (formula.kind == Formula::Kind::name) names.insert(formula.name);
  for (const auto& argument : formula.arguments) collect(argument, names);
}

bool seen(const data::Trajectories& markers, std::int64_t m) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (markers.present(f, m)) return true;
  return false;
}

// "_M": what laboratories put behind, or before the last letter of, names of outputs.
bool is_suffix(std::string_view text) {
  constexpr std::size_t kLongest = 5;
  return text.size() > 1 && text.size() <= kLongest && text.front() == '_';
}

}  // namespace

std::set<std::string> names_of_points(const analysis::SegmentDefinition& d) {
  std::set<std::string> out;
  for (const auto& p : d.parameters) {
    if (p.measured) collect(*p.measured, out);
    if (p.formula) collect(*p.formula, out);
    for (const auto& f : p.shown) collect(f, out);
  }
  for (const auto& p : d.points) {
    collect(p.formula, out);
    out.insert(p.also.begin(), p.also.end());
  }
  for (const auto& l : d.landmarks) collect(l.formula, out);
  for (const auto& s : d.segments)
    for (const auto* f : {&s.origin, &s.first_along, &s.second_along}) collect(*f, out);
  for (const auto& v : d.values) collect(v.formula, out);
  for (const auto& b : d.bodies) {
    collect(b.centre, out);
    for (const auto& f : b.floor) collect(f, out);
  }
  for (const auto& j : d.joints) collect(j.centre, out);
  if (d.progression) collect(d.progression->first, out);
  const auto leave_out = [&](const auto& entries) {
    for (const auto& entry : entries) out.erase(entry.name);
  };
  leave_out(d.parameters);
  leave_out(d.points);
  leave_out(d.landmarks);
  leave_out(d.segments);
  for (const char* own : {"pi", "up", "lab", "progression"}) out.erase(own);
  return out;
}

std::optional<MarkersAndModelled> with_modelled_points(const data::Trial& trial,
                                                       const std::set<std::string>& wanted) {
  const auto& channels = trial.channels;
  const auto& markers = trial.markers;
  if (channels.frames != markers.frames()) return std::nullopt;
  const data::NameIndex index(markers.names);
  std::vector<std::size_t> taken;
  std::set<std::int64_t> replaced;  // labels without a sample
  for (std::size_t c = 0; c < channels.names.size(); ++c) {
    const std::string name(data::without_prefix(channels.names[c]));
    if (channels.kinds[c] != data::ChannelKind::modeled_marker || !wanted.contains(name)) continue;
    const auto m = index.find(name);
    if (m >= 0 && seen(markers, m)) continue;
    if (m >= 0) replaced.insert(m);
    taken.push_back(c);
  }
  if (taken.empty()) return std::nullopt;
  std::vector<std::int64_t> kept;
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < markers.markers(); ++m)
    if (!replaced.contains(m)) {
      kept.push_back(m);
      names.push_back(markers.names[at(m)]);
    }
  MarkersAndModelled out;
  for (const auto c : taken) {
    names.push_back(channels.names[c]);
    out.points.push_back(channels.names[c]);
  }
  out.markers = data::Trajectories::all_missing(std::move(names), markers.time);
  const bool covariance = !markers.covariance.empty();
  if (covariance) out.markers.covariance.assign(6 * out.markers.state.size(), 0.0);
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto to = out.markers.index(f, static_cast<std::int64_t>(i)), from = markers.index(f, kept[i]);
      out.markers.state[to] = markers.state[from];
      out.markers.x(f, static_cast<std::int64_t>(i)) = markers.x(f, kept[i]);
      if (covariance)
        std::copy_n(markers.covariance.begin() + static_cast<std::ptrdiff_t>(6 * from), 6,
                    out.markers.covariance.begin() + static_cast<std::ptrdiff_t>(6 * to));
    }
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const auto c = taken[i];
      const double metres = metres_per_unit(channels.units[c]).value_or(1e-3);
      const double* x = &channels.values[(at(f) * channels.names.size() + c) * 3];
      const Eigen::Vector3d point = metres * Eigen::Vector3d(x[0], x[1], x[2]);
      if (!point.allFinite() || point.isZero(0.0)) continue;
      const auto m = static_cast<std::int64_t>(kept.size() + i);
      out.markers.x(f, m) = point;
      out.markers.state[out.markers.index(f, m)] = data::SampleState::model_filled;
    }
  }
  return out;
}

std::map<std::string, std::string> suffixed_names(const std::vector<std::string>& names,
                                                  const std::set<std::string>& wanted) {
  std::map<std::string, std::string> out;
  const data::NameIndex index(names);
  for (const auto& want : wanted) {
    if (want.size() < 4 || index.find(want) >= 0) continue;
    const std::string_view stem = std::string_view(want).substr(0, want.size() - 1);
    for (const auto& name : names) {
      const std::string_view there = data::without_prefix(name);
      const bool inside = there.size() > want.size() && there.starts_with(stem) &&
                          there.back() == want.back() &&
                          is_suffix(there.substr(stem.size(), there.size() - want.size()));
      const bool behind = there.starts_with(want) && is_suffix(there.substr(want.size()));
      if (inside || behind) out.try_emplace(want, name);
    }
  }
  return out;
}

}  // namespace kinemark::workflow
