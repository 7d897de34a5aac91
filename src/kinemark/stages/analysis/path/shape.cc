// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/shape.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

constexpr double kMoving = 0.1;           // share of the peak speed below which a curvature means nothing
constexpr std::int64_t kDistances = 240;  // samples between which all distances are taken

Eigen::Vector3d row(const SeriesMatrix& m, std::int64_t i) { return m.row(i).transpose(); }

// Samples faster than kMoving of the peak.
std::vector<std::int64_t> moving(const PathSamples& path) {
  const Eigen::VectorXd speed = path.v.rowwise().norm();
  const double least = kMoving * speed.maxCoeff();
  std::vector<std::int64_t> out;
  for (std::int64_t i = 0; i < path.count(); ++i)
    if (speed[i] > least) out.push_back(i);
  return out;
}

double curvature(const PathSamples& path, std::int64_t i) {
  return row(path.v, i).cross(row(path.a, i)).norm() / std::pow(path.v.row(i).norm(), 3);
}

}  // namespace

double path_length(const SeriesMatrix& x) {
  const std::int64_t n = x.rows();
  return n > 1 ? (x.bottomRows(n - 1) - x.topRows(n - 1)).rowwise().norm().sum() : 0.0;
}

double straightness(const SeriesMatrix& x) {
  const double length = path_length(x);
  return length > 0.0 ? (x.row(x.rows() - 1) - x.row(0)).norm() / length : kNaN;
}

PrincipalAxes principal_axes(const SeriesMatrix& x) {
  PrincipalAxes out;
  out.mean = x.colwise().mean();
  const SeriesMatrix centred = x.rowwise() - out.mean;
  const Eigen::Matrix3d covariance = centred.transpose() * centred / static_cast<double>(x.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  for (int k = 0; k < 3; ++k) {
    out.axes.col(k) = solver.eigenvectors().col(2 - k);
    out.variance[k] = std::max(0.0, solver.eigenvalues()[2 - k]);
  }
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd along = centred * out.axes.col(k);
    if (along.maxCoeff() < -along.minCoeff()) out.axes.col(k) *= -1.0;
  }
  out.axes.col(2) = out.axes.col(0).cross(out.axes.col(1));
  return out;
}

SeriesMatrix along_axes(const SeriesMatrix& x, const PrincipalAxes& axes) {
  return (x.rowwise() - axes.mean) * axes.axes;
}

Diameters diameters(const SeriesMatrix& x) {
  const std::int64_t step = std::max<std::int64_t>(1, (x.rows() + kDistances - 1) / kDistances);
  std::vector<double> farthest;
  for (std::int64_t i = 0; i < x.rows(); i += step) {
    double most = 0.0;
    for (std::int64_t k = 0; k < x.rows(); k += step)
      most = std::max(most, (x.row(i) - x.row(k)).squaredNorm());
    farthest.push_back(std::sqrt(most));
  }
  return {.median_farthest = math::median(farthest), .largest = *std::ranges::max_element(farthest)};
}

double circle_diameter(const SeriesMatrix& in_plane) {
  const std::int64_t n = in_plane.rows();
  if (n < 3) return kNaN;
  Eigen::MatrixXd left(n, 3);
  left << 2.0 * in_plane.leftCols(2), Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd squares = in_plane.leftCols(2).rowwise().squaredNorm();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(left);
  if (qr.rank() < 3) return kNaN;
  const Eigen::Vector3d start = qr.solve(squares);
  Eigen::RowVector2d centre = start.head<2>().transpose();
  double radius = std::sqrt(std::max(0.0, start[2] + centre.squaredNorm()));
  for (int step = 0; step < 20; ++step) {
    const Eigen::MatrixXd ray = in_plane.leftCols(2).rowwise() - centre;
    const Eigen::VectorXd distance = ray.rowwise().norm();
    if (distance.minCoeff() <= 0.0) break;
    Eigen::MatrixXd jacobian(n, 3);
    jacobian << (ray.array().colwise() / -distance.array()).matrix(), -Eigen::VectorXd::Ones(n);
    const Eigen::Vector3d change = (jacobian.transpose() * jacobian)
                                       .ldlt()
                                       .solve(-jacobian.transpose() * (distance.array() - radius).matrix());
    centre += change.head<2>().transpose();
    radius += change[2];
    if (change.norm() < 1e-14 * std::max(1e-300, std::abs(radius))) break;
  }
  return 2.0 * radius;
}

