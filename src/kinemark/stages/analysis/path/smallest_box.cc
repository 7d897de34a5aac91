// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/wide.h"
#include "kinemark/stages/analysis/path/shape.h"

namespace kinemark::analysis {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr std::int64_t kMany = 200;       // samples from which those well inside are left out first
constexpr std::int64_t kVeryMany = 4000;  // for which a finer hull pays
constexpr double kInside = 1e-6;          // of the extent: nearer to a face is not inside
constexpr std::int64_t kBoxBlock = 256;
constexpr std::size_t kManyFaces = 1000;  // more only of corners in a plane, each face many times
constexpr int kLevels = 40;               // of tetrahedra on each other

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

double extent(const Points& points, const Eigen::Vector2d& along) {
  double least = INFINITY, most = -INFINITY;
  for (const auto& p : points) least = std::min(least, along.dot(p)), most = std::max(most, along.dot(p));
  return most - least;
}

// A plane that has all points of a set on one side: normal . p <= distance.
struct Face {
  Eigen::Vector3d normal;
  double distance = 0.0;
};

Eigen::Vector3d row(const PathMatrix& x, std::int64_t i) { return x.row(i).transpose(); }

// The faces of the hull of a few rows, each perhaps several times: of every three, whether the others lie on
// one side. Their corners, counter-clockwise from outside.
std::vector<OuterSamples::Triangle> faces_of(const PathMatrix& x, const std::vector<std::int64_t>& rows) {
  constexpr double kFlat = 1e-9;  // of the extent
  std::vector<Eigen::Vector3d> corners;
  for (const auto i : rows) corners.push_back(row(x, i) - row(x, rows.front()));
  double scale = 0.0;
  for (const auto& corner : corners) scale = std::max(scale, corner.cwiseAbs().maxCoeff());
  if (!(scale > 0.0)) return {};
  for (auto& corner : corners) corner /= scale;
  std::vector<OuterSamples::Triangle> out;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        const Eigen::Vector3d normal = (corners[j] - corners[i]).cross(corners[k] - corners[i]);
        const double flat = kFlat * normal.norm();
        if (!(flat > kFlat * kFlat)) continue;
        double least = 0.0, most = 0.0;
        for (const auto& corner : corners) {
          const double side = normal.dot(corner - corners[i]);
          least = std::min(least, side), most = std::max(most, side);
          if (least < -flat && most > flat) break;
        }
        if (most <= flat) out.push_back({rows[i], rows[j], rows[k]});
        if (least >= -flat) out.push_back({rows[i], rows[k], rows[j]});
      }
  return out;
}

// The farthest rows along axes to a grid's points on a half of a cube, both ways: 13 of a grid from -1 to 1,
// 62 of one from -2 to 2.
struct Extremes {
  const double *x, *y, *z;
  std::int64_t count;
  Eigen::Vector3d axis;
  double least, most;
};
[[gnu::always_inline]] inline void find_extremes(Extremes* of) {
  Lanes least, most;
  spread(least, of->least), spread(most, of->most);
  const double a = of->axis[0], b = of->axis[1], c = of->axis[2];
  for (std::int64_t i = 0; i < of->count; i += kLanes) {
    Lanes x, y, z;
    load(x, of->x + i), load(y, of->y + i), load(z, of->z + i);
    const Lanes along = a * x + b * y + c * z;
    least = along < least ? along : least;
    most = along > most ? along : most;
  }
  for (int k = 0; k < kLanes; ++k)
    of->least = std::min(of->least, least[k]), of->most = std::max(of->most, most[k]);
}

