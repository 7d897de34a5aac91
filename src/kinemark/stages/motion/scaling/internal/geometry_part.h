// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a covariance of the geometry makes unknown of the postures.
//
// At the best posture of a frame Jq'W r = 0; a change dx of the geometry moves it by
//     dq = - E (Jq'W Jq)^-1 Jq'W Jp dx,
// to first order and for small residuals r.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/internal/schur.h"

namespace kinemark::motion::internal {

/// n x frames, standard deviations; 0 where no marker is seen. @param states  best ones, a column per frame
[[nodiscard]] Eigen::MatrixXd geometry_part(const Problem& problem, const GeometryLayout& layout,
                                            const data::Trajectories& markers, const Eigen::MatrixXd& states,
                                            const Eigen::MatrixXd& covariance, int threads);

}  // namespace kinemark::motion::internal
