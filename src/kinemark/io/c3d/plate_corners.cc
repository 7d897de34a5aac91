// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "kinemark/io/c3d/internal/plate_corners.h"

namespace kinemark::io::internal {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 4>;

constexpr double kShortest = 0.1, kLongest = 3.0;  // m, of the longest side of a plate
constexpr double kParallel = 0.95;                 // cosine
constexpr double kLevel = 0.7;                     // cosine; of a plate in a floor, on stairs or on a ramp
constexpr double kDeepest = 0.3;                   // m, of sensors below the surface
constexpr std::array<std::pair<const char*, double>, 3> kUnits{{{"mm", 0.001}, {"m", 1.0}, {"cm", 0.01}}};

bool is_side(double length_m) { return length_m >= kShortest && length_m <= kLongest; }

/// Of the sensors below the surface, and beside its middle.
bool is_depth(double length_m) { return length_m >= 1e-3 && length_m <= 1.0; }

double longest_side(const Corners& c) {
  return std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[3] - c[2]).norm(), (c[0] - c[3]).norm()});
}

/// Across the plate, of corners that go around it; nothing where they cross over or lie on one line.
std::optional<Vector3d> normal_of(const Corners& c) {
  const Vector3d along = c[1] - c[0], back = c[2] - c[3];
  const Vector3d up = c[3] - c[0], down = c[2] - c[1];
  const Vector3d normal = along.cross(up);
  const auto parallel = [](const Vector3d& a, const Vector3d& b) {
    return a.dot(b) > kParallel * a.norm() * b.norm();
  };
  if (!(normal.norm() > 0.0) || !parallel(along, back) || !parallel(up, down)) return std::nullopt;
  return normal.normalized();
}

/// The axis of the laboratory that a direction is nearest to.
Eigen::Index axis_of(const Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// An origin that no plate has, and that would be one in mm or m, is taken so; said unless its corners were
/// in the same unit (`applied` to them).
void settle_origin_unit(data::ForcePlate& plate, double metres_per_unit, double applied,
                        std::vector<std::string>& warnings) {
  const Vector3d origin = plate.origin_in_plate;
  if (is_depth(origin.norm()) || !(origin.norm() > 0.0) || !(metres_per_unit > 0.0)) return;
  const double side = longest_side(plate.corners_in_world);
  for (const auto& [unit, metres] : std::span(kUnits).first(2)) {  // a depth in cm may be one in mm
    const double factor = metres / metres_per_unit;
    const Vector3d other = factor * origin;
    if (!is_depth(std::abs(other.z())) || std::abs(other.z()) > kDeepest) continue;
    if (other.head<2>().cwiseAbs().maxCoeff() > side) continue;
    plate.origin_in_plate = other;
    if (factor != applied)
      warnings.push_back(fmt::format(
          "force plate {} would have its sensors {:.3g} mm below its surface by ORIGIN in the unit of the "
          "points; ORIGIN is taken for {}, {:.3g} mm: the centre of pressure moves by that times the slope "
          "of the force",
          plate.number, 1e3 * std::abs(origin.z()), unit, 1e3 * std::abs(other.z())));
    return;
  }
}

}  // namespace

Vector3d plate_corner(const C3dParameter* corners, std::size_t i, std::size_t c) {
  Vector3d out = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  if (corners == nullptr || corners->numbers.size() < 12 * (i + 1)) return out;
  const auto& dims = corners->dims;
  const bool turned = dims.size() >= 2 && dims[0] == 4 && dims[1] == 3;
  for (std::size_t k = 0; k < 3; ++k)
    out[static_cast<Eigen::Index>(k)] = corners->numbers[12 * i + (turned ? 4 * k + c : 3 * c + k)];
  return out;
}

void settle_plate_unit(data::ForcePlate& plate, double metres_per_unit, std::vector<std::string>& warnings) {
  const double side = longest_side(plate.corners_in_world);
  double applied = 1.0;
  if (!is_side(side) && side > 0.0 && metres_per_unit > 0.0)
    for (const auto& [unit, metres] : kUnits) {
      const double factor = metres / metres_per_unit;
      if (!is_side(factor * side)) continue;
      for (auto& corner : plate.corners_in_world) corner *= factor;
      applied = factor;
      warnings.push_back(
          fmt::format("force plate {} would have a side of {:.3g} m in the unit of the points; its corners "
                      "are taken for {}, {:.3g} m",
                      plate.number, side, unit, factor * side));
      break;
    }
  settle_origin_unit(plate, metres_per_unit, applied, warnings);
}

void settle_corner_order(std::span<data::ForcePlate> plates, std::vector<std::string>& warnings) {
  Vector3d usual = Vector3d::Zero();
  for (const auto& plate : plates)
    if (const auto normal = normal_of(plate.corners_in_world)) usual += *normal;
  const bool alone = !(usual.norm() > 0.5);
  constexpr std::array<std::array<std::size_t, 2>, 4> kExchanges{{{2, 3}, {0, 1}, {1, 2}, {0, 3}}};
  for (auto& plate : plates) {
    if (normal_of(plate.corners_in_world)) continue;
    for (const auto& [a, b] : kExchanges) {
      Corners other = plate.corners_in_world;
      std::swap(other[a], other[b]);
      const auto normal = normal_of(other);
      if (!normal) continue;
      const auto axis = axis_of(*normal);
      if (alone ? !((*normal)[axis] < -kLevel) : normal->dot(usual) < kParallel * usual.norm()) continue;
      plate.corners_in_world = other;
      warnings.push_back(fmt::format(
          "force plate {} has corners that cross over; corners {} and {} are exchanged, so that they go "
          "around it {}",
          plate.number, a + 1, b + 1,
          alone ? fmt::format("and its z points down ({} of the laboratory is taken as up); its x and y are "
                              "those of this order, which nothing else in the file confirms",
                              "xyz"[axis])
                : std::string("as those of the other plates do")));
      break;
    }
  }
}

}  // namespace kinemark::io::internal
