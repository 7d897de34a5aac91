// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/plates/internal/moment_unit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace kinemark::io::internal {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kFewest = 5;
constexpr double kShare = 0.95;
constexpr double kMetresOff = 3.0, kSidesOff = 5.0;  // m, and halves of the plate
constexpr double kFromTheMiddle = 0.02;              // m; nobody stands with both feet so near to it

/// Of the loaded frames, from the middle of the surface.
std::vector<Vector2d> loaded_points(std::span<const Vector6> wrenches) {
  std::vector<Vector2d> out;
  for (const Vector6& w : wrenches)
    if (w.allFinite() && std::abs(w[2]) >= kSurelyLoaded) out.emplace_back(-w[4] / w[2], w[3] / w[2]);
  return out;
}

template <typename Rule>
double share_of(const std::vector<Vector2d>& points, const Rule& rule) {
  return static_cast<double>(std::ranges::count_if(points, rule)) / static_cast<double>(points.size());
}

}  // namespace

bool is_on_plate(const Vector2d& point, const Vector2d& half_size) {
  return (point.array().abs() < 1.2 * half_size.array() + 0.02).all();
}

bool is_a_thousandth(std::span<const Vector6> larger, std::span<const Vector6> smaller, bool is_smaller,
                     const Vector2d& half_size) {
  const auto far = loaded_points(larger), near = loaded_points(smaller);
  if (far.size() < kFewest) return false;
  const auto on_plate = [&](const Vector2d& point) { return is_on_plate(point, half_size); };
  if (is_smaller) {
    const double off = std::max(kMetresOff, kSidesOff * half_size.maxCoeff());
    // Another factor, of 30 say, would become a foot that stands in the middle.
    return share_of(far, [&](const Vector2d& point) { return point.norm() > off; }) >= kShare &&
           share_of(near, on_plate) >= kShare &&
           share_of(near, [](const Vector2d& point) { return point.norm() > kFromTheMiddle; }) >= 0.5;
  }
  // What both have in common, of the depth of the sensors, is not of the moments.
  std::vector<Vector2d> moved(far.size());
  std::ranges::transform(far, near, moved.begin(),
                         [](const Vector2d& a, const Vector2d& b) -> Vector2d { return a - b; });
  return share_of(far, on_plate) >= kShare &&
         share_of(moved, [](const Vector2d& by) { return by.norm() > kFromTheMiddle; }) >= 0.5;
}

}  // namespace kinemark::io::internal
