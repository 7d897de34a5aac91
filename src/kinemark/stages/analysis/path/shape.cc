// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/shape.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
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
  const double squared = path.v.row(i).squaredNorm();
  return row(path.v, i).cross(row(path.a, i)).norm() / (squared * std::sqrt(squared));
}

// The first two coordinates about their mean, over the largest of them.
struct PlanePoints {
  PlanePoints(const SeriesMatrix& in_plane, std::int64_t every)
      : of(&in_plane), step(every), mean(in_plane.leftCols<2>().colwise().mean()) {
    scale = (in_plane.leftCols<2>().rowwise() - mean).cwiseAbs().maxCoeff();
  }
  [[nodiscard]] PlanePoints every(std::int64_t k) const {
    PlanePoints out = *this;
    out.step = k;
    return out;
  }
  [[nodiscard]] std::int64_t count() const { return (of->rows() + step - 1) / step; }
  Eigen::Vector2d operator[](std::int64_t i) const {
    return Eigen::Vector2d((*of)(i * step, 0) - mean[0], (*of)(i * step, 1) - mean[1]) / scale;
  }

  const SeriesMatrix* of;
  std::int64_t step;
  Eigen::RowVector2d mean;
  double scale = 0.0;
};

constexpr std::int64_t kManyOfCircle = 4096;  // points from which a part of them finds the way first

// Least squared distances from a circle (centre and radius) by Newton's steps where they go down, else by
// those of Gauss and Newton.
void fit_circle(const PlanePoints& points, Eigen::Vector3d& circle) {
  for (int step = 0; step < 20; ++step) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), second = normal;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::int64_t i = 0; i < points.count(); ++i) {
      const Eigen::Vector2d ray = points[i] - circle.head<2>();
      const double distance = ray.norm();
      if (!(distance > 0.0)) return;
      const Eigen::Vector2d along = ray / distance;
      const Eigen::Vector3d slope(-along.x(), -along.y(), -1.0);
      const double rest = distance - circle[2], across = rest / distance;
      normal += slope * slope.transpose();
      second(0, 0) += across * along.y() * along.y();
      second(1, 0) -= across * along.x() * along.y();
      second(1, 1) += across * along.x() * along.x();
      right -= slope * rest;
    }
    second(0, 1) = second(1, 0);
    const Eigen::LLT<Eigen::Matrix3d> newton(normal + second);
    const Eigen::Vector3d change = newton.info() == Eigen::Success
                                       ? Eigen::Vector3d(newton.solve(right))
                                       : Eigen::Vector3d(normal.ldlt().solve(right));
    circle += change;
    if (change.norm() < 1e-13 * std::max(1e-300, std::abs(circle[2]))) return;
  }
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
  // Not by the eigenvalue, which of a flat path is the rounding of the largest.
  out.variance[2] = (centred * out.axes.col(2)).squaredNorm() / static_cast<double>(x.rows());
  return out;
}

SeriesMatrix along_axes(const SeriesMatrix& x, const PrincipalAxes& axes) {
  return (x.rowwise() - axes.mean) * axes.axes;
}

Diameters diameters(const SeriesMatrix& x) {
  const std::int64_t step = std::max<std::int64_t>(1, (x.rows() + kDistances - 1) / kDistances);
  const std::int64_t count = (x.rows() + step - 1) / step;
  std::vector<double> farthest(static_cast<std::size_t>(count), 0.0);  // squared
  for (std::int64_t i = 0; i < count; ++i)
    for (std::int64_t k = 0; k < i; ++k) {
      const double squared = (row(x, i * step) - row(x, k * step)).squaredNorm();
      auto& one = farthest[static_cast<std::size_t>(i)];
      auto& other = farthest[static_cast<std::size_t>(k)];
      one = std::max(one, squared), other = std::max(other, squared);
    }
  for (double& distance : farthest) distance = std::sqrt(distance);
  return {.median_farthest = math::median(farthest), .largest = *std::ranges::max_element(farthest)};
}

double circle_diameter(const SeriesMatrix& in_plane) {
  constexpr double kStraight = 1e-14;  // least over largest eigenvalue of what is no arc
  const std::int64_t n = in_plane.rows();
  if (n < 3) return kNaN;
  const PlanePoints all(in_plane, 1);
  if (!(all.scale > 0.0)) return kNaN;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::int64_t i = 0; i < n; ++i) {
    const Eigen::Vector2d p = all[i];
    const Eigen::Vector3d left(2.0 * p.x(), 2.0 * p.y(), 1.0);
    normal += left * left.transpose();
    right += left * p.squaredNorm();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues()[0] > kStraight * solver.eigenvalues()[2])) return kNaN;
  const Eigen::Vector3d start = normal.ldlt().solve(right);
  Eigen::Vector3d circle(start[0], start[1],
                         std::sqrt(std::max(0.0, start[2] + start.head<2>().squaredNorm())));
  if (n > kManyOfCircle) fit_circle(all.every((n + kManyOfCircle - 1) / kManyOfCircle), circle);
  fit_circle(all, circle);
  return 2.0 * all.scale * circle[2];
}

EllipseAxes ellipse_axes(const SeriesMatrix& in_plane) {
  const EllipseAxes none{.major = kNaN, .minor = kNaN};
  const std::int64_t n = in_plane.rows();
  if (n < 6) return none;
  const Eigen::RowVector2d mean = in_plane.leftCols<2>().colwise().mean();
  const double scale = (in_plane.leftCols<2>().rowwise() - mean).cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return none;
  Eigen::Matrix3d s1 = Eigen::Matrix3d::Zero(), s2 = s1, s3 = s1;
  for (std::int64_t i = 0; i < n; ++i) {
    const double u = (in_plane(i, 0) - mean[0]) / scale, w = (in_plane(i, 1) - mean[1]) / scale;
    const Eigen::Vector3d quadratic(u * u, u * w, w * w), linear(u, w, 1.0);
    s1 += quadratic * quadratic.transpose();
    s2 += quadratic * linear.transpose();
    s3 += linear * linear.transpose();
  }
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
