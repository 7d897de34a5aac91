// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/internal/start.h"
#include "kinemark/stages/motion/smoother/observations.h"

namespace kinemark::motion::internal {

struct StepModes {
  Eigen::MatrixXd precision;  ///< speeds x speeds, inverse of the covariance of a third difference
  Eigen::MatrixXd basis;      ///< speeds x modes
  Eigen::MatrixXd spread;     ///< modes x frames, variance by what is not known of their strengths

  /// Variance by it of E x, per row of E, in a frame.
  [[nodiscard]] Eigen::VectorXd variance(const Eigen::MatrixXd& E, std::int64_t f) const {
    return (E * basis).array().square().matrix() * spread.col(f);
  }
};

/// Inverse of the covariance of a third difference of all speeds together, from the least-squares solution.
///
/// In the basis in which both the mean information of the markers and the given variances are diagonal, noise
/// and steps are independent, so that the smoother of the whole body is one of single numbers. The strength
/// of each of these modes is that of its nearest curve (nearest_curve()). Joints that turn together, so that
/// the segments beyond stay where they are, get the covariance that they have.
/// @param paths  of the speeds by themselves; fixed ones and those of which no marker tells keep their
/// variance
/// @param beyond_white  of NoiseSplit; above 100 all variances stay as given
[[nodiscard]] StepModes step_modes(const model::Model& model, const Observations& observations,
                                   const std::vector<std::uint8_t>& fixed, const Eigen::MatrixXd& states,
                                   const SinglePaths& paths, double beyond_white);

}  // namespace kinemark::motion::internal
