// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/wheel_measures.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"

namespace kinemark::studies {

PlaneView best_fit_plane(const Eigen::Matrix3Xd& points) {
  check(points.cols() >= 4, "a plane needs four points or more");
  PlaneView out;
  out.centre = points.rowwise().mean();
  const Eigen::Matrix3Xd centred = points.colwise() - out.centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(centred * centred.transpose());
  out.axes = eigen.eigenvectors().rowwise().reverse();
  out.in_plane = out.axes.leftCols<2>().transpose() * centred;
  out.across = (out.axes.col(2).transpose() * centred).transpose();
  return out;
}

WheelMeasures measure_wheel(const Eigen::Matrix3Xd& points, double true_diameter_m) {
  const PlaneView view = best_fit_plane(points);
  const auto n = points.cols();
  WheelMeasures out;
  std::vector<double> diameters;
  for (Eigen::Index i = 0; i < n; ++i)
    diameters.push_back((points.colwise() - points.col(i)).colwise().norm().maxCoeff());
  double mean = 0.0, squares = 0.0;
  for (const double d : diameters) mean += d / static_cast<double>(n);
  for (const double d : diameters) {
    squares += (d - mean) * (d - mean);
    out.max_error_m = std::max(out.max_error_m, std::abs(d - true_diameter_m));
  }
  out.sd_m = std::sqrt(squares / static_cast<double>(n - 1));
  out.median_error_m = math::median(diameters) - true_diameter_m;

  double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
  for (int degree = 0; degree < 180; ++degree) {
    const double angle = std::numbers::pi * degree / 180.0;
    const Eigen::RowVectorXd along = Eigen::RowVector2d(std::cos(angle), std::sin(angle)) * view.in_plane;
    const double extent = along.maxCoeff() - along.minCoeff();
    longest = std::max(longest, extent);
    shortest = std::min(shortest, extent);
  }
  out.axes_ratio = longest / shortest;
  out.plane_sd_m = std::sqrt(view.across.squaredNorm() / static_cast<double>(n - 3));

  // Circle of least squares: |p|^2 = 2 c . p + (r^2 - |c|^2).
  Eigen::MatrixX3d a(n, 3);
  a.leftCols<2>() = 2.0 * view.in_plane.transpose();
  a.col(2).setOnes();
  const Eigen::Vector3d circle =
      a.colPivHouseholderQr().solve(view.in_plane.colwise().squaredNorm().transpose());
  out.circle_error_m = 2.0 * std::sqrt(circle[2] + circle.head<2>().squaredNorm()) - true_diameter_m;
  return out;
}

}  // namespace kinemark::studies
