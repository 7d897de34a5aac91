// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/data/rig.h"
#include "kinemark/math/se3.h"
#include "kinemark/stages/calibration/bundle.h"

namespace kinemark::calibration::internal {

/// A free parameter of the bundle adjustment and the standard deviation of its prior.
struct FreeParameter {
  int camera = 0;
  int index = 0;  ///< by data::ParameterLayout
  double sigma = 0.0;
};

/// Everything that the bundle estimates.
struct BundleState {
  data::Rig rig;
  std::vector<math::SE3> world_from_tree;   // per pose
  std::vector<math::SE3> cam_from_grid;     // per camera, where there are grids
  std::vector<Eigen::Vector2d> grid_shift;  // per node: the same grid stood before every camera
};

/// Position of a grid node that is displaced by `shift`, in the grid, m.
[[nodiscard]] Eigen::Vector3d on_grid(const GridObservations& grid, int node, const Eigen::Vector2d& shift);

/// What the bundle minimises (bundle_problem.cc), and its normal equations with poses and grid nodes
/// eliminated (bundle_normal.cc).
///
/// Shared unknowns: free parameters camera by camera, then six of each grid's pose. Rows of an observation
/// are the three parts of math::eliminate_scale, over its standard deviation.
class BundleProblem {
 public:
  BundleProblem(data::Rig nominal, const StillPoses& tree, const std::vector<GridObservations>& grids,
                const BundleOptions& options);

  /// Poses of the tree that take part (default: all).
  void use_poses(std::vector<int> poses) { poses_ = std::move(poses); }
  [[nodiscard]] const std::vector<int>& poses() const { return poses_; }

  /// A copy of `state` whose cameras have a warp of this degree; the problem follows.
  [[nodiscard]] BundleState enrich(const BundleState& state, int warp_degree);

  /// Robust cost (weights fixed) and priors.
  [[nodiscard]] double cost(const BundleState& state) const;
  /// New robust weights from the misfits at `state`: 1, falling as 4 sigma / misfit beyond.
  void reweigh(const BundleState& state);

  struct Step {
    bool solved = false;
    double decrement = 0.0;  // g' A^-1 g: the predicted decrease of the cost by the whole step
    Eigen::VectorXd shared;
    std::vector<Eigen::Matrix<double, 6, 1>> poses;  // by poses()
    std::vector<Eigen::Vector2d> nodes;
  };
  /// Gauss-Newton step; keeps the factor for covariance().
  [[nodiscard]] Step solve(const BundleState& state);
  [[nodiscard]] BundleState moved(const BundleState& state, const Step& step, double share) const;

  /// Covariance of the free parameters, from the last solve().
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  [[nodiscard]] const std::vector<FreeParameter>& free() const { return free_; }

  /// Derivative of pose `p` of poses() (rotation, then translation) by the free parameters, from the last
  /// solve().
  [[nodiscard]] Eigen::MatrixXd pose_by_free(std::size_t p) const;

  struct Misfit {
    double chi2_per_dof = 0.0;
    int observations = 0, outliers = 0;
  };
  /// Misfit without weights, the worst share of the observations left out. Uses the last solve() for the
  /// degrees of freedom that priors take.
  [[nodiscard]] Misfit misfit(const BundleState& state) const;

 private:
  struct Rows;
  void set_free(const data::Rig& rig);
  [[nodiscard]] Eigen::VectorXd deviation(
      const BundleState& state) const;  // of the shared unknowns from their priors
  [[nodiscard]] int camera_columns(int camera) const;
  template <class Visit>
  void visit_observations(const BundleState& state, const Visit& visit) const;
  void add_tree(const BundleState& state, Eigen::MatrixXd& a, Eigen::VectorXd& g);
  void add_grids(const BundleState& state, Eigen::MatrixXd& a, Eigen::VectorXd& g);

  data::Rig nominal_;
  const StillPoses& tree_;
  const std::vector<GridObservations>& grids_;
  BundleOptions options_;
  std::vector<int> poses_;
  std::vector<double> tree_weight_, grid_weight_;  // robust weight of each observation
  std::vector<FreeParameter> free_;
  std::vector<int> first_column_;  // per camera and one more: of grid 0
  Eigen::VectorXd sigma_;          // of the shared unknowns
  // Kept from the last solve: eliminated rows and the factor.
  Eigen::MatrixXd pose_rows_, node_rows_;  // L^-1 W', 6 or 2 rows per block
  Eigen::VectorXd pose_right_, node_right_;
  std::vector<Eigen::Matrix<double, 6, 6>> pose_factor_;
  std::vector<Eigen::Matrix2d> node_factor_;
  Eigen::MatrixXd factor_;
  double node_freedom_ = 0.0;
};

}  // namespace kinemark::calibration::internal
