// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/constructions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

const Eigen::Vector3d kNowhere = Eigen::Vector3d::Constant(kNaN);
constexpr int kMostSecants = 40;
constexpr double kEnough_rad = 1e-13;

}  // namespace

double turn_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d n = axis.normalized();
  const Eigen::Vector3d a = from - from.dot(n) * n, b = to - to.dot(n) * n;
  if (!(a.norm() > 0.0) || !(b.norm() > 0.0)) return kNaN;
  return std::atan2(n.dot(a.cross(b)), a.dot(b));
}

// The centre is on the circle on which the line to the marker (length d) is perpendicular to that to the
// proximal centre: marker + d^2 / L e + d sqrt(1 - (d / L)^2) (cos(p) u + sin(p) v), with e towards the
// proximal centre at L, u away from the wand and v = e x u. p = 0 is the plane of the three. The wand's angle
// about the line from the centre to the proximal one is monotonous in p where it matters: secant steps.
Eigen::Vector3d chord(const Eigen::Vector3d& wand, const Eigen::Vector3d& marker,
                      const Eigen::Vector3d& proximal, double distance, double turn_rad) {
  const Eigen::Vector3d along = proximal - marker;
  const double length = along.norm();
  const Eigen::Vector3d e = along / length;
  const Eigen::Vector3d to_wand = wand - marker;
  const Eigen::Vector3d across = to_wand - to_wand.dot(e) * e;
  if (!(length > distance) || !(across.norm() > 0.0) || !(distance >= 0.0)) return kNowhere;
  const Eigen::Vector3d u = -across.normalized(), v = e.cross(u);
  const double ratio = distance / length;
  const Eigen::Vector3d middle = marker + distance * ratio * e;
  const double radius = distance * std::sqrt(1.0 - ratio * ratio);
  const auto centre = [&](double p) -> Eigen::Vector3d {
    return middle + radius * (std::cos(p) * u + std::sin(p) * v);
  };
  if (turn_rad == 0.0) return centre(0.0);
  const auto miss = [&](double p) {
    const Eigen::Vector3d c = centre(p);
    return std::remainder(turn_about(proximal - c, marker - c, wand - c) - turn_rad, 2.0 * std::numbers::pi);
  };
  double before = 0.0, miss_before = miss(before);
  double p = -turn_rad, now = miss(p);
  for (int step = 0; step < kMostSecants && std::abs(now) > kEnough_rad && now != miss_before; ++step) {
    const double next = p - std::clamp(now * (p - before) / (now - miss_before), -0.5, 0.5);
    before = p;
    miss_before = now;
    p = next;
    now = miss(p);
  }
  if (!(std::abs(now) < 1e-9)) return kNowhere;
  return centre(p);
}

Eigen::Vector3d corner(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& towards) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (!(normal.norm() > 0.0)) return kNowhere;
  // Rods of length r make a triangle of sides r sqrt(2), whose middle is r / sqrt(3) from the corner.
  const double side = ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3.0;
  const Eigen::Vector3d middle = (a + b + c) / 3.0;
  const double sign = normal.dot(towards - middle) < 0.0 ? -1.0 : 1.0;
  return middle + normal.normalized() * (sign * side / std::sqrt(6.0));
}

}  // namespace kinemark::analysis
