// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The motion of a tree of bodies, ready to be written: who hangs from whom, and where each is in every frame.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/math/se3.h"

namespace kinemark::io {

/// Poses of N bodies in F frames.
struct PoseTree {
  /// One body.
  struct Body {
    std::string name;  ///< unique, not empty
    int parent = -1;   ///< smaller than its own index; -1: the laboratory
    Eigen::Vector3d end_in_body = Eigen::Vector3d::Zero();  ///< its far end, m; of bodies that carry no other
  };
  std::vector<Body> bodies;                ///< N, parents before children
  TimeBase time;                           ///< F = time.frames
  std::vector<math::SE3> world_from_body;  ///< F x N, frame first, m

  /// The pose of a body in a frame.
  [[nodiscard]] const math::SE3& pose(std::int64_t frame, std::size_t body) const {
    return world_from_body[static_cast<std::size_t>(frame) * bodies.size() + body];
  }
  /// The same in the axes of the body above; in the laboratory's for one that hangs from it.
  [[nodiscard]] math::SE3 pose_in_parent(std::int64_t frame, std::size_t body) const;
  /// Whether a body's origin moves by more than `tolerance_m` along an axis of the body above.
  [[nodiscard]] bool moves_in_parent(std::size_t body, double tolerance_m) const;
  /// For each body, those that hang from it, in their order.
  [[nodiscard]] std::vector<std::vector<std::size_t>> children() const;

  /// Shapes agree, parents come before children, names are unique, poses finite, at least one body and frame.
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::io