std::vector<std::int64_t> farthest_both_ways(const PathMatrix& points, int grid) {
  std::vector<Eigen::Vector3d> axes;
  for (int x = -grid; x <= grid; ++x)
    for (int y = -grid; y <= grid; ++y)
      for (int z = -grid; z <= grid; ++z)
        if (std::tuple(x, y, z) > std::tuple(0, 0, 0)) axes.emplace_back(x, y, z);
  std::vector<double> least(axes.size(), INFINITY), most(axes.size(), -INFINITY);
  std::vector<std::int64_t> out(2 * axes.size(), 0);
  for (std::int64_t begin = 0; begin < points.rows(); begin += kBoxBlock) {
    const std::int64_t count = std::min(kBoxBlock, points.rows() - begin);
    for (std::size_t k = 0; k < axes.size(); ++k) {
      Extremes part{.x = points.col(0).data() + begin,
                    .y = points.col(1).data() + begin,
                    .z = points.col(2).data() + begin,
                    .count = count / kLanes * kLanes,
                    .axis = axes[k],
                    .least = least[k],
                    .most = most[k]};
      run_wide<find_extremes>(&part);
      if (part.least == least[k] && part.most == most[k] && count == kBoxBlock) continue;
      for (std::int64_t i = begin; i < begin + count; ++i) {
        const double along =
            axes[k][0] * points(i, 0) + axes[k][1] * points(i, 1) + axes[k][2] * points(i, 2);
        if (along < least[k]) least[k] = along, out[2 * k] = i;
        if (along > most[k]) most[k] = along, out[2 * k + 1] = i;
      }
    }
  }
  std::ranges::sort(out);
  out.erase(std::ranges::unique(out).begin(), out.end());
  return out;
}

// How far a block of points lies within all faces: the least of distance - normal . p, and of which face.
struct DepthBlock {
  const double *x, *y, *z;
  double *depth, *which;
  const Face* faces;
  std::size_t count;
};
[[gnu::always_inline]] inline void find_depth(const DepthBlock& of) {
  for (std::int64_t i = 0; i < kBoxBlock; i += kLanes) {
    Lanes x, y, z, depth, which, number;
    load(x, of.x + i), load(y, of.y + i), load(z, of.z + i);
    spread(depth, INFINITY), spread(which, 0.0), spread(number, 0.0);
    for (std::size_t k = 0; k < of.count; ++k) {
      const auto& face = of.faces[k];
      const Lanes here = face.distance - (face.normal[0] * x + face.normal[1] * y + face.normal[2] * z);
      const LaneBits nearer = here < depth;
      depth = nearer ? here : depth;
      which = nearer ? number : which;
      number += 1.0;
    }
    store(of.depth + i, depth), store(of.which + i, which);
  }
}

// Planes through the corners where they are now; none where a triangle has no direction.
std::vector<Face> planes_of(const PathMatrix& x, const std::vector<OuterSamples::Triangle>& triangles) {
  std::vector<Face> out;
  for (const auto& corner : triangles) {
    const Eigen::Vector3d first = row(x, corner[0]);
    const Eigen::Vector3d normal = (row(x, corner[1]) - first).cross(row(x, corner[2]) - first);
    if (!(normal.norm() > 0.0)) return {};
    out.push_back({.normal = normal.normalized(), .distance = normal.normalized().dot(first)});
  }
  return out;
}

// Depth of every point.
// @param which  number of the face that it is nearest to or farthest outside of, for each
Eigen::VectorXd depths(const PathMatrix& points, const std::vector<Face>& faces, double* which) {
  const std::int64_t n = points.rows();
  Eigen::VectorXd out(n);
  std::array<double, kBoxBlock> depth, number;
  Eigen::Matrix<double, kBoxBlock, 3> rest;
  for (std::int64_t i = 0; i < n; i += kBoxBlock) {
    DepthBlock block{.x = points.col(0).data() + i,
                     .y = points.col(1).data() + i,
                     .z = points.col(2).data() + i,
                     .depth = depth.data(),
                     .which = number.data(),
                     .faces = faces.data(),
                     .count = faces.size()};
    if (n - i < kBoxBlock) {
      rest.setZero();
      rest.topRows(n - i) = points.bottomRows(n - i);
      block.x = rest.col(0).data(), block.y = rest.col(1).data(), block.z = rest.col(2).data();
    }
    run_wide<find_depth>(block);
    const std::int64_t count = std::min(kBoxBlock, n - i);
    std::copy_n(depth.begin(), count, out.data() + i);
    std::copy_n(number.begin(), count, which + i);
  }
  return out;
}

