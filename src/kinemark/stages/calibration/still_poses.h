// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Still observations: mean counts of a recording of an object at rest.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"

namespace kinemark::calibration {

/// Mean of the counts that one camera made of one LED while nothing moved.
struct StillObservation {
  Eigen::Vector4d counts = Eigen::Vector4d::Zero();           ///< of channels +x, -x, +y, -y
  double variance = 0.0;                                      ///< of each mean, counts^2; 0: not seen
  [[nodiscard]] bool seen() const { return variance > 0.0; }  ///< whether there is a mean
};

/// An object of L LEDs, held still in P poses.
struct StillPoses {
  std::vector<Eigen::Vector3d> tree;           ///< L positions of its LEDs in its own frame, m
  int cameras = 0;                             ///< C
  std::vector<StillObservation> observations;  ///< P x L x C
  std::int64_t frames_left_over = 0;  ///< at the end, of a pose that was not recorded to its end; not used

  [[nodiscard]] int leds() const { return static_cast<int>(tree.size()); }  ///< L
  /// P
  [[nodiscard]] int poses() const {
    return tree.empty() || cameras == 0 ? 0 : static_cast<int>(observations.size()) / (leds() * cameras);
  }
  /// One observation of one pose.
  [[nodiscard]] const StillObservation& at(int pose, int led, int camera) const {
    return observations[static_cast<std::size_t>((pose * leds() + led) * cameras + camera)];
  }
};

/// A plane grid of nodes x nodes LEDs before one camera, square to its axis.
struct GridObservations {
  int nodes = 15;                              ///< along each side
  double spacing_m = 1.0 / 14.0;               ///< between neighbours
  double distance_m = 3.0;                     ///< from the lens, along the axis
  std::vector<StillObservation> observations;  ///< node (i, j), i to the right, j down, at i * nodes + j

  /// Position of a node on the grid, m from its middle.
  [[nodiscard]] Eigen::Vector2d position_m(int i, int j) const {
    const double middle = 0.5 * (nodes - 1);
    return spacing_m * Eigen::Vector2d(i - middle, j - middle);
  }
};

/// Options of averaging over frames in which nothing moves.
struct StillOptions {
  double flicker_counts = 1.0;  ///< amplitude of light that flickers at flicker_hz, as far as it is unknown
  double flicker_hz = 120.0;    ///< of the room's lamps
};

/// Frames [first, first + count).
struct FrameRange {
  std::int64_t first = 0, count = 0;  ///< first of them, and how many
};

/// Mean of an LED's counts over some frames, with its variance: noise of the conversions and the residual
/// flicker after averaging. Not seen when the LED was occluded, lost, saturated or dark in one of them, or
/// moved: the scatter of its counts is beyond chance.
[[nodiscard]] StillObservation still_observation(const data::Counts& counts,
                                                 const data::Electronics& electronics,
                                                 const FrameRange& frames, std::int64_t led,
                                                 std::int64_t camera, const StillOptions& options = {});

/// The three vertices of the 1986 orientation tree from its sides, m: 0-1, 0-2, 1-2; level, its centroid at
/// the origin, vertex 2 to the front (+z). Fails on sides that close no triangle.
[[nodiscard]] Result<std::vector<Eigen::Vector3d>> tree_from_sides(const std::vector<double>& sides_m);

/// Means over runs of `frames_per_pose` frames, by still_observation().
///
/// Fails when the LEDs of tree and recording, or the cameras of rig and recording, are not equal in number,
/// and when there is no whole pose; frames of a last pose that was cut off are left over.
[[nodiscard]] Result<StillPoses> still_poses(const data::Counts& counts, const data::Rig& rig,
                                             std::vector<Eigen::Vector3d> tree, int frames_per_pose,
                                             const StillOptions& options = {});

}  // namespace kinemark::calibration
