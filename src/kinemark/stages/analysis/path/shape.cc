// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/shape.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/wide.h"
#include "kinemark/math/normals.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

constexpr double kMoving = 0.1;           // share of the peak speed below which a curvature means nothing
constexpr std::int64_t kDistances = 240;  // samples between which all distances are taken
constexpr std::int64_t kBlock = 256;      // samples at once
using Block = std::array<double, kBlock>;

// |v|^2, |v x a|^2 and (v x a) . j of a block.
struct CurvatureBlock {
  const double *v[3], *a[3], *j[3];
  double *speed_squared, *cross_squared, *triple;
};
[[gnu::always_inline]] inline void curvature_block(const CurvatureBlock& of) {
  for (std::int64_t i = 0; i < kBlock; i += kLanes) {
    Lanes v[3], a[3], j[3];
    for (int k = 0; k < 3; ++k) load(v[k], of.v[k] + i), load(a[k], of.a[k] + i), load(j[k], of.j[k] + i);
    const Lanes x = v[1] * a[2] - v[2] * a[1], y = v[2] * a[0] - v[0] * a[2], z = v[0] * a[1] - v[1] * a[0];
    store(of.speed_squared + i, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    store(of.cross_squared + i, x * x + y * y + z * z);
    store(of.triple + i, x * j[0] + y * j[1] + z * j[2]);
  }
}

// Of two coordinates about their mean over the largest of them: 1, u, w and all their products of up to four.
struct PlaneMoments {
  double count = 0.0, u = 0.0, w = 0.0, uu = 0.0, uw = 0.0, ww = 0.0, uuu = 0.0, uuw = 0.0, uww = 0.0,
         www = 0.0, uuuu = 0.0, uuuw = 0.0, uuww = 0.0, uwww = 0.0, wwww = 0.0;
};
[[gnu::always_inline]] inline void add_moments(const double* us, const double* ws, std::int64_t n,
                                               PlaneMoments* to) {
  Lanes sums[14];
  for (auto& sum : sums) spread(sum, 0.0);
  for (std::int64_t i = 0; i < n; i += kLanes) {
    Lanes u, w;
    if (i + kLanes <= n) {
      load(u, us + i), load(w, ws + i);
    } else {
      spread(u, 0.0), spread(w, 0.0);
      for (std::int64_t k = i; k < n; ++k) u[k - i] = us[k], w[k - i] = ws[k];
    }
    const Lanes uu = u * u, uw = u * w, ww = w * w;
    const Lanes terms[14] = {u,      w,      uu,      uw,      ww,      uu * u,  uu * w,
                             u * ww, ww * w, uu * uu, uu * uw, uu * ww, uw * ww, ww * ww};
    for (int k = 0; k < 14; ++k) sums[k] += terms[k];
  }
  double* const into[14] = {&to->u,   &to->w,   &to->uu,   &to->uw,   &to->ww,   &to->uuu,  &to->uuw,
                            &to->uww, &to->www, &to->uuuu, &to->uuuw, &to->uuww, &to->uwww, &to->wwww};
  for (int k = 0; k < 14; ++k) *into[k] += sum_of(sums[k]);
  to->count += static_cast<double>(n);
}

// The first two coordinates about their mean, over the largest of them.
struct PlanePoints {
  explicit PlanePoints(const PathMatrix& in_plane) {
    const Eigen::RowVector2d mean = in_plane.leftCols<2>().colwise().mean();
    u = in_plane.col(0).array() - mean[0], w = in_plane.col(1).array() - mean[1];
    scale = std::max(u.cwiseAbs().maxCoeff(), w.cwiseAbs().maxCoeff());
    if (scale > 0.0) u /= scale, w /= scale;
  }
  [[nodiscard]] PlaneMoments moments() const {
    PlaneMoments out;
    for (std::int64_t i = 0; i < u.size(); i += kBlock)
      run_wide<add_moments>(u.data() + i, w.data() + i, std::min<std::int64_t>(kBlock, u.size() - i), &out);
    return out;
  }
  // Every k-th of them.
  [[nodiscard]] PlanePoints every(std::int64_t k) const {
    const auto some = Eigen::seqN(0, (u.size() + k - 1) / k, k);
    PlanePoints out = *this;
    out.u = u(some), out.w = w(some);
    return out;
  }

  Eigen::ArrayXd u, w;
  double scale = 0.0;
};

constexpr std::int64_t kManyOfCircle = 4096;  // points from which a part of them finds the way first

// Sums over points of a circle's fit: of the unit vectors from its centre, of their products, of those times
// rest / distance, and of those times the rest.
struct CircleSums {
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, across_xx = 0.0, across_xy = 0.0, across_yy = 0.0,
         rest = 0.0, rest_x = 0.0, rest_y = 0.0;
};
struct CircleBlock {
  const double *u, *w;
  double* distance;
  std::int64_t count;
  double centre_u, centre_w, radius;
};
[[gnu::always_inline]] inline void squared_distances(const CircleBlock& of) {
  for (std::int64_t i = 0; i < of.count; i += kLanes) {
    Lanes u, w;
    load(u, of.u + i), load(w, of.w + i);
    const Lanes x = u - of.centre_u, y = w - of.centre_w;
    store(of.distance + i, x * x + y * y);
  }
}
[[gnu::always_inline]] inline void add_circle(const CircleBlock& of, CircleSums* to) {
  Lanes sums[11];
  for (auto& sum : sums) spread(sum, 0.0);
  for (std::int64_t i = 0; i < of.count; i += kLanes) {
    Lanes u, w, distance;
    load(u, of.u + i), load(w, of.w + i), load(distance, of.distance + i);
    const Lanes inverse = 1.0 / distance;
    const Lanes x = (u - of.centre_u) * inverse, y = (w - of.centre_w) * inverse, rest = distance - of.radius,
                across = rest * inverse, xx = x * x, xy = x * y, yy = y * y;
    const Lanes terms[11] = {x,           y,           xx,   xy,       yy,      across * xx,
                             across * xy, across * yy, rest, rest * x, rest * y};
    for (int k = 0; k < 11; ++k) sums[k] += terms[k];
  }
  double* const into[11] = {&to->x,    &to->y,         &to->xx,        &to->xy,
                            &to->yy,   &to->across_xx, &to->across_xy, &to->across_yy,
                            &to->rest, &to->rest_x,    &to->rest_y};
  for (int k = 0; k < 11; ++k) *into[k] += sum_of(sums[k]);
}

// False where a point lies in the centre.
bool sum_circle(const PlanePoints& points, const Eigen::Vector3d& circle, CircleSums& sums) {
  const std::int64_t n = points.u.size();
  Block distance;
  for (std::int64_t i = 0; i < n; i += kBlock) {
    const std::int64_t count = std::min(kBlock, n - i), whole = count / kLanes * kLanes;
    CircleBlock block{.u = points.u.data() + i,
                      .w = points.w.data() + i,
                      .distance = distance.data(),
                      .count = whole,
                      .centre_u = circle[0],
                      .centre_w = circle[1],
                      .radius = circle[2]};
    const auto sum = [&] {
      run_wide<squared_distances>(block);
      Eigen::Map<Eigen::ArrayXd> roots(distance.data(), block.count);
      roots = roots.sqrt();
      if (!(roots.minCoeff() > 0.0)) return false;
      run_wide<add_circle>(block, &sums);
      return true;
    };
    if (whole > 0 && !sum()) return false;
    for (std::int64_t k = i + whole; k < i + count; ++k) {
      // The last few one by one.
      const Eigen::Vector2d ray(points.u[k] - circle[0], points.w[k] - circle[1]);
      const double one = ray.norm();
      if (!(one > 0.0)) return false;
      const double x = ray.x() / one, y = ray.y() / one, rest = one - circle[2], across = rest / one;
      sums.x += x, sums.y += y, sums.xx += x * x, sums.xy += x * y, sums.yy += y * y;
      sums.across_xx += across * x * x, sums.across_xy += across * x * y, sums.across_yy += across * y * y;
      sums.rest += rest, sums.rest_x += rest * x, sums.rest_y += rest * y;
    }
  }
  return true;
}

// Least squared distances from a circle (centre and radius) by Newton's steps where they go down, else by
// those of Gauss and Newton.
void fit_circle(const PlanePoints& points, Eigen::Vector3d& circle) {
  for (int step = 0; step < 20; ++step) {
    CircleSums s;
    if (!sum_circle(points, circle, s)) return;
    Eigen::Matrix3d normal, second = Eigen::Matrix3d::Zero();
    normal << s.xx, s.xy, s.x, s.xy, s.yy, s.y, s.x, s.y, static_cast<double>(points.u.size());
    second.topLeftCorner<2, 2>() << s.across_yy, -s.across_xy, -s.across_xy, s.across_xx;
    const Eigen::Vector3d right(s.rest_x, s.rest_y, s.rest);
    const Eigen::LLT<Eigen::Matrix3d> newton(normal + second);
    const Eigen::Vector3d change = newton.info() == Eigen::Success
                                       ? Eigen::Vector3d(newton.solve(right))
                                       : Eigen::Vector3d(normal.ldlt().solve(right));
    circle += change;
    if (change.norm() < 1e-13 * std::max(1e-300, std::abs(circle[2]))) return;
  }
}

// Largest squared distance of every point from the others.
[[gnu::always_inline]] inline void farthest_of_all(const double* x, const double* y, const double* z,
                                                   std::int64_t n, double* farthest) {
  for (std::int64_t i = 0; i < n; i += kLanes) {
    Lanes px, py, pz, most;
    load(px, x + i), load(py, y + i), load(pz, z + i);
    spread(most, 0.0);
    for (std::int64_t k = 0; k < n; ++k) {
      const Lanes dx = px - x[k], dy = py - y[k], dz = pz - z[k];
      const Lanes squared = dx * dx + dy * dy + dz * dz;
      most = squared > most ? squared : most;
    }
    store(farthest + i, most);
  }
}

}  // namespace

