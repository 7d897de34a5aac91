// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics by least squares: joint coordinates whose model markers lie nearest to the measured
// ones, frame by frame, each coordinate with its standard deviation and a flag that says whether the visible
// markers fix it. Theory: docs/theory/inverse-kinematics.md and docs/theory/error-bars.md
#pragma once

#include <cstdint>

#include "kinemark/core/progress.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/marker_fit.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::motion {

/// What solve_ik() found: the motion, and how well it fits the markers.
struct IkResult {
  data::JointMotion motion;     ///< solved frames only
  data::MarkerFit fit;          ///< markers used and left out, and how well they fit
  double cost = 0.0;            ///< sum over frames of the cost in IkOptions (square loss), m^2
  std::int64_t iterations = 0;  ///< of all frames together
  double solve_seconds =
      0.0;  ///< wall time of the poses, judged and compared with rivals, without error bars
};

/// Solve every frame of the time range.
///
/// Markers are matched by name, exactly or behind a subject prefix ("Ann:LASI"). Markers that the model lacks
/// are left out; a weight for a marker or coordinate that does not exist, no marker in common, or an empty
/// time range are errors. Frames follow each other from the first frame in which nearly all markers are seen,
/// forwards and then backwards, each starting from its neighbour; the first is found from several starts.
/// Missing markers are simply left out of the sum. About 30 us per frame for a whole body; nothing is
/// allocated per frame. Source: Levenberg-Marquardt and exact Newton on the tree, model/weighted_normal.h;
/// cost convention of OpenSim (Delp et al. 2007).
[[nodiscard]] Result<IkResult> solve_ik(const model::Model& model, const data::Trajectories& markers,
                                        const IkOptions& options = {}, const Progress& progress = {});

/// The shift (m) that must be added to all measured markers so that the model fits them best, found on up to
/// 10 frames; and the RMS marker error that would remain. Tells a recording in another position from a bad
/// fit.
struct CommonOffset {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< in the world
  double rms_before_m = 0.0, rms_after_m = 0.0;       ///< RMS marker error as it is, and with the shift
};
/// Fails as solve_ik() does.
[[nodiscard]] Result<CommonOffset> find_common_offset(const model::Model& model,
                                                      const data::Trajectories& markers,
                                                      const IkOptions& options = {});

/// Adds to q_sd of a motion of these markers what a calibration leaves unknown of all positions alike: each
/// of its fields displaces the markers, and the coordinates by the least squares of `options`, to first order
/// (a frame's markers, their weights, its tasks and loops; limits do not count). The residuals that q_sd
/// comes from show hardly anything of it. Bounds (q_bound) grow by five times as much. What becomes wider
/// than a linear error bar is valid is no longer determined. Nothing is done where the calibration is not
/// known. Fails as solve_ik() does.
[[nodiscard]] Status add_calibration_error(const model::Model& model, const data::Trajectories& markers,
                                           const data::CalibrationError& error, const IkOptions& options,
                                           data::JointMotion& motion);

/// The cost of given coordinates (F x n, rows are the frames of `markers` in the time range), for comparing
/// solvers.
[[nodiscard]] Result<double> calc_ik_cost(const model::Model& model, const data::Trajectories& markers,
                                          const IkOptions& options, const Eigen::MatrixXd& q);

}  // namespace kinemark::motion
