// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/calibration_fields.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>

namespace kinemark::reconstruction {
namespace {

constexpr int kTerms = data::CalibrationError::kTerms;
constexpr double kLeftOut = 1e-3;   // share of the variance that fields need not hold
constexpr double kSameTerm = 1e-4;  // of the largest: below it terms do not differ over the points

}  // namespace

data::CalibrationError fit_calibration_error(const data::Points& points_in_world,
                                             const Eigen::MatrixXd& by_draw) {
  data::CalibrationError out;
  const Eigen::Index n = points_in_world.rows(), draws = by_draw.cols();
  if (n == 0 || draws == 0) return out;
  out.middle_in_world = points_in_world.colwise().mean().transpose();
  const data::Points about = points_in_world.rowwise() - out.middle_in_world.transpose();
  out.scale_m = std::max(about.cwiseAbs().maxCoeff(), 1e-3);
  // Points on a line or in a plane leave terms open: the least ones that fit.
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kSameTerm);
  const Eigen::MatrixXd terms = data::terms_of(out, points_in_world);
  solver.compute(terms);
  Eigen::MatrixXd coefficients(3 * kTerms, draws), fitted(3 * n, draws);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd one = solver.solve(by_draw(Eigen::seqN(axis, n, 3), Eigen::all));
    coefficients.middleRows(axis * kTerms, kTerms) = one;
    fitted.middleRows(axis * n, n) = terms * one;
  }
  // By decreasing variance over the points.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(fitted.transpose() * fitted);
  const double all = modes.eigenvalues().sum();
  double left = all;
  for (Eigen::Index k = draws - 1;
       k >= 0 && out.fields.size() < data::CalibrationError::kMostFields && left > kLeftOut * all; --k) {
    const Eigen::VectorXd field = coefficients * modes.eigenvectors().col(k);
    out.fields.emplace_back(field.reshaped(kTerms, 3));
    left -= modes.eigenvalues()[k];
  }
  return out;
}

}  // namespace kinemark::reconstruction
