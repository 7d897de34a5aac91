// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The normal equations of the bundle: one block a pose of the tree and a node of the grid, eliminated into
// those of cameras and grids; their solution and what follows from its factor.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <span>

#include "kinemark/camera/response.h"
#include "kinemark/math/scale_free.h"
#include "kinemark/math/se3.h"
#include "kinemark/stages/calibration/internal/bundle_problem.h"

namespace kinemark::calibration::internal {
namespace {

using data::ParameterLayout;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kFlat = 1e-9;  // keeps a pose seen by one camera only from being singular

}  // namespace

/// Jacobians of one observation, weighted: three rows by the camera's free parameters, and by the point in
/// the world.
struct BundleProblem::Rows {
  Vector3d residual;
  Eigen::Matrix3d d_point;
  Eigen::Matrix<double, 3, Eigen::Dynamic> d_free;
  Eigen::Matrix<double, 4, Eigen::Dynamic> d_all;

  void fill(const data::Camera& camera, const Vector3d& x, const StillObservation& seen, double weight,
            std::span<const FreeParameter> free) {
    const ParameterLayout layout(camera);
    d_all.resize(4, layout.count);
    const auto response = camera::respond(camera, x, d_all);
    const auto left = math::eliminate_scale(seen.counts - camera.detector.offset_counts, response.phi);
    const double scale = std::sqrt(weight / seen.variance);
    residual = scale * left.residual;
    const Eigen::Matrix<double, 3, 4> by_phi = (-scale * left.scale) * left.basis;
    d_point = by_phi * response.d_point;
    d_free.resize(3, static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k)
      d_free.col(static_cast<Eigen::Index>(k)) =
          free[k].index >= layout.offset ? Vector3d(-scale * left.basis.col(free[k].index - layout.offset))
                                         : Vector3d(by_phi * d_all.col(free[k].index));
  }
};

void BundleProblem::add_tree(const BundleState& state, MatrixXd& a, VectorXd& g) {
  const int columns = first_column_.back();
  const auto count = static_cast<Eigen::Index>(poses_.size());
  pose_rows_.setZero(6 * count, sigma_.size());
  pose_right_.setZero(6 * count);
  pose_factor_.assign(poses_.size(), Matrix6d::Zero());
  std::vector<Matrix6d> h(poses_.size(), kFlat * Matrix6d::Identity());
  std::vector<Vector6d> b(poses_.size(), Vector6d::Zero());
  MatrixXd stacked;
  VectorXd residuals;
  Rows rows;
  for (int c = 0; c < tree_.cameras; ++c) {
    const int first = first_column_[static_cast<std::size_t>(c)], width = camera_columns(c);
    const std::span<const FreeParameter> free(free_.data() + first, static_cast<std::size_t>(width));
    const auto& camera = state.rig.cameras[static_cast<std::size_t>(c)];
    stacked.setZero(3 * count * tree_.leds(), width);
    residuals.setZero(stacked.rows());
    Eigen::Index row = 0;
    for (std::size_t p = 0; p < poses_.size(); ++p) {
      const math::SE3& pose = state.world_from_tree[static_cast<std::size_t>(poses_[p])];
      auto w = pose_rows_.block(6 * static_cast<Eigen::Index>(p), first, 6, width);
      for (int led = 0; led < tree_.leds(); ++led) {
        const auto& seen = tree_.at(poses_[p], led, c);
        if (!seen.seen()) continue;
        const Vector3d arm = pose.rotation * tree_.tree[static_cast<std::size_t>(led)];
        rows.fill(
            camera, arm + pose.translation, seen,
            tree_weight_[static_cast<std::size_t>((poses_[p] * tree_.leds() + led) * tree_.cameras + c)],
            free);
        Eigen::Matrix<double, 3, 6> d_pose;
        d_pose << -rows.d_point * math::skew(arm), rows.d_point;
        h[p] += d_pose.transpose() * d_pose;
        b[p] += d_pose.transpose() * rows.residual;
        w += d_pose.transpose() * rows.d_free;
        stacked.middleRows<3>(row) = rows.d_free;
        residuals.segment<3>(row) = rows.residual;
        row += 3;
      }
    }
    a.block(first, first, width, width)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(stacked.topRows(row).transpose());
    g.segment(first, width) += stacked.topRows(row).transpose() * residuals.head(row);
  }
  for (std::size_t p = 0; p < poses_.size(); ++p) {
    const auto at = 6 * static_cast<Eigen::Index>(p);
    pose_factor_[p] = h[p].llt().matrixL();
    const auto lower = pose_factor_[p].triangularView<Eigen::Lower>();
    lower.solveInPlace(pose_rows_.middleRows<6>(at));
    pose_right_.segment<6>(at) = b[p];
    lower.solveInPlace(pose_right_.segment<6>(at));
  }
  a.topLeftCorner(columns, columns)
      .selfadjointView<Eigen::Lower>()
      .rankUpdate(pose_rows_.leftCols(columns).transpose(), -1.0);
  g -= pose_rows_.transpose() * pose_right_;
}

void BundleProblem::add_grids(const BundleState& state, MatrixXd& a, VectorXd& g) {
  node_freedom_ = 0.0;
  const std::size_t nodes = state.grid_shift.size();
  const double prior = 1.0 / (options_.priors.grid_led_m * options_.priors.grid_led_m);
  node_rows_.setZero(2 * static_cast<Eigen::Index>(nodes), sigma_.size());
  node_right_.setZero(node_rows_.rows());
  node_factor_.assign(nodes, prior * Eigen::Matrix2d::Identity());
  for (std::size_t n = 0; n < nodes; ++n)
    node_right_.segment<2>(2 * static_cast<Eigen::Index>(n)) = prior * state.grid_shift[n];
  Rows rows;
  std::size_t index = 0;
  for (std::size_t c = 0; c < grids_.size(); ++c) {
    const auto& camera = state.rig.cameras[c];
    const int first = first_column_[c], width = camera_columns(static_cast<int>(c));
    const auto grid_first = static_cast<Eigen::Index>(free_.size() + 6 * c);
    const std::span<const FreeParameter> free(free_.data() + first, static_cast<std::size_t>(width));
    const math::SE3& cam_from_grid = state.cam_from_grid[c];
    const math::SE3 world_from_cam = camera.cam_from_world.inverse();
    MatrixXd stacked = MatrixXd::Zero(3 * static_cast<Eigen::Index>(nodes), width + 6);
    VectorXd residuals = VectorXd::Zero(stacked.rows());
    for (std::size_t n = 0; n < grids_[c].observations.size(); ++n, ++index) {
      const auto& seen = grids_[c].observations[n];
      if (!seen.seen()) continue;
      const Vector3d position =
          cam_from_grid.rotation * on_grid(grids_[c], static_cast<int>(n), state.grid_shift[n]);
      rows.fill(camera, world_from_cam * (position + cam_from_grid.translation), seen, grid_weight_[index],
                free);
      const auto row = 3 * static_cast<Eigen::Index>(n), at = 2 * static_cast<Eigen::Index>(n);
      // The grid's pose is relative to its camera, so that the camera's pose has no effect.
      for (int k = 0; k < width; ++k)
        if (free[static_cast<std::size_t>(k)].index < ParameterLayout::focal) rows.d_free.col(k).setZero();
      const Eigen::Matrix3d d_cam = rows.d_point * world_from_cam.rotation;
      const Eigen::Matrix<double, 3, 2> d_shift = d_cam * cam_from_grid.rotation.leftCols<2>();
      stacked.block(row, 0, 3, width) = rows.d_free;
      stacked.block<3, 3>(row, width) = -d_cam * math::skew(position);
      stacked.block<3, 3>(row, width + 3) = d_cam;
      residuals.segment<3>(row) = rows.residual;
      node_factor_[n] += d_shift.transpose() * d_shift;
      node_right_.segment<2>(at) += d_shift.transpose() * rows.residual;
      node_rows_.block(at, first, 2, width) += d_shift.transpose() * rows.d_free;
      node_rows_.block(at, grid_first, 2, 6) += d_shift.transpose() * stacked.block<3, 6>(row, width);
    }
    MatrixXd square = MatrixXd::Zero(width + 6, width + 6);
    square.selfadjointView<Eigen::Lower>().rankUpdate(stacked.transpose());
    a.block(first, first, width, width).triangularView<Eigen::Lower>() += square.topLeftCorner(width, width);
    a.block(grid_first, first, 6, width) += square.bottomLeftCorner(6, width);
    a.block<6, 6>(grid_first, grid_first).triangularView<Eigen::Lower>() += square.bottomRightCorner<6, 6>();
    const VectorXd right = stacked.transpose() * residuals;
    g.segment(first, width) += right.head(width);
    g.segment<6>(grid_first) += right.tail<6>();
  }
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto at = 2 * static_cast<Eigen::Index>(n);
    node_freedom_ += 2.0 - prior * node_factor_[n].inverse().trace();
    node_factor_[n] = Eigen::Matrix2d(node_factor_[n].llt().matrixL());
    const auto lower = node_factor_[n].triangularView<Eigen::Lower>();
    lower.solveInPlace(node_rows_.middleRows<2>(at));
    lower.solveInPlace(node_right_.segment<2>(at));
  }
  if (nodes == 0) return;
  a.selfadjointView<Eigen::Lower>().rankUpdate(node_rows_.transpose(), -1.0);
  g -= node_rows_.transpose() * node_right_;
}

