// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/model_description.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace kinemark::data {
namespace {

template <class Range>
int index_of(const Range& range, std::string_view name, int absent) {
  const auto it =
      std::find_if(range.begin(), range.end(), [&](const auto& item) { return item.name == name; });
  return it == range.end() ? absent : static_cast<int>(it - range.begin());
}

template <class Range>
Status unique_names(const Range& range, std::string_view kind) {
  std::set<std::string_view> seen;
  for (const auto& item : range) {
    if (item.name.empty()) return fail(Code::bad_input, fmt::format("a {} has no name", kind));
    if (!seen.insert(item.name).second)
      return fail(Code::bad_input, fmt::format("{} name '{}' occurs twice", kind, item.name));
  }
  return {};
}

}  // namespace

int ModelDescription::find_body(std::string_view body) const {
  if (body == "ground") return kGround;
  return index_of(bodies, body, -2);
}
int ModelDescription::find_coordinate(std::string_view coordinate) const {
  return index_of(coordinates, coordinate, -1);
}
int ModelDescription::find_marker(std::string_view marker) const { return index_of(markers, marker, -1); }

Status ModelDescription::validate() const {
  const int n_bodies = static_cast<int>(bodies.size()), n_coordinates = static_cast<int>(coordinates.size());
  const auto is_body = [&](int i) { return i >= kGround && i < n_bodies; };
  const auto is_coordinate = [&](int i) { return i >= 0 && i < n_coordinates; };

  if (auto s = unique_names(bodies, "body"); !s) return s;
  if (auto s = unique_names(coordinates, "coordinate"); !s) return s;
  if (auto s = unique_names(markers, "marker"); !s) return s;
  for (const auto& body : bodies) {
    if (!std::isfinite(body.mass) || body.mass < 0.0)
      return fail(Code::bad_input,
                  fmt::format("body '{}' has a mass of {} kg; need 0 or more", body.name, body.mass));
    if (!body.com_in_body.allFinite() || !body.inertia_about_com.allFinite())
      return fail(Code::bad_input,
                  fmt::format("body '{}' has a mass centre or inertia that is not a number", body.name));
  }
  for (const auto& c : coordinates)
    if (!std::isfinite(c.default_value) || std::isnan(c.range_min) || std::isnan(c.range_max) ||
        c.range_min > c.range_max)
      return fail(Code::bad_input, fmt::format("coordinate '{}' has default {} and range {} to {}", c.name,
                                               c.default_value, c.range_min, c.range_max));

  // Tree: one joint per body, and walking up from any body reaches the ground.
  std::vector<int> parent(bodies.size(), -2);
  for (const auto& joint : joints) {
    if (!is_body(joint.parent_body_idx) || joint.child_body_idx < 0 || joint.child_body_idx >= n_bodies)
      return fail(Code::bad_input, fmt::format("joint '{}' connects bodies that do not exist", joint.name));
    int& p = parent[static_cast<std::size_t>(joint.child_body_idx)];
    if (p != -2)
      return fail(Code::bad_input, fmt::format("body '{}' hangs from two joints; need one",
                                               bodies[static_cast<std::size_t>(joint.child_body_idx)].name));
    p = joint.parent_body_idx;
    for (const auto& axis : joint.axes) {
      if (!axis.axis.allFinite() || axis.axis.norm() < 1e-12)
        return fail(Code::bad_input, fmt::format("joint '{}' has an axis of length zero", joint.name));
      if ((axis.coordinate_idx != -1 && !is_coordinate(axis.coordinate_idx)) ||
          (axis.second_coordinate_idx != -1 && !is_coordinate(axis.second_coordinate_idx)))
        return fail(Code::bad_input,
                    fmt::format("joint '{}' moves by a coordinate that does not exist", joint.name));
    }
    for (const auto* frame : {&joint.parent_from_joint, &joint.child_from_joint})
      if (!frame->rotation.allFinite() || !frame->translation.allFinite())
        return fail(Code::bad_input, fmt::format("joint '{}' has a frame that is not a number", joint.name));
  }
  for (int b = 0; b < n_bodies; ++b) {
    int up = b, steps = 0;
    while (up >= 0 && steps++ <= n_bodies) up = parent[static_cast<std::size_t>(up)];
    if (up != kGround)
      return fail(Code::bad_input, fmt::format("body '{}' is not connected to the ground",
                                               bodies[static_cast<std::size_t>(b)].name));
  }

  std::vector<int> source(coordinates.size(), -1);
  for (const auto& coupling : couplings) {
    if (!is_coordinate(coupling.dependent_idx) || !is_coordinate(coupling.independent_idx))
      return fail(Code::bad_input,
                  fmt::format("coupling '{}' names a coordinate that does not exist", coupling.name));
    int& s = source[static_cast<std::size_t>(coupling.dependent_idx)];
    if (s != -1)
      return fail(Code::bad_input,
                  fmt::format("coordinate '{}' depends on two couplings",
                              coordinates[static_cast<std::size_t>(coupling.dependent_idx)].name));
    s = coupling.independent_idx;
  }
  for (int c = 0; c < n_coordinates; ++c) {
    int up = c, steps = 0;
    while (up >= 0 && steps++ <= n_coordinates) up = source[static_cast<std::size_t>(up)];
    if (up >= 0)
      return fail(Code::bad_input, fmt::format("couplings of coordinate '{}' form a circle",
                                               coordinates[static_cast<std::size_t>(c)].name));
  }
  for (const auto& constraint : point_constraints)
    if (!is_body(constraint.body_a_idx) || !is_body(constraint.body_b_idx) ||
        !constraint.point_in_a.allFinite() || !constraint.point_in_b.allFinite())
      return fail(
          Code::bad_input,
          fmt::format("point constraint '{}' has a body or a point that does not exist", constraint.name));
  for (const auto& marker : markers)
    if (!is_body(marker.body_idx) || !marker.x_in_body.allFinite())
      return fail(Code::bad_input,
                  fmt::format("marker '{}' has a body or a position that is not valid", marker.name));
  return {};
}

}  // namespace kinemark::data
