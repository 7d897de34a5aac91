// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a solved motion says about its markers, for the fit that all solvers return.
#pragma once

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/internal/error_bars.h"

namespace kinemark::motion::internal {

/// Fill in what fit.markers and the fit as a whole tell of the motion's marker errors: share seen, RMS,
/// largest and mean error. @param fit  its markers are those of the motion, in the same order
void add_marker_errors(const data::JointMotion& motion, data::MarkerFit& fit);

/// Fill in the noise of each marker. @param model  has the markers of the fit, in the same order
void add_marker_noise(const model::Model& model, const MarkerVariances& variances, data::MarkerFit& fit);

}  // namespace kinemark::motion::internal
