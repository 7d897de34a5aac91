// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/rotation_fit.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "kinemark/core/check.h"

namespace kinemark::math {
namespace {

using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;  // products of rows run along memory

}  // namespace

// With target_source = U S V', trace(R' target_source) is largest for R = U V', or, where that is a
// reflection, for the same with the direction of the smallest singular value turned round.
RotationFit fit_rotation(const Matrix3d& target_source) {
  const Eigen::JacobiSVD<Matrix3d> svd(target_source, Eigen::ComputeFullU | Eigen::ComputeFullV);
  RotationFit fit;
  fit.mirrored = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0;
  const double sign = fit.mirrored ? -1.0 : 1.0;
  fit.rotation = svd.matrixU() * Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  const Vector3d& s = svd.singularValues();
  if (s[0] > 0.0) fit.margin = (s[1] + sign * s[2]) / s[0];
  return fit;
}

RigidFit fit_rigid(const Eigen::Matrix3Xd& source, const Eigen::Matrix3Xd& target) {
  check(source.cols() == target.cols() && source.cols() > 0,
        "fit_rigid(): as many points on both sides, one at least");
  const double share = 1.0 / static_cast<double>(source.cols());
  const Vector3d source_mean = source.rowwise().sum() * share, target_mean = target.rowwise().sum() * share;
  const Rows from = source.colwise() - source_mean, to = target.colwise() - target_mean;
  RigidFit fit;
  fit.rotation = fit_rotation(share * to * from.transpose());
  fit.target_from_source = {fit.rotation.rotation, target_mean - fit.rotation.rotation * source_mean};
  return fit;
}

}  // namespace kinemark::math