BundleProblem::Step BundleProblem::solve(const BundleState& state) {
  const auto n = sigma_.size();
  MatrixXd a = MatrixXd::Zero(n, n);
  VectorXd g = deviation(state).cwiseQuotient(sigma_.cwiseAbs2());
  a.diagonal() = sigma_.cwiseAbs2().cwiseInverse();
  add_tree(state, a, g);
  add_grids(state, a, g);
  Step step;
  const Eigen::LLT<MatrixXd> llt(a);
  if (llt.info() != Eigen::Success) return step;
  factor_ = llt.matrixL();
  step.shared = -llt.solve(g);
  step.decrement = -g.dot(step.shared);
  step.solved = step.shared.allFinite();
  for (std::size_t p = 0; p < poses_.size(); ++p) {
    const auto at = 6 * static_cast<Eigen::Index>(p);
    Vector6d local = pose_right_.segment<6>(at) + pose_rows_.middleRows<6>(at) * step.shared;
    step.decrement += pose_right_.segment<6>(at).squaredNorm();
    pose_factor_[p].triangularView<Eigen::Lower>().transpose().solveInPlace(local);
    step.poses.push_back(-local);
    step.solved = step.solved && local.allFinite();
  }
  for (std::size_t k = 0; k < node_factor_.size(); ++k) {
    const auto at = 2 * static_cast<Eigen::Index>(k);
    Eigen::Vector2d local = node_right_.segment<2>(at) + node_rows_.middleRows<2>(at) * step.shared;
    step.decrement += node_right_.segment<2>(at).squaredNorm();
    node_factor_[k].triangularView<Eigen::Lower>().transpose().solveInPlace(local);
    step.nodes.push_back(-local);
  }
  return step;
}

MatrixXd BundleProblem::covariance() const {
  MatrixXd inverse = MatrixXd::Identity(factor_.rows(), factor_.cols());
  factor_.triangularView<Eigen::Lower>().solveInPlace(inverse);
  const auto n = static_cast<Eigen::Index>(free_.size());
  return inverse.leftCols(n).transpose() * inverse.leftCols(n);
}

MatrixXd BundleProblem::pose_by_free(std::size_t p) const {
  MatrixXd out =
      -pose_rows_.block(6 * static_cast<Eigen::Index>(p), 0, 6, static_cast<Eigen::Index>(free_.size()));
  pose_factor_[p].triangularView<Eigen::Lower>().transpose().solveInPlace(out);
  return out;
}

}  // namespace kinemark::calibration::internal
