// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/stages/motion/internal/frame_solver.h"

namespace kinemark::motion::internal {

/// Pose of a frame without a previous one: the given state and random ones around it, each first aligned with
/// the markers as a rigid body (free roots only), then solved; the one of least cost among at most `starts`
/// is returned. Deterministic in
/// options.seed.
FrameSolver::Outcome find_start(const Problem& problem, const IkOptions& options, FrameSolver& solver,
                                const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, std::int64_t frame,
                                int starts, Eigen::VectorXd& x);

}  // namespace kinemark::motion::internal
