// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/model/model.h"

namespace kinemark::simulation::internal {

/// Bodies that are welded together count as one. Positions are in the frame of the segment's first body, m.
struct Segment {
  int body = -1;  ///< tree index of the first body
  double mass = 0.0;
  model::Vector3d com = model::Vector3d::Zero();
  bool has_own_joint = false;  ///< moved against a parent segment (not a free root, not the ground)
  model::Vector3d own_joint = model::Vector3d::Zero();
  std::vector<model::Vector3d> carried_joints;
  std::vector<int> coordinates;  ///< that move its own and carried joints; free roots excepted

  // The segment as a capsule around the line between its joints.
  model::Vector3d line_from = model::Vector3d::Zero(), line_to = model::Vector3d::Zero();
  double length_m = 0.0;
  double radius_m = 0.0;
};

struct Segments {
  std::vector<Segment> all;
  std::vector<int> of_body;    ///< per tree index
  std::vector<int> of_marker;  ///< -1 on the ground
  std::vector<model::Vector3d> marker_in_segment;

  explicit Segments(const model::Model& model);
};

/// Point of the line from a to b nearest to p.
[[nodiscard]] model::Vector3d nearest_on_line(const model::Vector3d& a, const model::Vector3d& b,
                                              const model::Vector3d& p);

}  // namespace kinemark::simulation::internal
