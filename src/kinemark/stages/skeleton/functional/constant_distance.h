// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The method of the macaque report (after Kirk, O'Brien & Forsyth 2005): a joint keeps its distance from the
// markers of both its segments.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {

/// Options of the constant-distance method.
struct ConstantDistanceOptions {
  /// >= 2; so many frames that show every marker inform the distances: the first, or of fewer markers evenly
  int complete_frames = 30;
  double penalty_m = 1e-5;  ///< weight of the mean distances against their variances (0.01 in millimetres)

  /// Ranges hold.
  [[nodiscard]] Status check() const;
};

/// What the constant-distance method found of one joint.
struct ConstantDistanceFit {
  std::vector<int> markers;           ///< of the parent, then of the child
  Eigen::VectorXd distances_m;        ///< of each from the joint, mean over the chosen frames
  std::vector<std::int64_t> chosen;   ///< complete frames
  std::vector<int> complete;          ///< the markers that all of them show: all, or the largest set that is
                                      ///< complete in enough frames
  std::int64_t complete_frames = 0;   ///< that show all of these
  Eigen::Matrix3Xd centre_in_chosen;  ///< the joint there, m
  double distance_sd_m = 0.0;         ///< scatter of the distances over the chosen frames, RMS
  /// F: frames with two markers on one segment and one on the other, or more, have a position (m, in world).
  std::vector<Eigen::Vector3d> centre_in_world;
  std::vector<Eigen::Matrix3d> covariance;  ///< F, m^2, of the scatter of the distances alone
  std::vector<data::CentreState> state;     ///< F; ambiguous: three distances, or markers near a plane
};

/// Two steps. (1) Over the chosen frames, joint positions minimise sum_k var_f |x_fk - J_f| + penalty mean_f
/// |x_fk - J_f|, from the mean of the markers, by L-BFGS. (2) In every other frame the position is regressed
/// on the known distances (Levenberg-Marquardt from the mean of what is visible). To keep only the real
/// samples of an upsampled stream, mask the rest.
///
/// Where no two frames show every marker, (1) is of the largest set of markers that a hundred frames show
/// (fewer, where there is none), in frames spread over these; the other markers' distances are the medians of
/// (2)'s, three times over. Code::bad_input when no two frames show two markers of each segment. O(chosen K +
/// F K), and K 2^K for the set of up to 20 markers.
[[nodiscard]] Result<ConstantDistanceFit> fit_constant_distance(const Samples& samples,
                                                                const std::vector<int>& parent,
                                                                const std::vector<int>& child,
                                                                const ConstantDistanceOptions& options = {});

}  // namespace kinemark::skeleton
