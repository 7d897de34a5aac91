// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The whole-trajectory smoother: the one motion of the model that fits all frames of a recording at once,
// when every coordinate's jerk is white noise of a strength that the data tell. Coordinates, rates and
// accelerations come out together, with their covariance; markers that are missing are bridged. Theory:
// docs/theory/trajectory-smoother.md
#pragma once

#include "kinemark/core/progress.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/smoother/rates.h"
#include "kinemark/stages/motion/smoother/smoother_options.h"

namespace kinemark::motion {

/// What the smoother found: the motion, and how well it fits the markers.
struct SmootherResult {
  /// q, qd, qdd, q_sd, determined, marker_error (measured minus model), status. A frame without any marker is
  /// bridged like any other gap. Determined: the SD is at most 0.5 rad or 0.5 m.
  data::JointMotion motion;
  RateErrors errors;       ///< covariance of q, qd, qdd by coordinate; empty without error bars
  data::MarkerFit fit;     ///< markers used and left out, and how well they fit
  int iterations = 0;      ///< steps over the whole recording
  bool converged = false;  ///< false: the iteration limit was reached
  double start_seconds = 0.0, solve_seconds = 0.0;  ///< wall time: least squares; smoother with error bars
};

/// Smooth every frame of the time range.
///
/// Markers are matched by name as by solve_ik(), whose solution (with the undetermined coordinates bridged)
/// is the start; the strength of the jerk of each coordinate maximises the likelihood of that solution. The
/// noise of the markers is estimated as for its error bars and split into a white part, which smoothing
/// averages out, and a slow part (soft tissue), which it does not: both are in q_sd. Needs 8 frames. About
/// 1 ms per frame for a whole body. Errors as of solve_ik().
[[nodiscard]] Result<SmootherResult> smooth_motion(const model::Model& model,
                                                   const data::Trajectories& markers,
                                                   const SmootherOptions& options = {},
                                                   const Progress& progress = {});

}  // namespace kinemark::motion
