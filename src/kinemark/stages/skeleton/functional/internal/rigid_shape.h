// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The shape of a rigid set of markers, estimated from frames with missing markers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// Sum over points d about their mean of |d|^2 I - d d', from their scatter.
[[nodiscard]] Eigen::Matrix3d inertia(const Eigen::Matrix3d& scatter);

/// A shape in one frame.
struct FramePose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double squares = 0.0;        ///< of the residuals, m^2
  int visible = 0;             ///< placed markers that the frame shows; fewer than 3: no pose
  double least_inertia = 0.0;  ///< of these about any line, m^2
};

/// The shape during its estimation, and its pose in a frame. Keeps references to both arguments.
class RigidShape {
 public:
  RigidShape(const Samples& samples, const std::vector<int>& markers);

  /// Generalised Procrustes analysis on up to 3,000 frames; axes: origin at the mean, z along the longest
  /// extent, y along the least. False where no frame shows three markers.
  bool find();

  [[nodiscard]] FramePose pose(std::int64_t frame) const;
  /// Inertia about a line of all that is placed, m^2; 0 where the markers lie on one.
  [[nodiscard]] double least_inertia() const;
  /// One column a marker, m; NaN for one that could not be placed.
  [[nodiscard]] const Eigen::Matrix3Xd& positions() const { return positions_; }
  void set_positions(const Eigen::Matrix3Xd& positions) { positions_ = positions; }

 private:
  [[nodiscard]] bool placed(std::size_t k) const;
  [[nodiscard]] int seen(std::int64_t frame) const;
  [[nodiscard]] Eigen::Matrix3d scatter(std::int64_t frame) const;
  /// Of the placed markers in the shape: how many, their mean, and the sum of squares about it.
  struct Spread {
    int placed = 0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  };
  [[nodiscard]] Spread spread() const;
  [[nodiscard]] std::vector<std::int64_t> draw_frames() const;
  [[nodiscard]] std::int64_t best_start(const std::vector<std::int64_t>& frames) const;
  void start(std::int64_t frame);
  /// One round over the frames: poses, then every marker's mean position in them. Returns the largest change.
  double improve(const std::vector<std::int64_t>& frames, bool trim);
  void rotate_into_axes();

  const Samples& samples_;
  const std::vector<int>& markers_;
  Eigen::Matrix3Xd positions_;
};

}  // namespace kinemark::skeleton::internal
