// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The geometry from many frames at once: Gauss-Newton on the geometry parameters with the frames' poses
// eliminated.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"

namespace kinemark::skeleton::articulated {

/// SD of a joint about the mean of a segment's markers along an axis on which it is held, m. Held in the
/// parent and in the child, a joint is known along its axis by 1 / sqrt(2) of it. On other axes it is
/// data::kJointPriorSd_m.
constexpr double kHingeHold_m = 1e-3;

/// A joint's position relative to the mean of the markers of one of its segments, in that segment's axes, m.
[[nodiscard]] Vector3d joint_from_markers(const Chain& chain, int joint, bool in_parent);

/// Frames that inform the geometry, with their poses.
struct PosedFrames {
  std::vector<std::int64_t> frame;          ///< N, into the samples
  std::vector<ChainPose> pose;              ///< N
  std::vector<std::vector<double>> weight;  ///< N of K
  [[nodiscard]] std::size_t size() const { return frame.size(); }
};

/// Fits the geometry of `chain`, in place. Keeps references to all three. Any number of threads (0: all
/// cores) gives the same bits.
class GeometryFit {
 public:
  /// Beforehand every joint is taken to lie about the mean of its segments' markers, by
  /// data::kJointPriorSd_m. With noise `sigma_m` that says nothing beside what frames tell, and holds what
  /// they leave open (the position along a hinge's axis). 0: nothing is known beforehand.
  GeometryFit(Chain& chain, const ChainSamples& samples, PosedFrames& frames, double sigma_m = 0.0,
              int threads = 1);

  /// Damped Gauss-Newton with variable projection: S dg = sum (b_g - G^T H^-1 b), S = sum (H_gg - G^T H^-1
  /// G), each trial with all poses refined. `extra_gradient` (empty: none) is added to that of half the cost.
  /// Returns the cost, m^2, without the prior's part. `give_up` (may be empty) is asked after every step but
  /// the last with its number, from 0, and by how much the cost fell; true ends the fit.
  double run(int iterations, const Eigen::VectorXd& extra_gradient = {},
             const std::function<bool(int round, double gain_m2)>& give_up = {});
  /// Gradient of sigma^2 / 2 sum log det H by the geometry parameters, by differences: it changes the profile
  /// likelihood into the integrated one. For lines only: a solid's rotation that the data hardly determine is
  /// not Gaussian, and the term then does harm.
  [[nodiscard]] Eigen::VectorXd integrated_gradient(double sigma_m);

  /// Covariance of the geometry parameters for unit noise: zero along the gauge, that of a position known to
  /// 1 m where no frame shows anything. `sigma_m` scales only the latter.
  [[nodiscard]] Eigen::MatrixXd covariance(double sigma_m);
  /// Sum over frames of 3 n_seen - rank, less the number of geometry parameters, plus that of their gauges.
  [[nodiscard]] double degrees_of_freedom();
  /// Coordinates of markers that the frames show, 3 n_seen in all.
  [[nodiscard]] double coordinates();
  [[nodiscard]] double cost();
  /// Noise against which the prior weighs, m.
  void set_noise(double sigma_m);
  /// Hold joints along their axes at the position nearest to their markers, by kHingeHold_m, in the axes that
  /// the markers have now: a rotation of a segment's own axes, which no frame shows, does not loosen the
  /// hold.
  void hold(const std::vector<HingeAxis>& hinges);
  /// Noise variance of each marker over the common one, from residuals and their leverage, shrunk towards 1.
  [[nodiscard]] std::vector<double> marker_variance(double sigma_m);
  /// Student weights from the residuals.
  void reweigh(const std::vector<double>& own, double dof, double sigma_m);

 private:
  /// The frames of one chunk in accumulate(): their part of S and of the right-hand side.
  struct Part {
    Eigen::MatrixXd S;
    Eigen::VectorXd right;
  };

  double refine_all(const Chain& chain, std::vector<ChainPose>& poses, int iterations) const;
  void accumulate(std::int64_t begin, std::int64_t end, bool keep, Part& part);
  void find_columns();
  void accumulate(Eigen::MatrixXd& S, Eigen::VectorXd& right, bool keep);
  void add_prior(Eigen::MatrixXd& S, Eigen::VectorXd& right) const;
  [[nodiscard]] double prior_cost(const Chain& chain) const;

  /// A frame's own step after one of the geometry, U^-T (right - by_geometry * step), with H = U U^T. Empty
  /// where H has no factor.
  struct Eliminated {
    Eigen::MatrixXd factor, by_geometry;  ///< U, U^-1 G
    Eigen::VectorXd right;                ///< U^-1 b
  };

  /// A joint's position along its axis from the mean of a segment's markers is offset_m + by_geometry * (the
  /// geometry parameters).
  struct Hold {
    Eigen::VectorXd by_geometry;
    double offset_m = 0.0;
  };

  Chain& chain_;
  const ChainSamples& samples_;
  PosedFrames& frames_;
  PoseSolver solver_;
  int threads_;
  std::vector<Hold> holds_;
  // Geometry parameters that a frame's parameters see, in order: first of its translation, then segment by
  // segment of its rotation.
  std::vector<std::vector<Eigen::Index>> columns_;
  double prior_weight_ = 0.0;           // (noise / kJointPriorSd_m)^2
  std::vector<Eliminated> eliminated_;  // frame by frame
};

}  // namespace kinemark::skeleton::articulated
