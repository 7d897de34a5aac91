// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording brought together with a model and solved, for the tests of internal/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/ik_options.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::motion::testing_leg {

struct Solved {
  IkOptions options;
  internal::Problem problem;
  Eigen::MatrixXd states;  ///< columns are frames, each at its best posture
};

/// Inverse kinematics of all frames, without limits.
[[nodiscard]] Solved solve(const data::ModelDescription& model, const data::Trajectories& markers);

/// Sizes of the leg's segments and the positions of these markers, with their usual priors.
[[nodiscard]] std::vector<GeometryParameter> sizes_and_positions(const data::ModelDescription& model,
                                                                 const std::vector<std::string>& markers);

}  // namespace kinemark::motion::testing_leg
