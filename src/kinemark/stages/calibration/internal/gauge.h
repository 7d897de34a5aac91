// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/calibration/internal/bundle_problem.h"

namespace kinemark::calibration::internal {

/// Covariance of all parameters of all cameras (data::Rig::covariance) in the gauge that holds the cloud of
/// tree LEDs: the uncertainty of the laboratory frame as a whole is thereby removed.
///
/// A change of the free parameters moves every pose of the tree, hence the cloud as a whole, by a small rigid
/// motion; taking that motion out again moves the cameras. S-transformation, Baarda (1973).
[[nodiscard]] Eigen::MatrixXd hold_the_cloud(const data::Rig& rig, const BundleProblem& problem,
                                             const std::vector<math::SE3>& world_from_tree,
                                             const std::vector<Eigen::Vector3d>& tree);

}  // namespace kinemark::calibration::internal
