// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Feet that bear load without a measured force, from the residual of a free root.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/model/model.h"

namespace kinemark::motion::internal {

/// What no measured force explains in one frame, and where the feet are. Laboratory axes.
struct RootFrame {
  Eigen::Vector3d force;               ///< N; NaN where a force is unknown
  Eigen::Vector3d moment;              ///< N m, about `origin`
  Eigen::Vector3d origin;              ///< m, of the root joint
  Eigen::Vector3d centre;              ///< m, mass centre of the whole model
  std::vector<Eigen::Vector3d> feet;   ///< m, mass centre of each foot
  std::vector<std::uint8_t> on_plate;  ///< of each foot: a measured force acts on it
};

/// Frames in which one foot bears load that no force explains.
struct UnmeasuredLoad {
  int foot = 0;                                  ///< index into RootFrame::feet
  std::int64_t first_frame = 0, last_frame = 0;  ///< both ends included
  double force_max_n = 0.0;                      ///< upwards
};

/// Stretches of unmeasured load, by foot and time.
///
/// Load begins where the vertical residual exceeds a tenth of the body weight, `contact_force_n` and five
/// times its own scatter in quiet frames, and belongs to the foot nearest to the residual's centre of
/// pressure on the floor; a foot that already stands on a plate counts from a quarter of the body weight on.
/// It ends where the residual falls below 3 % of the body weight, half of `contact_force_n` and twice that
/// scatter. Stretches shorter than 30 ms are taken for misfit. O(frames x feet).
[[nodiscard]] std::vector<UnmeasuredLoad> find_unmeasured_load(const std::vector<RootFrame>& frames,
                                                               const Eigen::Vector3d& gravity,
                                                               double body_mass_kg, double contact_force_n,
                                                               double rate_hz);

/// Coordinates whose torques a force on `body` changes, those of free joints apart: of the joints between
/// the body and its root, and of what the body carries.
[[nodiscard]] std::vector<int> limb_coordinates(const model::Model& model, int body);

}  // namespace kinemark::motion::internal