double path_length(const PathMatrix& x) {
  const std::int64_t n = x.rows();
  if (n < 2) return 0.0;
  Eigen::ArrayXd squared = Eigen::ArrayXd::Zero(n - 1);
  for (Eigen::Index k = 0; k < x.cols(); ++k)
    squared += (x.col(k).tail(n - 1) - x.col(k).head(n - 1)).array().square();
  return squared.sqrt().sum();
}

double straightness(const PathMatrix& x) {
  const double length = path_length(x);
  return length > 0.0 ? (x.row(x.rows() - 1) - x.row(0)).norm() / length : kNaN;
}

PrincipalAxes principal_axes(const PathMatrix& x) {
  PrincipalAxes out;
  out.mean = x.colwise().mean();
  const PathMatrix centred = x.rowwise() - out.mean;
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

PathMatrix along_axes(const PathMatrix& x, const PrincipalAxes& axes) {
  return (x.rowwise() - axes.mean) * axes.axes;
}

double spread_ratio(const PathMatrix& x, double end) {
  if (!(end >= 1.0)) return kNaN;
  const auto last = std::min(static_cast<Eigen::Index>(end), x.rows() - 2);
  if (last < 1) return kNaN;
  const double part = end - static_cast<double>(last);
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(last + 2);
  weight[0] = 0.5;
  weight[last] = 0.5 + part * (1.0 - 0.5 * part), weight[last + 1] = 0.5 * part * part;
  weight /= weight.sum();
  const PathMatrix part_of = x.topRows(last + 2);
  const PathMatrix centred = part_of.rowwise() - weight.transpose() * part_of;
  const Eigen::Matrix3d covariance = centred.transpose() * weight.asDiagonal() * centred;
  const Eigen::Vector3d variance =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(variance[2] / std::max(0.0, variance[1]));
}

Diameters diameters(const PathMatrix& x) {
  const std::int64_t step = std::max<std::int64_t>(1, (x.rows() + kDistances - 1) / kDistances);
  const std::int64_t count = (x.rows() + step - 1) / step;
  // Filled up with the first, which makes no distance larger.
  constexpr std::int64_t kRoom = kDistances / kLanes * kLanes;
  std::array<double, kRoom> coordinates[3];
  std::array<double, kRoom> squared;
  for (int k = 0; k < 3; ++k) {
    coordinates[k].fill(x(0, k));
    for (std::int64_t i = 0; i < count; ++i) coordinates[k][at(i)] = x(i * step, k);
  }
  run_wide<farthest_of_all>(coordinates[0].data(), coordinates[1].data(), coordinates[2].data(),
                            (count + kLanes - 1) / kLanes * kLanes, squared.data());
  std::vector<double> farthest(squared.begin(), squared.begin() + count);
  for (double& distance : farthest) distance = std::sqrt(distance);
  return {.median_farthest = math::median(farthest), .largest = *std::ranges::max_element(farthest)};
}

double circle_diameter(const PathMatrix& in_plane) {
  constexpr double kStraight = 1e-14;  // least over largest eigenvalue of what is no arc
  const std::int64_t n = in_plane.rows();
  if (n < 3) return kNaN;
  const PlanePoints all(in_plane);
  if (!(all.scale > 0.0)) return kNaN;
  const auto m = all.moments();
  Eigen::Matrix3d normal;
  normal << 4.0 * m.uu, 4.0 * m.uw, 2.0 * m.u, 4.0 * m.uw, 4.0 * m.ww, 2.0 * m.w, 2.0 * m.u, 2.0 * m.w,
      m.count;
  const Eigen::Vector3d right(2.0 * (m.uuu + m.uww), 2.0 * (m.uuw + m.www), m.uu + m.ww);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal, Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues()[0] > kStraight * solver.eigenvalues()[2])) return kNaN;
  const Eigen::Vector3d start = normal.ldlt().solve(right);
  Eigen::Vector3d circle(start[0], start[1],
                         std::sqrt(std::max(0.0, start[2] + start.head<2>().squaredNorm())));
  if (n > kManyOfCircle) fit_circle(all.every((n + kManyOfCircle - 1) / kManyOfCircle), circle);
  fit_circle(all, circle);
  return 2.0 * all.scale * circle[2];
}

