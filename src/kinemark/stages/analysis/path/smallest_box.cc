// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr std::int64_t kMany = 4000;       // samples from which those well inside are left out first
constexpr std::int64_t kVeryMany = 30000;  // for which a finer hull pays

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

// A plane that has all points of a set on one side: normal . p <= distance.
struct Face {
  Eigen::Vector3d normal;
  double distance = 0.0;
};

// The faces of the hull of a few points, each perhaps several times: of every three, whether the others lie
// on one side.
std::vector<Face> faces_of(const std::vector<Eigen::Vector3d>& corners) {
  constexpr double kFlat = 1e-9;
  std::vector<Face> out;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        Eigen::Vector3d normal = (corners[j] - corners[i]).cross(corners[k] - corners[i]);
        if (!(normal.norm() > kFlat)) continue;
        normal.normalize();
        double least = 0.0, most = 0.0;
        for (const auto& corner : corners) {
          const double side = normal.dot(corner - corners[i]);
          least = std::min(least, side), most = std::max(most, side);
          if (least < -kFlat && most > kFlat) break;
        }
        if (most <= kFlat) out.push_back({.normal = normal, .distance = normal.dot(corners[i])});
        if (least >= -kFlat) out.push_back({.normal = -normal, .distance = -normal.dot(corners[i])});
      }
  return out;
}

// The farthest rows along axes to a grid's points on a half of a cube, both ways: 13 of a grid from -1 to 1,
// 62 of one from -2 to 2.
std::vector<std::int64_t> farthest_both_ways(const SeriesMatrix& points, int grid) {
  std::vector<Eigen::Vector3d> axes;
  for (int x = -grid; x <= grid; ++x)
    for (int y = -grid; y <= grid; ++y)
      for (int z = -grid; z <= grid; ++z)
        if (std::tuple(x, y, z) > std::tuple(0, 0, 0)) axes.emplace_back(x, y, z);
  std::vector<double> least(axes.size(), INFINITY), most(axes.size(), -INFINITY);
  std::vector<std::int64_t> out(2 * axes.size(), 0);
  for (std::int64_t i = 0; i < points.rows(); ++i) {
    const Eigen::Vector3d p = points.row(i).transpose();
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const double along = p.dot(axes[k]);
      if (along < least[k]) least[k] = along, out[2 * k] = i;
      if (along > most[k]) most[k] = along, out[2 * k + 1] = i;
    }
  }
  std::ranges::sort(out);
  out.erase(std::ranges::unique(out).begin(), out.end());
  return out;
}

// Of many points about 0 those that do not lie well inside the hull of the farthest along a grid's axes: all
// corners of their own hull are among them.
SeriesMatrix outer(const SeriesMatrix& centred, int grid, std::int64_t many) {
  constexpr double kInside = 1e-6;  // of the extent
  const double scale = centred.cwiseAbs().maxCoeff();
  if (centred.rows() < many || !(scale > 0.0)) return centred;
  std::vector<Eigen::Vector3d> corners;
  for (const auto i : farthest_both_ways(centred, grid))
    corners.emplace_back(centred.row(i).transpose() / scale);
  const auto faces = faces_of(corners);
  if (faces.size() < 4) return centred;
  double ball = INFINITY;  // that all faces have inside
  for (const auto& face : faces) ball = std::min(ball, face.distance - kInside);
  SeriesMatrix out(centred.rows(), 3);
  std::int64_t kept = 0;
  for (std::int64_t i = 0; i < centred.rows(); ++i) {
    const Eigen::Vector3d p = centred.row(i).transpose() / scale;
    if (ball > 0.0 && p.squaredNorm() < ball * ball) continue;
    const auto inside = [&p](const Face& face) { return face.normal.dot(p) < face.distance - kInside; };
    if (!std::ranges::all_of(faces, inside)) out.row(kept++) = centred.row(i);
  }
  return out.topRows(kept);
}

}  // namespace

Eigen::Vector3d smallest_box(const SeriesMatrix& x) {
  const PrincipalAxes principal = principal_axes(x);
  Eigen::Matrix3d axes = principal.axes;
  const SeriesMatrix centred = outer(outer(x.rowwise() - principal.mean, 1, kMany), 2, kVeryMany);
  const auto sides = [&centred](const Eigen::Matrix3d& along) -> Eigen::Vector3d {
    const SeriesMatrix p = centred * along;
    return (p.colwise().maxCoeff() - p.colwise().minCoeff()).transpose();
  };
  Eigen::Vector3d best = sides(axes);
  for (int unchanged = 0, k = 2, step = 0; unchanged < 3 && step < 60; ++step, k = (k + 2) % 3) {
    // The rectangle across axis k, in the plane of the two others.
    const Eigen::Vector3d first = axes.col((k + 1) % 3), second = axes.col((k + 2) % 3);
    Points points;
    for (std::int64_t i = 0; i < centred.rows(); ++i)
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
