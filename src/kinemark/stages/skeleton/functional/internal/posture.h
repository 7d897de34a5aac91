// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// What a coefficient of a posture term multiplies.
enum class TermKind : std::uint8_t {
  linear,     ///< a component of the posture that moves
  quadratic,  ///< a product of two components
  lag,        ///< what a component was a tenth of a second ago, less what it is
  damped,     ///< a component that hardly moves
};

/// Three linear terms, six quadratic ones, three of lag.
inline constexpr int kLinearTerms = 3, kQuadraticTerms = 6, kLagTerms = 3,
                     kPostureTerms = kLinearTerms + kQuadraticTerms + kLagTerms;

/// Posture of a joint, the rotation of child against parent: F x 3 principal components, rad, largest first,
/// about their mean, in the frames that were drawn.
struct Posture {
  std::vector<std::int64_t> frames;                  ///< F, in order of time
  double step_s = 0.0;                               ///< from one to the next, where none is left out
  Eigen::MatrixX3d component;                        ///< F x 3, rad
  Eigen::Vector3d sd_rad = Eigen::Vector3d::Zero();  ///< of each component
  /// F x 3, rad: the same smoothed in time, and damped where it hardly moves. There a component is noise of
  /// the poses, and the gap between two segments holds the same noise times the lever.
  Eigen::MatrixX3d smooth;
  bool in_time = false;    ///< frames follow each other closely enough for what is late to be told
  Eigen::Index block = 1;  ///< frames whose mean loses nothing of the posture, up to 0.2 s
  Eigen::MatrixXd terms;   ///< F x kPostureTerms, of rad and rad^2
  std::array<TermKind, kPostureTerms> kind{};  ///< of each term
};

/// Posture in some 50 frames a second of `frames`, which have a pose on either side, and in 3,000 at most.
///
/// @param frames   in order of time
/// @param rate_hz  of the recording
[[nodiscard]] Posture posture_of(const SegmentPoses& parent, const SegmentPoses& child,
                                 const RelativeMotion& motion, const std::vector<std::int64_t>& frames,
                                 double rate_hz);

/// The movement that each frame of a posture belongs to, from 0: about one axis by the swings of the first
/// component, else by those or by the distance from the median posture (0.8 s or more each), whichever finds
/// more. All 0 where frames do not follow each other.
[[nodiscard]] std::vector<int> movements_of(const Posture& posture);

}  // namespace kinemark::skeleton::internal
