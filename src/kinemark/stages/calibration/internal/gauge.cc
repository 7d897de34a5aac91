// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/internal/gauge.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace kinemark::calibration::internal {
namespace {

using data::ParameterLayout;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Derivative of a point by rotation w and translation t: w x arm + t.
Eigen::Matrix<double, 3, 6> d_moved(const Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> out;
  for (int i = 0; i < 3; ++i) out.col(i) = Vector3d::Unit(i).cross(arm);
  out.rightCols<3>().setIdentity();
  return out;
}

}  // namespace

MatrixXd hold_the_cloud(const data::Rig& rig, const BundleProblem& problem,
                        const std::vector<math::SE3>& world_from_tree, const std::vector<Vector3d>& tree) {
  const auto& free = problem.free();
  const auto columns = static_cast<Eigen::Index>(free.size());
  // motion: the rigid motion (rotation, translation) of the cloud by the free parameters, in least squares
  // over its points.
  Eigen::Matrix<double, 6, 6> square = Eigen::Matrix<double, 6, 6>::Zero();
  MatrixXd right = MatrixXd::Zero(6, columns);
  const auto& poses = problem.poses();
  for (std::size_t p = 0; p < poses.size(); ++p) {
    const math::SE3& pose = world_from_tree[static_cast<std::size_t>(poses[p])];
    Eigen::Matrix<double, 6, 6> by_pose = Eigen::Matrix<double, 6, 6>::Zero();
    for (const auto& led : tree) {
      const Vector3d arm = pose.rotation * led;
      const auto cloud = d_moved(arm + pose.translation);
      square += cloud.transpose() * cloud;
      by_pose += cloud.transpose() * d_moved(arm);
    }
    right += by_pose * problem.pose_by_free(p);
  }
  const MatrixXd motion = square.ldlt().solve(right);

  MatrixXd all = MatrixXd::Zero(rig.parameter_count(), columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const auto& f = free[static_cast<std::size_t>(k)];
    all(rig.first_parameter(f.camera) + f.index, k) = 1.0;
  }
  for (int c = 0; c < rig.camera_count(); ++c) {
    const auto& camera = rig.cameras[static_cast<std::size_t>(c)];
    const int first = rig.first_parameter(c);
    all.middleRows<3>(first + ParameterLayout::rotation) +=
        camera.cam_from_world.rotation * motion.topRows<3>();
    all.middleRows<3>(first + ParameterLayout::centre) -= d_moved(camera.centre_in_world()) * motion;
  }
  MatrixXd covariance = all * problem.covariance() * all.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace kinemark::calibration::internal
