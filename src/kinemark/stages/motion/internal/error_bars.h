// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Standard deviations of inverse kinematics that include soft tissue.
//
// The error of a marker is the sum of an independent part (variance v_i per axis) and a part that all markers
// of a segment share (variance c_b per axis, soft tissue). Both are estimated from the residuals of the whole
// recording: with P = I - J K J'W and blocks P_ik, the residuals satisfy
//     E r_i . r_j = sum_k v_k <P_ik, P_jk> + sum_b c_b <P_ib, P_jb>,      P_ib = sum of P_ik over the markers
//     k of b,
// for i = j and for pairs on one segment; least squares over all frames with v, c >= 0 gives them. Each frame
// then has the covariance K J'W S W J K with S = diag(v) + c within segments (sandwich), K the inverse of the
// normal matrix. Estimator d1 of the soft-tissue study; docs/theory/error-bars.md.
#pragma once

#include <Eigen/Core>

#include "kinemark/data/joint_motion.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik_options.h"

namespace kinemark::data {
struct Trajectories;
}

namespace kinemark::motion {

namespace internal {
struct Problem;
}

/// Variances of the marker errors, per axis, m^2.
struct MarkerVariances {
  Eigen::VectorXd own;     ///< M
  Eigen::VectorXd common;  ///< per body of the model, 0 where it carries fewer than two used markers
};

/// 1/m^2 of each marker (M) per axis, all its errors taken together; a marker has 0.3 mm at least.
[[nodiscard]] Eigen::VectorXd information_of(const model::Model& model, const MarkerVariances& variances);

/// What the residuals of frames say of the variances, added up frame by frame in constant memory.
class VarianceSums {
 public:
  /// `problem` must outlive it.
  explicit VarianceSums(const internal::Problem& problem);
  VarianceSums(VarianceSums&&) noexcept;
  VarianceSums& operator=(VarianceSums&&) noexcept;
  VarianceSums(const VarianceSums&) = delete;
  VarianceSums& operator=(const VarianceSums&) = delete;
  ~VarianceSums();

  /// One frame solved to `state`: markers y (3 x M), seen where `weight` (M) is above 0. 1 ms for 40 markers.
  void add(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, const Eigen::VectorXd& state);
  /// Those of other frames of the same problem.
  void add(const VarianceSums& other);
  /// Of all frames so far; of all markers together while they are too few for single ones.
  [[nodiscard]] MarkerVariances variances() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Estimate the variances from the residuals at the solved states (one column per frame). Every k-th frame is
/// used, 300 at most. The less the residuals show of a marker, the more it has the pooled variance.
[[nodiscard]] MarkerVariances estimate_variances(const internal::Problem& problem,
                                                 const data::Trajectories& markers,
                                                 const Eigen::MatrixXd& states, int threads);

/// Fill q_sd and determined of `motion`, whose q is set.
///
/// determined: with the markers of the frame alone, coordinate error per metre of marker error is below 333
/// rad (a marker lever of 3 mm), or 20 m for translations, and the standard deviation below 0.5 rad or 0.5 m,
/// the range in which a linear error bar is valid; tasks and limits do not count. q_sd is NaN where not
/// determined and 0 where locked. open_frames counts where the first of these was not so.
void compute_error_bars(const internal::Problem& problem, const data::Trajectories& markers,
                        const Eigen::MatrixXd& states, const MarkerVariances& variances, int threads,
                        data::JointMotion& motion);

namespace internal {

/// Adds a further variance to the deviation of one number of a motion, and five times what it grows by to its
/// bound where there is one. What becomes wider than a linear error bar is valid is no longer determined.
void widen(data::JointMotion& motion, std::size_t index, double variance);

}  // namespace internal

}  // namespace kinemark::motion