EllipseAxes ellipse_axes(const PathMatrix& in_plane) {
  const EllipseAxes none;
  const std::int64_t n = in_plane.rows();
  if (n < 6) return none;
  const PlanePoints all(in_plane);
  const double scale = all.scale;
  if (!(scale > 0.0)) return none;
  const auto m = all.moments();
  Eigen::Matrix3d s1, s2, s3;
  s1 << m.uuuu, m.uuuw, m.uuww, m.uuuw, m.uuww, m.uwww, m.uuww, m.uwww, m.wwww;
  s2 << m.uuu, m.uuw, m.uu, m.uuw, m.uww, m.uw, m.uww, m.www, m.ww;
  s3 << m.uu, m.uw, m.u, m.uw, m.ww, m.w, m.u, m.w, m.count;
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
            .minor = 2.0 * scale * std::sqrt(axes.minCoeff()),
            .centre = in_plane.leftCols<2>().colwise().mean().transpose() + scale * centre,
            .form = form / (level * scale * scale)};
  }
  return none;
}

Eigen::VectorXd deviations(const PathMatrix& x, const PathMatrix& other) {
  Eigen::ArrayXd squared = Eigen::ArrayXd::Zero(x.rows());
  for (Eigen::Index k = 0; k < x.cols(); ++k) squared += (x.col(k) - other.col(k)).array().square();
  return squared.sqrt().matrix();
}

