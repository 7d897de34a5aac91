// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/balance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNear_m = 0.03;  // over the ground, of what stands on it
constexpr double kStanding_m_per_s = 0.4;
constexpr double kTravels_m_per_s = 0.2;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Of all points of both feet, in a frame.
double ground_height(const BodySeries& series, const Vector3d& up, std::int64_t f) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& foot : series.outline)
    for (const auto& point : foot) lowest = std::min(lowest, point.row(f).dot(up));
  return lowest;
}

// Mean height of the mass centre over the lowest point that the feet reach in the stretch.
double pendulum_of(const BodySeries& series, const Vector3d& up, std::int64_t first, std::int64_t count) {
  double ground = std::numeric_limits<double>::infinity();
  for (std::int64_t f = first; f < first + count; ++f)
    ground = std::min(ground, ground_height(series, up, f));
  return (series.centre.middleRows(first, count) * up).mean() - ground;
}

Vector2d extrapolated_at(const BodySeries& series, const BodyRecord& record, const Level& level,
                         double pendulum, std::int64_t f) {
  return extrapolated(level(series.centre.row(f)), level(series.centre_velocity.row(f)), pendulum,
                      record.gravity);
}

}  // namespace

Level level_of(const Vector3d& up) {
  Eigen::Index first = 0;
  // The first axis that is not nearly vertical.
  while (first < 2 && std::abs(up[first]) > 0.7) ++first;
  const Vector3d e1 = (Vector3d::Unit(first) - up[first] * up).normalized();
  return {e1, up.cross(e1)};
}

std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  // Andrew's monotone chain.
  std::ranges::sort(points, [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::ranges::unique(points).begin(), points.end());
  if (points.size() < 3) return points;
  std::vector<Vector2d> hull;
  const auto chain = [&hull](const auto& range) {
    const std::size_t begin = hull.size();
    for (const Vector2d& p : range) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 0.0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
  };
  chain(points);
  std::ranges::reverse(points);
  chain(points);
  return hull;
}

double distance_inside(const Vector2d& point, std::span<const Vector2d> hull) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = hull.size() > 2;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const Vector2d along = b - a;
    const double length = along.squaredNorm();
    const double share = length > 0.0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (point - a - share * along).norm());
    inside = inside && cross(along, point - a) >= 0.0;
  }
  if (hull.empty()) return kNaN;
  return inside ? nearest : -nearest;
}

Eigen::MatrixX<bool> feet_on_ground(const BodySeries& series, const Vector3d& up, double rate_hz) {
  const auto frames = series.q.rows();
  Eigen::MatrixX<bool> out = Eigen::MatrixX<bool>::Constant(frames, 2, false);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& foot = series.outline[side];
    if (foot.empty() || frames < 2) continue;
    std::vector<double> lowest(at(frames));
    std::vector<std::size_t> which(at(frames));
    for (Eigen::Index f = 0; f < frames; ++f) {
      lowest[at(f)] = std::numeric_limits<double>::infinity();
      for (std::size_t p = 0; p < foot.size(); ++p)
        if (const double height = foot[p].row(f).dot(up); height < lowest[at(f)])
          lowest[at(f)] = height, which[at(f)] = p;
    }
    const double ground = math::quantile(lowest, 0.1);
    for (Eigen::Index f = 0; f < frames; ++f) {
      const auto& point = foot[which[at(f)]];
      const Eigen::Index before = std::max<Eigen::Index>(0, f - 1), after = std::min(frames - 1, f + 1);
      const double speed =
          rate_hz * (point.row(after) - point.row(before)).norm() / static_cast<double>(after - before);
      out(f, static_cast<Eigen::Index>(side)) = lowest[at(f)] < ground + kNear_m && speed < kStanding_m_per_s;
    }
  }
  return out;
}

Eigen::VectorXd stability_margins(const BodySeries& series, const BodyRecord& record,
                                  const Eigen::MatrixX<bool>& contact, std::int64_t first,
                                  std::int64_t count) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(count, kNaN);
  if (series.centre.rows() == 0 || (series.outline[0].empty() && series.outline[1].empty())) return out;
  const auto level = level_of(record.up);
  const double pendulum = pendulum_of(series, record.up, first, count);
  if (!(pendulum > 0.0)) return out;
  for (std::int64_t f = first; f < first + count; ++f) {
    std::vector<Vector2d> points;
    for (std::size_t side = 0; side < 2; ++side)
      if (contact(f, static_cast<Eigen::Index>(side)))
        for (const auto& point : series.outline[side]) points.push_back(level(point.row(f)));
    out[f - first] =
        distance_inside(extrapolated_at(series, record, level, pendulum, f), convex_hull(std::move(points)));
  }
  return out;
}

Eigen::VectorXd lateral_margins(const BodySeries& series, const BodyRecord& record,
                                const Eigen::MatrixX<bool>& contact, data::Side side, std::int64_t first,
                                std::int64_t count) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(count, kNaN);
  const auto& foot = series.outline[data::index_of(side)];
  if (series.centre.rows() == 0 || foot.empty()) return out;
  const auto level = level_of(record.up);
  const Vector2d travels = level(series.centre_velocity.middleRows(first, count).colwise().mean());
  const double pendulum = pendulum_of(series, record.up, first, count);
  if (travels.norm() < kTravels_m_per_s || !(pendulum > 0.0)) return out;
  // Left is a quarter turn counterclockwise, seen from above.
  const Vector2d left = Vector2d(-travels.y(), travels.x()).normalized();
  const Vector2d outwards = side == data::Side::left ? left : Vector2d(-left);
  for (std::int64_t f = first; f < first + count; ++f) {
    if (!contact(f, static_cast<Eigen::Index>(data::index_of(side)))) continue;
    double border = -std::numeric_limits<double>::infinity();
    for (const auto& point : foot) border = std::max(border, level(point.row(f)).dot(outwards));
    out[f - first] = border - extrapolated_at(series, record, level, pendulum, f).dot(outwards);
  }
  return out;
}

}  // namespace kinemark::analysis