// Those of some points outside a face that may be corners of the hull: the farthest, and those that are not
// in the tetrahedron that it makes with the face, face by face of that (as in quickhull, Barber et al. 1996).
struct Outside {
  const PathMatrix& points;
  double margin;
  std::vector<std::int64_t>& kept;

  void keep(const std::array<Eigen::Vector3d, 3>& corner, const std::vector<std::int64_t>& some, int level) {
    if (some.size() < 3 || level == kLevels) {
      kept.insert(kept.end(), some.begin(), some.end());
      return;
    }
    const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    std::int64_t farthest = some.front();
    for (const auto i : some)
      if (normal.dot(row(points, i) - row(points, farthest)) > 0.0) farthest = i;
    const Eigen::Vector3d apex = row(points, farthest);
    if (normal.dot(apex - corner[0]) <= margin * normal.norm()) {
      kept.insert(kept.end(), some.begin(), some.end());  // all of them lie on the face
      return;
    }
    std::array<Face, 3> sides;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d side = (corner[(k + 1) % 3] - corner[k]).cross(apex - corner[k]);
      if (!(side.norm() > 0.0)) {
        kept.insert(kept.end(), some.begin(), some.end());
        return;
      }
      sides[k] = {.normal = side.normalized(), .distance = side.normalized().dot(apex)};
    }
    kept.push_back(farthest);
    std::array<std::vector<std::int64_t>, 3> beyond;
    for (const auto i : some) {
      if (i == farthest) continue;
      const Eigen::Vector3d p = row(points, i);
      std::size_t most = 0;
      double height = -INFINITY;
      for (std::size_t k = 0; k < 3; ++k)
        if (const double above = sides[k].normal.dot(p) - sides[k].distance; above > height)
          height = above, most = k;
      if (height > -margin) beyond[most].push_back(i);
    }
    for (std::size_t k = 0; k < 3; ++k) keep({corner[k], corner[(k + 1) % 3], apex}, beyond[k], level + 1);
  }
};

// Those points that may be corners of their hull, by the polyhedron with the corners of some triangles: what
// sees all its faces from inside lies in it, even where it is not convex, and so in the hull of all points.
PathMatrix outermost(const PathMatrix& points, const PathMatrix& x,
                     const std::vector<OuterSamples::Triangle>& triangles, double margin) {
  const auto faces = planes_of(x, triangles);
  if (faces.size() < 4) return points;
  std::vector<double> which(at(points.rows()));
  const auto depth = depths(points, faces, which.data());
  std::vector<std::vector<std::int64_t>> outside(faces.size());
  for (std::int64_t i = 0; i < points.rows(); ++i)
    if (!(depth[i] > margin)) outside[static_cast<std::size_t>(which[at(i)])].push_back(i);
  std::vector<std::int64_t> kept;
  Outside sort_out{.points = points, .margin = margin, .kept = kept};
  for (std::size_t k = 0; k < faces.size(); ++k)
    sort_out.keep({row(x, triangles[k][0]), row(x, triangles[k][1]), row(x, triangles[k][2])}, outside[k], 0);
  PathMatrix out(static_cast<Eigen::Index>(kept.size()), 3);
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = points.row(kept[at(i)]);
  return out;
}

}  // namespace

double width_ratio(const PathMatrix& in_plane) {
  constexpr Eigen::Index kWidths = 4096;
  const Eigen::Index n = in_plane.rows(), step = std::max<Eigen::Index>(1, (n + kWidths - 1) / kWidths);
  Points points;
  for (Eigen::Index i = 0; i < n; i += step) points.emplace_back(in_plane(i, 0), in_plane(i, 1));
  if (points.size() < 3) return kNaN;
  const Points hull = hull_of(std::move(points));
  if (hull.size() < 3) return kNaN;
  // The least width lies across an edge, the largest between two corners: of each edge the corner farthest
  // from it, which goes around as the edge does (Shamos 1978).
  double least = INFINITY, largest = 0.0;
  std::size_t across = 1;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const auto &from = hull[i], &to = hull[(i + 1) % hull.size()];
    const auto next = [&hull](std::size_t k) { return (k + 1) % hull.size(); };
    while (turn(from, to, hull[next(across)]) > turn(from, to, hull[across])) across = next(across);
    least = std::min(least, turn(from, to, hull[across]) / (to - from).norm());
    largest = std::max({largest, (hull[across] - from).norm(), (hull[across] - to).norm()});
  }
  return largest / least;
}

