// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// All minima of a frame's cost, and whether the likelihood around the best one is the Gaussian of its
// covariance.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"
#include "kinemark/stages/skeleton/articulated/frame/pose_starts.h"

namespace kinemark::skeleton::articulated {

// Which joints a frame determines, and how well.

/// What the normal matrix H of a frame determines: its pseudo-inverse, the rank decided at `tolerance`
/// relative to the largest eigenvalue (rotations measured in units of the chain's scale()).
class FrameInformation {
 public:
  /// H for unit noise. O(n_f^3).
  void set(const Chain& chain, const Eigen::MatrixXd& H, double tolerance = 1e-7);
  [[nodiscard]] const Eigen::MatrixXd& inverse() const { return inverse_; }  ///< n_f x n_f
  [[nodiscard]] int rank() const { return rank_; }
  /// True when the frame determines a joint: no change of parameters that the frame leaves open moves it.
  [[nodiscard]] bool holds(const Eigen::Matrix3Xd& by_frame) const;
  /// Information on a joint with everything else of the frame eliminated, for unit noise; of any rank.
  [[nodiscard]] Matrix3d joint_information(const Eigen::Matrix3Xd& by_frame) const;
  /// log det of H / sigma^2, where a rotation that the data do not determine counts as known to
  /// pi rad.
  [[nodiscard]] static double log_det(const Chain& chain, const Eigen::MatrixXd& H, double sigma_m,
                                      Eigen::MatrixXd& scratch);

 private:
  Eigen::MatrixXd inverse_, open_, factor_, scaled_;
  Eigen::VectorXd scale_;
  int rank_ = 0;
};

/// Minima of a frame from all starts; owns its memory.
class ModeFinder {
 public:
  explicit ModeFinder(const Chain& chain);

  /// `solver` was given the frame `x`. Fills `modes` with the distinct minima (joints farther apart than the
  /// noise's fifth), least cost first, and their weights ~ exp(-cost / 2 sigma^2) |H|^-1/2; returns how many.
  /// `extra`: one more start, or null.
  int find(PoseSolver& solver, const double* x, double sigma_m, const ChainPose* extra, int iterations,
           std::vector<ChainMode>& modes);
  /// Whether the rigid pose of the segment that shows most markers leads to the minimum `pose` of cost `cost`
  /// as well, in a frame that shows every joint by the pose of one of its segments (shows_all_joints()). The
  /// better of the two is left in `pose` and `cost`. False: only find() knows what other minima there are.
  [[nodiscard]] bool confirm(PoseSolver& solver, double sigma_m, int iterations, ChainPose& pose,
                             double& cost);
  [[nodiscard]] PoseStarts& starts() { return starts_; }

 private:
  void refine(PoseSolver& solver, const ChainPose& start, double same_m, int iterations,
              std::vector<ChainMode>& modes);

  void reflect(PoseSolver& solver, const double* x, double sigma_m, double same_m, int iterations,
               std::vector<ChainMode>& modes);

  PoseStarts starts_;
  std::vector<Vector3d> centres_, about_;
  ChainPose mirrored_;
  ChainPose again_;
  std::vector<double> log_weight_;
  Eigen::MatrixXd H_, scratch_;
  Eigen::VectorXd b_;
  int count_ = 0;
};

/// Profile likelihood of a joint along the weakest direction of its covariance: held at +-2 and +-4 SD, all
/// else refitted. False when the rise of chi-square over the Gaussian's lies outside (0.35, 2.5): in a fold
/// (two minima that have merged) or a curved valley the covariance does not describe the likelihood.
[[nodiscard]] bool profile_is_gaussian(PoseSolver& solver, const ChainPose& best, double cost, int joint,
                                       const Matrix3d& covariance, double sigma_m);

/// Mean and variance of a joint along the weakest direction of its covariance, from the profile likelihood
/// every SD to six on either side: what the covariance should have been where the profile is not Gaussian.
struct ProfileMoments {
  Vector3d shift = Vector3d::Zero();  ///< of the mean from the best position, m
  Matrix3d more = Matrix3d::Zero();   ///< to add to the covariance, m^2; may be negative
  double variance_ratio = 1.0;        ///< of the Gaussian's along that direction
};
/// None when the profile does not end within the scan, is too narrow for its steps, or falls into a better
/// minimum. About twelve refits.
[[nodiscard]] std::optional<ProfileMoments> profile_moments(PoseSolver& solver, const ChainPose& best,
                                                            double cost, int joint,
                                                            const Matrix3d& covariance, double sigma_m);

}  // namespace kinemark::skeleton::articulated