CurvatureTerms curvature_terms_of(const PathSamples& path) {
  const std::int64_t n = path.count();
  Eigen::ArrayXd squared = path.v.col(0).array().square();
  for (int k = 1; k < 3; ++k) squared += path.v.col(k).array().square();
  const double least = n > 0 ? kMoving * kMoving * squared.maxCoeff() : 0.0;
  CurvatureTerms out;
  for (auto* values : {&out.speed_squared, &out.cross_squared, &out.triple}) values->resize(at(n + 1));
  Block speed_squared, cross_squared, triple;
  Eigen::Matrix<double, kBlock, 9> rest;  // the last samples, made a block
  std::size_t kept = 0;
  for (std::int64_t i = 0; i < n; i += kBlock) {
    const std::int64_t count = std::min(kBlock, n - i);
    CurvatureBlock block{.speed_squared = speed_squared.data(),
                         .cross_squared = cross_squared.data(),
                         .triple = triple.data()};
    for (int k = 0; k < 3; ++k) {
      block.v[k] = path.v.col(k).data() + i, block.a[k] = path.a.col(k).data() + i;
      block.j[k] = path.j.col(k).data() + i;
      if (count == kBlock) continue;
      rest.col(k).setZero(), rest.col(3 + k).setZero(), rest.col(6 + k).setZero();
      rest.col(k).head(count) = path.v.col(k).tail(count);
      rest.col(3 + k).head(count) = path.a.col(k).tail(count);
      rest.col(6 + k).head(count) = path.j.col(k).tail(count);
      block.v[k] = rest.col(k).data(), block.a[k] = rest.col(3 + k).data(),
      block.j[k] = rest.col(6 + k).data();
    }
    run_wide<curvature_block>(block);
    for (std::size_t k = 0; k < at(count); ++k) {
      // Written in any case, kept where it moves.
      out.speed_squared[kept] = speed_squared[k];
      out.cross_squared[kept] = cross_squared[k];
      out.triple[kept] = triple[k];
      kept += speed_squared[k] > least;
    }
  }
  for (auto* values : {&out.speed_squared, &out.cross_squared, &out.triple}) values->resize(kept);
  return out;
}