OuterSamples outer_samples(const PathMatrix& x) {
  OuterSamples out;
  const std::int64_t n = x.rows();
  out.order.resize(at(n));
  std::iota(out.order.begin(), out.order.end(), 0);
  if (n < kMany) return out;
  out.coarse = faces_of(x, farthest_both_ways(x, 1));
  if (out.coarse.size() < 4 || out.coarse.size() > kManyFaces) return out;
  std::vector<OuterSamples::Triangle> fine;
  if (n >= kVeryMany) fine = faces_of(x, farthest_both_ways(x, 2));
  const auto& triangles = fine.size() < 4 || fine.size() > kManyFaces ? out.coarse : fine;
  for (const auto& triangle : triangles)
    out.corners.insert(out.corners.end(), triangle.begin(), triangle.end());
  std::ranges::sort(out.corners);
  out.corners.erase(std::ranges::unique(out.corners).begin(), out.corners.end());
  std::vector<double> which(at(n));
  const auto depth = depths(x, planes_of(x, triangles), which.data());
  std::ranges::sort(out.order, [&](std::int64_t a, std::int64_t b) { return depth[a] < depth[b]; });
  for (const auto i : out.order) out.depth.push_back(depth[i]);
  return out;
}

Eigen::Vector3d smallest_box(const PathMatrix& x, const PrincipalAxes& principal) {
  return smallest_box(x, principal, outer_samples(x), x);
}

Eigen::Vector3d smallest_box(const PathMatrix& x, const PrincipalAxes& principal, const OuterSamples& near,
                             const PathMatrix& near_x) {
  Eigen::Matrix3d axes = principal.axes;
  const double margin = kInside * (x.colwise().maxCoeff() - x.colwise().minCoeff()).maxCoeff();
  PathMatrix centred = x;
  if (!near.depth.empty()) {
    // A sample that was deeper in the near path's hull than it and the corners of this have moved is no
    // corner.
    const Eigen::VectorXd moved = deviations(x, near_x);
    double of_corners = margin;
    for (const auto i : near.corners) of_corners = std::max(of_corners, moved[i] + margin);
    const double most = of_corners + moved.maxCoeff();
    std::int64_t kept = 0;
    for (std::size_t i = 0; i < near.order.size() && near.depth[i] <= most; ++i) {
      const auto sample = near.order[i];
      if (near.depth[i] <= of_corners + moved[sample]) centred.row(kept++) = x.row(sample);
    }
    centred = outermost(centred.topRows(kept), x, near.coarse, margin);
  }
  centred.rowwise() -= principal.mean;
  const auto sides = [&centred](const Eigen::Matrix3d& along) -> Eigen::Vector3d {
    const PathMatrix p = centred * along;
    return (p.colwise().maxCoeff() - p.colwise().minCoeff()).transpose();
  };
  Eigen::Vector3d best = sides(axes);
  for (int unchanged = 0, k = 2, step = 0; unchanged < 3 && step < 60; ++step, k = (k + 2) % 3) {
    // The rectangle across axis k, in the plane of the two others.
    const Eigen::Vector3d first = axes.col((k + 1) % 3), second = axes.col((k + 2) % 3);
    const Eigen::VectorXd u = centred * first, w = centred * second;
    Points points;
    for (Eigen::Index i = 0; i < u.size(); ++i) points.emplace_back(u[i], w[i]);
    const Points hull = hull_of(std::move(points));
    const Eigen::Vector2d side = best_side(hull), other(-side.y(), side.x());
    Eigen::Matrix3d turned = axes;
    turned.col((k + 1) % 3) = side.x() * first + side.y() * second;
    turned.col((k + 2) % 3) = other.x() * first + other.y() * second;
    Eigen::Vector3d found = best;
    found[(k + 1) % 3] = extent(hull, side), found[(k + 2) % 3] = extent(hull, other);
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
