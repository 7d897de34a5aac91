// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/frame_information.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/stages/skeleton/articulated/chain/small_cholesky.h"

namespace kinemark::skeleton::articulated {

void FrameInformation::set(const Chain& chain, const Eigen::MatrixXd& H, double tolerance) {
  const Eigen::Index n = H.rows();
  scale_.resize(n);
  scale_.head(3).setOnes();
  scale_.tail(n - 3).setConstant(1.0 / chain.scale());
  factor_ = scale_.asDiagonal() * H * scale_.asDiagonal();
  const double largest = factor_.diagonal().maxCoeff();
  scaled_ = factor_;
  open_.resize(n, 0);
  rank_ = static_cast<int>(n);
  // Pivots far above the tolerance: full rank without looking at eigenvalues.
  if (cholesky(factor_, 1e-4 * largest)) {
    inverse_.setIdentity(n, n);
    for (Eigen::Index c = 0; c < n; ++c) solve_cholesky(factor_, inverse_.col(c));
    inverse_ = (scale_.asDiagonal() * inverse_ * scale_.asDiagonal()).eval();
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled_);
  const double floor = tolerance * std::max(eigen.eigenvalues()[n - 1], 1e-300);
  Eigen::Index open = 0;
  while (open < n && !(eigen.eigenvalues()[open] > floor)) ++open;
  rank_ = static_cast<int>(n - open);
  open_ = scale_.asDiagonal() * eigen.eigenvectors().leftCols(open);
  const Eigen::MatrixXd held = scale_.asDiagonal() * eigen.eigenvectors().rightCols(n - open);
  inverse_ = held * eigen.eigenvalues().tail(n - open).cwiseInverse().asDiagonal() * held.transpose();
}

bool FrameInformation::holds(const Eigen::Matrix3Xd& by_frame) const {
  for (Eigen::Index c = 0; c < open_.cols(); ++c) {
    if ((by_frame * open_.col(c)).cwiseAbs().maxCoeff() > 1e-4) return false;
  }
  return true;
}

Matrix3d FrameInformation::joint_information(const Eigen::Matrix3Xd& by_frame) const {
  Matrix3d covariance = by_frame * inverse_ * by_frame.transpose();
  if (open_.cols() > 0) {
    // Directions left open get a variance far above any that is determined; the information that remains of
    // them is set to zero below.
    const Eigen::Matrix3Xd loose = by_frame * open_;
    covariance += 1e9 * loose * loose.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
  Vector3d information = eigen.eigenvalues().cwiseMax(1e-12).cwiseInverse();
  for (int i = 0; i < 3; ++i) {
    if (information[i] < 1e-6) information[i] = 0.0;
  }
  return eigen.eigenvectors() * information.asDiagonal() * eigen.eigenvectors().transpose();
}

double FrameInformation::log_det(const Chain& chain, const Eigen::MatrixXd& H, double sigma_m,
                                 Eigen::MatrixXd& scratch) {
  const double by_variance = 1.0 / (sigma_m * sigma_m);
  scratch = by_variance * H;
  for (int i = 3; i < chain.frame_parameters(); ++i) {
    scratch(i, i) += 1.0 / (std::numbers::pi * std::numbers::pi);
  }
  for (int i = 0; i < 3; ++i) scratch(i, i) *= 1.0 + 1e-12;
  if (!cholesky(scratch)) return std::numeric_limits<double>::infinity();
  return 2.0 * scratch.diagonal().array().log().sum();
}

}  // namespace kinemark::skeleton::articulated
