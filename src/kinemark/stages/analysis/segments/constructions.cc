// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/constructions.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

const Eigen::Vector3d kNowhere = Eigen::Vector3d::Constant(kNaN);

}  // namespace

double turn_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d n = axis.normalized();
  const Eigen::Vector3d a = from - from.dot(n) * n, b = to - to.dot(n) * n;
  if (!(a.norm() > 0.0) || !(b.norm() > 0.0)) return kNaN;
  return std::atan2(n.dot(a.cross(b)), a.dot(b));
}

// The centre is on the circle on which the line to the marker (length d) is perpendicular to that to the
// proximal centre: marker + d^2 / L e + d s (cos(p) u + sin(p) v), s = sqrt(1 - (d / L)^2), with e towards
// the proximal centre at L, u away from the wand and v = e x u; p = 0 is the plane of the three. With the
// wand q beside e and w along it, tan(turn) demands sin(p + atan(s t)) = -d t (1 - w / L) / (q sqrt(1 + s^2
// t^2)).
Eigen::Vector3d chord(const Eigen::Vector3d& wand, const Eigen::Vector3d& marker,
                      const Eigen::Vector3d& proximal, double distance, double turn_rad) {
  const Eigen::Vector3d along = proximal - marker;
  const double length = along.norm();
  const Eigen::Vector3d e = along / length;
  const Eigen::Vector3d to_wand = wand - marker;
  const double up = to_wand.dot(e);
  const Eigen::Vector3d across = to_wand - up * e;
  const double beside = across.norm();
  if (!(length > distance) || !(beside > 0.0) || !(distance >= 0.0)) return kNowhere;
  const Eigen::Vector3d u = -across / beside, v = e.cross(u);
  const double ratio = distance / length;
  const double s = std::sqrt(1.0 - ratio * ratio);
  double p = 0.0;
  if (turn_rad != 0.0) {
    if (!(std::abs(turn_rad) < 0.5 * std::numbers::pi)) return kNowhere;
    const double t = std::tan(turn_rad);
    const double sine = distance * (1.0 - up / length) * t / (beside * std::sqrt(1.0 + s * s * t * t));
    if (!(std::abs(sine) <= 1.0)) return kNowhere;
    p = -std::asin(sine) - std::atan(s * t);
  }
  return marker + distance * (ratio * e + s * (std::cos(p) * u + std::sin(p) * v));
}

Eigen::Vector3d corner(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& towards) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (!(normal.norm() > 0.0)) return kNowhere;
  // Rods of length r make a triangle of sides r sqrt(2), whose middle is r / sqrt(3) from the corner. Sides
  // as measured differ: their root mean square counts, as in Vicon's virtual knee marker.
  const double side =
      std::sqrt(((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm()) / 3.0);
  const Eigen::Vector3d middle = (a + b + c) / 3.0;
  const double sign = normal.dot(towards - middle) < 0.0 ? -1.0 : 1.0;
  return middle + normal.normalized() * (sign * side / std::sqrt(6.0));
}

}  // namespace kinemark::analysis