EllipseAxes ellipse_axes(const SeriesMatrix& in_plane) {
  const EllipseAxes none{.major = kNaN, .minor = kNaN};
  const std::int64_t n = in_plane.rows();
  if (n < 6) return none;
  const Eigen::RowVector2d mean = in_plane.leftCols(2).colwise().mean();
  const double scale = (in_plane.leftCols(2).rowwise() - mean).cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return none;
  const Eigen::ArrayXXd p = ((in_plane.leftCols(2).rowwise() - mean) / scale).array();
  Eigen::MatrixXd quadratic(n, 3), linear(n, 3);
  quadratic << p.col(0).square().matrix(), (p.col(0) * p.col(1)).matrix(), p.col(1).square().matrix();
  linear << p.matrix(), Eigen::VectorXd::Ones(n);
  const Eigen::Matrix3d s1 = quadratic.transpose() * quadratic, s2 = quadratic.transpose() * linear,
                        s3 = linear.transpose() * linear;
  const Eigen::Matrix3d t = -s3.ldlt().solve(s2.transpose());
  Eigen::Matrix3d inverse_constraint;
  inverse_constraint << 0.0, 0.0, 0.5, 0.0, -1.0, 0.0, 0.5, 0.0, 0.0;
  const Eigen::EigenSolver<Eigen::Matrix3d> solver(inverse_constraint * (s1 + s2 * t));
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d q = solver.eigenvectors().col(k).real();
    if (!(4.0 * q[0] * q[2] - q[1] * q[1] > 0.0)) continue;
    const Eigen::Vector3d l = t * q;
    Eigen::Matrix2d form;
    form << q[0], 0.5 * q[1], 0.5 * q[1], q[2];
    const Eigen::Vector2d centre = -0.5 * form.ldlt().solve(l.head<2>());
    const double level = centre.dot(form * centre) - l[2];
    const Eigen::Vector2d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(form).eigenvalues();
    const Eigen::Array2d axes = (level / values.array());
    if (!(axes > 0.0).all()) continue;
    return {.major = 2.0 * scale * std::sqrt(axes.maxCoeff()),
            .minor = 2.0 * scale * std::sqrt(axes.minCoeff())};
  }
  return none;
}

double median_curvature(const PathSamples& path) {
  std::vector<double> values;
  for (const auto i : moving(path)) values.push_back(curvature(path, i));
  return math::median(values);
}

double median_torsion(const PathSamples& path) {
  std::vector<double> values;
  for (const auto i : moving(path)) {
    const Eigen::Vector3d cross = row(path.v, i).cross(row(path.a, i));
    if (cross.squaredNorm() > 0.0)
      values.push_back(std::abs(cross.dot(row(path.j, i))) / cross.squaredNorm());
  }
  return math::median(values);
}

double power_law_exponent(const PathSamples& path) {
  const auto samples = moving(path);
  if (samples.size() < 3) return kNaN;
  Eigen::ArrayXd speed(static_cast<Eigen::Index>(samples.size())), log_curvature(speed.size());
  for (Eigen::Index k = 0; k < speed.size(); ++k) {
    const auto i = samples[static_cast<std::size_t>(k)];
    speed[k] = std::log(path.v.row(i).norm());
    log_curvature[k] = std::log(std::max(curvature(path, i), 1e-9));
  }
  log_curvature -= log_curvature.mean();
  const double spread = log_curvature.square().sum();
  return spread > 0.0 ? -(log_curvature * speed).sum() / spread : kNaN;
}

}  // namespace kinemark::analysis