namespace {

Eigen::Map<const Eigen::ArrayXd> array_of(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

std::vector<double> curvatures(const CurvatureTerms& terms) {
  std::vector<double> out(terms.speed_squared.size());
  const auto squared = array_of(terms.speed_squared), cross = array_of(terms.cross_squared);
  Eigen::Map<Eigen::ArrayXd>(out.data(), squared.size()) = cross.sqrt() / (squared * squared.sqrt());
  return out;
}

}  // namespace

double median_curvature(const CurvatureTerms& terms) { return math::median(curvatures(terms)); }

double median_torsion(const CurvatureTerms& terms) {
  std::vector<double> values(terms.triple.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[kept] = std::abs(terms.triple[i]) / terms.cross_squared[i];
    kept += terms.cross_squared[i] > 0.0;
  }
  values.resize(kept);
  return math::median(values);
}

double power_law_exponent(const CurvatureTerms& terms) {
  if (terms.speed_squared.size() < 3) return kNaN;
  std::vector<double> speed = terms.speed_squared, curvature = curvatures(terms);
  for (double& value : curvature) value = std::max(value, 1e-9);
  math::logarithms(speed);  // twice the logarithm of the speed
  math::logarithms(curvature);
  const auto along = array_of(speed);
  const Eigen::ArrayXd centred = array_of(curvature) - array_of(curvature).mean();
  const double spread = centred.square().sum();
  return spread > 0.0 ? -0.5 * (centred * along).sum() / spread : kNaN;
}

}  // namespace kinemark::analysis
