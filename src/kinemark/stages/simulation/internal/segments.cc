// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"

namespace kinemark::simulation::internal {
namespace {

using model::Vector3d;

constexpr double kShortestLength_m = 0.15;
constexpr double kThickestRadius_m = 0.16;
constexpr double kDensity = 1050.0;  // kg/m^3

// The line a segment's flesh lies around: from its own joint to the middle of those that it carries, or as
// far beyond its mass centre; a root's starts at the mass centre.
void shape(Segment& segment) {
  segment.line_from = segment.has_own_joint ? segment.own_joint : segment.com;
  if (segment.carried_joints.empty()) {
    segment.line_to = 2.0 * segment.com - segment.line_from;
  } else {
    segment.line_to.setZero();
    for (const auto& joint : segment.carried_joints)
      segment.line_to += joint / static_cast<double>(segment.carried_joints.size());
  }
  segment.length_m = std::max(kShortestLength_m, (segment.line_to - segment.line_from).norm());
  segment.radius_m =
      std::min(kThickestRadius_m, std::sqrt(segment.mass / (kDensity * std::numbers::pi * segment.length_m)));
}

}  // namespace

Vector3d nearest_on_line(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const Vector3d along = b - a;
  const double square = along.squaredNorm();
  return square < 1e-18 ? a : Vector3d(a + std::clamp((p - a).dot(along) / square, 0.0, 1.0) * along);
}

Segments::Segments(const model::Model& model) {
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  const auto bodies = model.bodies();
  const auto in_segment = [&](int s, const Vector3d& x_in_world) -> Vector3d {
    const auto body = at(all[at(s)].body);
    return w.rotation[body].transpose() * (x_in_world - w.position[body]);
  };

  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& body = bodies[b];
    const bool welded = body.parent >= 0 && body.first_column == body.last_column;
    if (!welded) {
      Segment segment;
      segment.body = static_cast<int>(b);
      all.push_back(segment);
    }
    of_body.push_back(welded ? of_body[at(body.parent)] : static_cast<int>(all.size()) - 1);
    Segment& own = all[at(of_body.back())];
    const Vector3d com = in_segment(of_body.back(), w.position[b] + w.rotation[b] * body.com_in_body);
    if (own.mass + body.mass > 0.0) own.com = (own.mass * own.com + body.mass * com) / (own.mass + body.mass);
    own.mass += body.mass;
    if (welded || body.parent < 0) continue;

    own.has_own_joint = true;
    own.own_joint = body.body_from_joint.translation;
    Segment& parent = all[at(of_body[at(body.parent)])];
    parent.carried_joints.push_back(in_segment(
        of_body[at(body.parent)], model::point_in_world(w, body.parent, body.parent_from_joint.translation)));
    for (int k = body.first_primitive; k < body.last_primitive; ++k)
      for (const int c : {model.primitives()[at(k)].coordinate, model.primitives()[at(k)].second_coordinate})
        for (Segment* segment : {&own, &parent})
          if (c >= 0 && std::ranges::find(segment->coordinates, c) == segment->coordinates.end())
            segment->coordinates.push_back(c);
  }
  for (auto& segment : all) shape(segment);
  for (int m = 0; m < model.marker_count(); ++m) {
    const int body = model.markers()[at(m)].body;
    of_marker.push_back(body < 0 ? -1 : of_body[at(body)]);
    marker_in_segment.push_back(body < 0 ? Vector3d(w.marker.col(m))
                                         : in_segment(of_marker.back(), w.marker.col(m)));
  }
}

}  // namespace kinemark::simulation::internal
