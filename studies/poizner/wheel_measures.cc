// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/wheel_measures.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/path/shape.h"
#include "kinemark/stages/analysis/path/turning.h"

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

  out.plane_sd_m = std::sqrt(view.across.squaredNorm() / static_cast<double>(n - 3));
  const analysis::PathMatrix x = points.transpose();
  const auto principal = analysis::principal_axes(x);
  const analysis::PathMatrix along = analysis::along_axes(x, principal);
  const auto turning = analysis::turning_of(x);
  const auto ellipse = analysis::ellipse_axes(along);
  out.spread_ratio = analysis::spread_ratio(x, analysis::whole_turns_end(x, turning));
  out.spread_of_all = std::sqrt(principal.variance[0] / principal.variance[1]);
  out.width_ratio = analysis::width_ratio(along);
  out.ellipse_ratio = ellipse.major / ellipse.minor;
  out.circle_error_m = analysis::circle_diameter(along) - true_diameter_m;
  return out;
}

}  // namespace kinemark::studies
