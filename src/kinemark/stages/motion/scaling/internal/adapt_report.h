// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Values and uncertainties of each parameter and of the lengths computed from them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::motion::internal {

/// Fills model, parameters, lengths and not_determined from the change found, the result's covariance and the
/// covariance without the prior of the marker positions.
void describe(const data::ModelDescription& model, const std::vector<GeometryParameter>& parameters,
              const Eigen::VectorXd& change, const Eigen::MatrixXd& data_covariance, AdaptResult& result);

}  // namespace kinemark::motion::internal
