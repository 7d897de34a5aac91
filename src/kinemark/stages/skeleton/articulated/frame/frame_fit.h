// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One frame of a chain: the pose that fits best, by Levenberg and Marquardt, what it tells and what it does
// not. All of a frame's work is done with sums over its markers, so a step costs the same for 6 or 60 of
// them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton {

/// A joint known beforehand: adds (c - target)^T weight (c - target) to the cost. weight = sigma^2 times the
/// inverse covariance, so that one marker weighs 1 per axis.
struct JointPrior {
  int joint = 0;
  Vector3d target = Vector3d::Zero();
  Matrix3d weight = Matrix3d::Zero();
};

/// Sums over the seen markers of one frame, segment by segment, about the frame's mean.
struct FrameSums {
  struct Segment {
    double w = 0.0;                  ///< sum of weights
    Vector3d m = Vector3d::Zero();   ///< sum w m
    Vector3d x = Vector3d::Zero();   ///< sum w (x - centre)
    Matrix3d mm = Matrix3d::Zero();  ///< sum w m m^T
    Matrix3d xm = Matrix3d::Zero();  ///< sum w (x - centre) m^T
    double xx = 0.0;                 ///< sum w |x - centre|^2
    int seen = 0;
  };
  Vector3d centre = Vector3d::Zero();  ///< mean of the seen markers, m
  std::vector<Segment> segment;        ///< S
  int seen = 0;
};

/// Works on one frame at a time; owns the scratch memory. Not for several threads at once.
class FrameSolver {
 public:
  /// Keeps a reference: the chain must outlive the solver. After a change of its geometry call set() again.
  explicit FrameSolver(const Chain& chain);

  /// Take a frame: K x 3 coordinates, NaN where not seen; weights K (empty: all 1; 0: as if not seen).
  void set(const double* x, std::span<const double> weights = {});
  [[nodiscard]] const FrameSums& sums() const { return sums_; }

  /// sum w |x - prediction|^2, m^2, and the priors' part.
  [[nodiscard]] double cost(const ChainPose& pose, std::span<const JointPrior> priors = {});
  /// Improve a pose to the nearest minimum; returns its cost.
  double refine(ChainPose& pose, std::span<const JointPrior> priors = {}, int iterations = 40,
                double tolerance = 1e-10);

  /// Normal matrix H and right-hand side b at a pose, for unit noise. `observed`: the second derivative of
  /// the cost in the turns of line segments, which describes a single frame better than its expectation.
  void normal(const ChainPose& pose, std::span<const JointPrior> priors, bool observed, Eigen::MatrixXd& H,
              Eigen::VectorXd& b);
  /// d (frame gradient) / d globals, n_f x n_g; adds to the globals' own block and gradient when given.
  /// `x` is the frame that was set.
  void globals(const ChainPose& pose, const double* x, std::span<const double> weights, Eigen::MatrixXd& G,
               Eigen::MatrixXd* Hgg, Eigen::VectorXd* bg) const;
  /// d joint / d frame parameters (3 x n_f) and / d globals (3 x n_g).
  void joint_jacobian(const ChainPose& pose, int j, Eigen::Matrix3Xd& by_frame,
                      Eigen::Matrix3Xd& by_globals) const;

  [[nodiscard]] const Chain& chain() const { return *chain_; }

 private:
  void add_priors(const ChainPose& pose, std::span<const JointPrior> priors);

  const Chain* chain_;
  FrameSums sums_;
  Eigen::MatrixXd H_, factor_;
  Eigen::VectorXd b_, step_, damping_;
  std::vector<Vector3d> origin_, residual_;
  ChainPose trial_;
  Eigen::Matrix3Xd by_frame_, by_globals_;
};

/// What a frame's information says about its joints: pseudo-inverse of H with the rank decided at `tolerance`
/// relative to the largest eigenvalue (turns measured in units of the chain's scale()).
class FrameInformation {
 public:
  /// H for unit noise. O(n_f^3).
  void set(const Chain& chain, const Eigen::MatrixXd& H, double tolerance = 1e-7);
  [[nodiscard]] const Eigen::MatrixXd& inverse() const { return inverse_; }  ///< n_f x n_f
  [[nodiscard]] int rank() const { return rank_; }
  /// A joint is held when its row space does not touch what the frame leaves open.
  [[nodiscard]] bool holds(const Eigen::Matrix3Xd& by_frame) const;
  /// Information on a joint with everything else of the frame eliminated, for unit noise; of any rank.
  [[nodiscard]] Matrix3d joint_information(const Eigen::Matrix3Xd& by_frame) const;
  /// log det of H / sigma^2, where a turn that the data do not fix counts as free by half a turn.
  [[nodiscard]] static double log_det(const Chain& chain, const Eigen::MatrixXd& H, double sigma_m,
                                      Eigen::MatrixXd& scratch);

 private:
  Eigen::MatrixXd inverse_, open_, factor_, scaled_;
  Eigen::VectorXd scale_;
  int rank_ = 0;
};

}  // namespace kinemark::skeleton
