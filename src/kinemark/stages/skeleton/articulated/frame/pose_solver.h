// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The pose of a chain of known geometry that fits one frame best, by Levenberg and Marquardt, and the
// derivatives of its cost. All work is done with sums over the frame's markers, so a step costs the same for
// 6 or 60 of them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// Knowledge about a joint from elsewhere (its path in time): adds (c - target)^T weight (c - target) to the
/// cost. weight = sigma^2 times the inverse covariance, so that one marker weighs 1 per axis.
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
class PoseSolver {
 public:
  /// Keeps a reference: the chain must outlive the solver. After a change of its geometry call set() again.
  explicit PoseSolver(const Chain& chain);

  /// Take a frame: K x 3 coordinates, NaN where not seen; weights K (empty: all 1; 0: as if not seen).
  void set(const double* x, std::span<const double> weights = {});
  [[nodiscard]] const FrameSums& sums() const { return sums_; }
  /// Whether the frame shows three markers of a segment or more, wide enough beside the noise to fix its
  /// pose; of a line two.
  [[nodiscard]] bool shows_pose(int segment, double sigma_m) const;
  /// Whether one of every joint's two segments shows its pose.
  [[nodiscard]] bool shows_all_joints(double sigma_m) const;

  /// sum w |x - prediction|^2, m^2, and the priors' part.
  [[nodiscard]] double cost(const ChainPose& pose, std::span<const JointPrior> priors = {});
  /// Improve a pose to the nearest minimum; returns its cost.
  double refine(ChainPose& pose, std::span<const JointPrior> priors = {}, int iterations = 40,
                double tolerance = 1e-10);

  /// Normal matrix H and right-hand side b at a pose, for unit noise. `observed`: the second derivative of
  /// the cost in the rotations of line segments, which describes a single frame better than its expectation.
  void normal(const ChainPose& pose, std::span<const JointPrior> priors, bool observed, Eigen::MatrixXd& H,
              Eigen::VectorXd& b);
  /// Linearize in the geometry parameters: G = d (frame gradient) / d (parameters), n_f x n_g. Adds their own
  /// normal matrix and right-hand side to Hgg and bg when given. `x` is the frame that was set.
  void linearize_geometry(const ChainPose& pose, const double* x, std::span<const double> weights,
                          Eigen::MatrixXd& G, Eigen::MatrixXd* Hgg, Eigen::VectorXd* bg) const;
  /// Derivatives of a joint's position by the frame's parameters (3 x n_f) and by the geometry's (3 x n_g).
  void joint_jacobian(const ChainPose& pose, int j, Eigen::Matrix3Xd& by_frame,
                      Eigen::Matrix3Xd& by_geometry) const;

  [[nodiscard]] const Chain& chain() const { return *chain_; }

 private:
  void add_priors(const ChainPose& pose, std::span<const JointPrior> priors);

  const Chain* chain_;
  FrameSums sums_;
  Eigen::MatrixXd H_, factor_;
  Eigen::VectorXd b_, step_, damping_;
  std::vector<Eigen::Index> rows_;
  std::vector<Vector3d> origin_, residual_;
  // Joint by joint: its lever, and the sums over all segments beyond it.
  std::vector<Matrix3d> lever_;
  std::vector<double> weight_beyond_;
  std::vector<Vector3d> residual_beyond_;
  ChainPose trial_;
  Eigen::Matrix3Xd by_frame_, by_geometry_;
};

}  // namespace kinemark::skeleton::articulated
