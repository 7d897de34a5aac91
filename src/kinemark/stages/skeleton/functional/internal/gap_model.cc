// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/gap_model.h"

#include <Eigen/Cholesky>

#include "kinemark/core/index.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/math/euler.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr double kFirm = 1e-4;  ///< weight of the joint's prior beside a frame: holds what hardly moves

}  // namespace

Eigen::MatrixXd GapModel::residual(const Eigen::VectorXd& coefficients) const {
  const Eigen::VectorXd left = gap - design * coefficients;
  return Eigen::Map<const Eigen::Matrix3Xd>(left.data(), 3, left.size() / 3).transpose();
}

GapModel gap_model(const SegmentPoses& parent, const SegmentPoses& child, const RelativeMotion& motion,
                   const Posture& posture) {
  GapModel out{.posture = posture};
  const auto F = static_cast<Eigen::Index>(posture.frames.size());
  out.design.resize(3 * F, kGapSize);
  out.gap.resize(3 * F);
  Matrix6 normal = Matrix6::Identity() *
                   (kFirm * static_cast<double>(F) / (data::kJointPriorSd_m * data::kJointPriorSd_m));
  Vector6 right = Vector6::Zero();
  Eigen::Matrix<double, 3, 6> X;
  X.leftCols<3>().setIdentity();
  const auto measured = [&](Eigen::Index i) {
    const auto f = at(posture.frames[at(i)]);
    X.rightCols<3>() = -parent.world_from_segment[f].transpose() * child.world_from_segment[f];
    return Eigen::Vector3d(parent.world_from_segment[f].transpose() * (child.origin[f] - parent.origin[f]));
  };
  for (Eigen::Index i = 0; i < F; ++i) {
    const Eigen::Vector3d y = measured(i);
    normal += X.transpose() * X;
    right += X.transpose() * y;
  }
  out.about = normal.llt().solve(right);
  for (Eigen::Index i = 0; i < F; ++i) {
    const Eigen::Vector3d y = measured(i);
    out.gap.segment<3>(3 * i) = y - X * out.about;
    const Eigen::Matrix3d R = motion.mean * math::exp_so3(motion.axes * posture.smooth.row(i).transpose());
    auto row = out.design.middleRows<3>(3 * i);
    row.leftCols<3>().setIdentity();
    row.middleCols<3>(3) = -R;
    for (int k = 0; k < kPostureTerms; ++k)
      row.middleCols<3>(6 + 3 * k) = posture.terms(i, k) * Eigen::Matrix3d::Identity();
    for (int k = 0; k < kLinearTerms; ++k)
      row.middleCols<3>(6 + 3 * (kPostureTerms + k)) = -posture.smooth(i, k) * R;
  }
  const Eigen::Index length = posture.block, count = F / length;
  out.blocks = Eigen::MatrixXd::Zero(3 * count, kGapSize);
  out.block_gap = Eigen::VectorXd::Zero(3 * count);
  for (Eigen::Index i = 0; i < count * length; ++i) {
    out.blocks.middleRows<3>(3 * (i / length)) += out.design.middleRows<3>(3 * i);
    out.block_gap.segment<3>(3 * (i / length)) += out.gap.segment<3>(3 * i);
  }
  out.blocks /= static_cast<double>(length);
  out.block_gap /= static_cast<double>(length);
  return out;
}

}  // namespace kinemark::skeleton::internal
