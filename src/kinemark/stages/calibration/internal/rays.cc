// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/internal/rays.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "kinemark/camera/response.h"
#include "kinemark/math/scale_free.h"

namespace kinemark::calibration::internal {

std::optional<Eigen::Vector2d> find_spot(const data::Detector& detector, const Eigen::Vector4d& readings) {
  constexpr int kSteps = 40;
  constexpr double kLongestStep = 0.25;  // half-sides
  if (!(readings.sum() > 0.0)) return std::nullopt;
  const double limit = 0.999 * detector.edge;
  Eigen::Vector2d spot = Eigen::Vector2d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const auto at = camera::respond_at(detector, spot);
    const auto left = math::eliminate_scale(readings, at.phi);
    const Eigen::Matrix<double, 3, 2> j = -left.scale * left.basis * at.d_spot;
    Eigen::Vector2d step = -(j.transpose() * j).inverse() * (j.transpose() * left.residual);
    if (!step.allFinite()) return std::nullopt;
    if (step.norm() > kLongestStep) step *= kLongestStep / step.norm();
    Eigen::Vector2d next = (spot + step).cwiseMax(-limit).cwiseMin(limit);
    if ((next - spot).norm() < 1e-9) return next;
    spot = next;
  }
  return spot;
}

std::optional<camera::Ray> line_of_sight(const data::Camera& camera, const Eigen::Vector4d& counts) {
  const auto spot = find_spot(camera.detector, counts - camera.detector.offset_counts);
  return spot ? camera::unproject(camera, *spot) : std::nullopt;
}

std::optional<Eigen::Vector3d> meet(std::span<const camera::Ray> rays) {
  // Minimise the sum of squared distances: A x = b with A = sum (I - d d'), b = sum (I - d d') origin.
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const auto& ray : rays) {
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - ray.direction_in_world * ray.direction_in_world.transpose();
    a += across;
    b += across * ray.origin_in_world;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(a, Eigen::EigenvaluesOnly);
  if (rays.size() < 2 || eigen.eigenvalues()(0) < 1e-4) return std::nullopt;
  return Eigen::Vector3d(a.ldlt().solve(b));
}

}  // namespace kinemark::calibration::internal
