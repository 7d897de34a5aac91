// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A model's geometry from a recording of motion: the segment sizes, joint positions and marker positions at
// which inverse kinematics fits best, with their covariance; parameters that the motion does not fix are
// marked as not determined. Theory: docs/theory/scaling.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/ik_options.h"
#include "kinemark/stages/motion/scaling/geometry.h"
#include "kinemark/stages/motion/scaling/measured_joints.h"

namespace kinemark::motion {

/// Options of adapt_model().
struct AdaptOptions {
  /// Marker weights, coordinate tasks (posture where the markers leave it open) and the time range. Its loss
  /// must be square; limits are not enforced: a wrong size would push coordinates against them.
  IkOptions ik;
  /// Joint centres found elsewhere, not in the recording that is adapted to: they would count twice. They
  /// hold joints and markers together as far as parameters move them.
  std::vector<MeasuredJoint> joints;
  double marker_noise_sd_m = 0.0;  ///< per axis; 0: estimated from the residuals
  bool soft_tissue = true;  ///< test for displacements that follow the posture, and widen the bars by them
  double start_noise_sd_m =
      0.02;  ///< damping of the first steps; with a weaker one a poor start ends in another minimum
  std::int64_t max_frames = 400;  ///< >= 2; of a longer range every k-th frame is taken
  int max_iterations = 30;        ///< outer steps, >= 1
  int threads = 1;                ///< 0: all cores. Any number gives the same bits.

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

/// One number found from the motion.
struct AdaptedParameter {
  std::string name;                                ///< as given
  ParameterKind kind = ParameterKind::body_scale;  ///< what it scales or moves
  double initial = 0.0, value = 0.0;               ///< before and after, in units of the parameter
  double prior_sd = 0.0;                           ///< as given
  double sd = 0.0;                                 ///< from data and priors together
  double data_sd = 0.0;     ///< without the prior of the marker positions: from the motion alone
  bool determined = false;  ///< data, not priors, fix it
  /// Half width of the interval to report: sd where determined, else the larger of sd and data_sd.
  [[nodiscard]] double interval() const { return determined || data_sd < sd ? sd : data_sd; }
};

/// Distance between two joints of one segment, before and after.
struct AdaptedLength {
  std::string name;  ///< as SegmentLength
  /// before, after, and the standard deviation of what came out
  double initial_m = 0.0, length_m = 0.0, sd_m = 0.0;
  bool determined = false;  ///< data, not priors, fix it
};

/// A model whose geometry was fitted to a motion.
struct AdaptResult {
  data::ModelDescription model;              ///< with the new geometry
  std::vector<AdaptedParameter> parameters;  ///< in the order given
  Eigen::MatrixXd covariance;                ///< of all parameters, in their units
  std::vector<AdaptedLength> lengths;        ///< of the segments that have two joints or more
  std::vector<std::string>
      not_determined;  ///< names of the parameters and lengths that these data do not determine
  std::vector<std::string> recommendations;      ///< one sentence each
  std::int64_t frames = 0;                       ///< that took part
  int iterations = 0;                            ///< of Gauss-Newton
  bool converged = false;                        ///< false: the iteration limit was reached
  double rms_before_m = 0.0, rms_after_m = 0.0;  ///< distance of measured and model markers on these frames
  std::vector<double> time_s;                    ///< of these frames
  Eigen::MatrixXd coordinate_sd;  ///< n x frames: what the covariance makes unknown of each coordinate there
  double noise_sd_m = 0.0;        ///< per axis, marker of mean weight: from residuals, or as given
  double tissue_sd_m =
      0.0;  ///< per axis: part of the residual that follows the posture, 0 when none is found
};

/// Adapt the geometry of a model until it tracks the markers best: the sum over frames of the weighted
/// squared distances at the best pose of each frame, plus noise variance times the squared changes over their
/// prior variances and the squared distances of measured joints over their covariances.
///
/// Variable projection: every frame is solved exactly by inverse kinematics, the outer Levenberg-Marquardt
/// step uses the Schur complement S = sum Jp'W Jp - Jp'W Jq (Jq'W Jq)^-1 Jq'W Jp. Frames have no priors of
/// their own, which would accumulate. The last steps and the covariance take their derivatives at shrunk
/// postures whose scatter is that of the joints' motion, so that noise of the postures is not mistaken for
/// motion. The covariance is the inverse Schur complement there times the noise variance; with soft tissue a
/// sandwich whose middle holds displacements that follow the joint angles next to each segment.
///
/// determined: without the prior of the marker positions the standard deviation is below half the parameter's
/// prior. End segments (head, hand, toes) and limbs that keep still are not. Fails for a model with point
/// constraints, no parameters, terms or joints that do not exist, or what solve_ik() refuses. About 1 ms per
/// frame and step for a whole body with 140 parameters.
[[nodiscard]] Result<AdaptResult> adapt_model(const data::ModelDescription& model,
                                              const data::Trajectories& markers,
                                              const std::vector<GeometryParameter>& parameters,
                                              const AdaptOptions& options = {},
                                              const Progress& progress = {});

/// Adds to q_sd (and five times as much to q_bound) of a motion of the adapted model what the adaptation
/// leaves unknown of its geometry: that of the nearest frame that took part. What becomes wider than a linear
/// error bar is valid is no longer determined. The motion has the coordinates of the model.
void add_geometry_error(const AdaptResult& adapted, data::JointMotion& motion);

}  // namespace kinemark::motion
