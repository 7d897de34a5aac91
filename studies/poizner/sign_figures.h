// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "studies/common/study_figure.h"
#include "studies/poizner/arm_study.h"

namespace kinemark::studies {

/// Speed and its rate, d|v|/dt = v.a/|v|, of columns of velocity and acceleration; 0 of what stands still.
struct TangentialMotion {
  Eigen::VectorXd speed, acceleration;
};
[[nodiscard]] TangentialMotion tangential_motion(const Eigen::Matrix3Xd& velocity,
                                                 const Eigen::Matrix3Xd& acceleration);

/// Figure 6 of Poizner, Wooten & Salot (1986): the sign LOOK-AT[Continuative] as a line drawing (A), the
/// paths of its LEDs in space (B), and tangential velocity and acceleration of the hand (C), as
/// reconstructed.
[[nodiscard]] StudyFigure sign_figure(const ArmOutcome& arm);

}  // namespace kinemark::studies
