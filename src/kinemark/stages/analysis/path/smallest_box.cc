// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

using Points = std::vector<Eigen::Vector2d>;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Convex hull, counter-clockwise (Andrew 1979).
Points hull_of(Points points) {
  std::ranges::sort(points, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Points hull;
  const auto go_along = [&hull](const auto& from, std::size_t least) {
    for (const auto& point : from) {
      while (hull.size() > least && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
      hull.push_back(point);
    }
  };
  go_along(points, 1);
  const std::size_t lower = hull.size();
  std::ranges::reverse(points);
  points.erase(points.begin());
  go_along(points, lower);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

// Direction of one side of the least rectangle around a hull.
Eigen::Vector2d best_side(const Points& hull) {
  Eigen::Vector2d best(1.0, 0.0);
  double least = INFINITY;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (!(edge.norm() > 0.0)) continue;
    const Eigen::Vector2d u = edge.normalized(), w(-u.y(), u.x());
    double u0 = INFINITY, u1 = -INFINITY, w0 = INFINITY, w1 = -INFINITY;
    for (const auto& p : hull) {
      u0 = std::min(u0, u.dot(p)), u1 = std::max(u1, u.dot(p));
      w0 = std::min(w0, w.dot(p)), w1 = std::max(w1, w.dot(p));
    }
    if ((u1 - u0) * (w1 - w0) < least) least = (u1 - u0) * (w1 - w0), best = u;
  }
  return best;
}

}  // namespace

Eigen::Vector3d smallest_box(const SeriesMatrix& x) {
  const PrincipalAxes principal = principal_axes(x);
  Eigen::Matrix3d axes = principal.axes;
  const SeriesMatrix centred = x.rowwise() - principal.mean;
  const auto sides = [&centred](const Eigen::Matrix3d& along) -> Eigen::Vector3d {
    const SeriesMatrix p = centred * along;
    return (p.colwise().maxCoeff() - p.colwise().minCoeff()).transpose();
  };
  Eigen::Vector3d best = sides(axes);
  for (int unchanged = 0, k = 2, step = 0; unchanged < 3 && step < 60; ++step, k = (k + 2) % 3) {
    // The rectangle across axis k, in the plane of the two others.
    const Eigen::Vector3d first = axes.col((k + 1) % 3), second = axes.col((k + 2) % 3);
    Points points;
    for (std::int64_t i = 0; i < x.rows(); ++i)
      points.emplace_back(centred.row(i).dot(first), centred.row(i).dot(second));
    const Eigen::Vector2d side = best_side(hull_of(std::move(points)));
    Eigen::Matrix3d turned = axes;
    turned.col((k + 1) % 3) = side.x() * first + side.y() * second;
    turned.col((k + 2) % 3) = -side.y() * first + side.x() * second;
    const Eigen::Vector3d found = sides(turned);
    // Equal but for rounding is no gain, and a flat path still has a smallest rectangle.
    const double flat = 1e-9 * best.maxCoeff();
    if (found.cwiseMax(flat).prod() < best.cwiseMax(flat).prod() * (1.0 - 1e-9)) {
      best = found, axes = turned, unchanged = 0;
    } else {
      ++unchanged;
    }
  }
  std::ranges::sort(best, std::greater<>{});
  return best;
}

}  // namespace kinemark::analysis
