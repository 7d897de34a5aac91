// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/wrapped_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;

constexpr double kRound = 0.05;

data::PathWrap around(const std::string& name, int first = -1, int last = -1) {
  return {.surface = {.name = name, .is_cylinder = true, .radius = kRound, .length = 1.0},
          .first_point = first,
          .last_point = last};
}

math::SE3 moved(double x, double y) { return {.translation = Vector3d(x, y, 0.0)}; }

std::vector<PassedPoint> passed(const std::vector<Vector3d>& x) {
  std::vector<PassedPoint> points;
  for (std::size_t i = 0; i < x.size(); ++i) points.push_back({static_cast<int>(i), x[i]});
  return points;
}

/// Over a cylinder in the middle between two points on one height, both `half` away from its axis and `low`
/// below.
double over_one(double half, double low) {
  const double distance = std::hypot(half, low);
  const double turn = std::numbers::pi - 2.0 * std::acos(kRound / distance) + 2.0 * std::atan2(low, half);
  return 2.0 * std::sqrt(distance * distance - kRound * kRound) + kRound * turn;
}

TEST(WrappedPath, without_surfaces_it_is_straight_from_point_to_point) {
  const auto points = passed({{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.4, 0}});
  EXPECT_NEAR(wrapped_length(points, {}, {}), 0.7, 1e-15);
  EXPECT_EQ(wrapped_length({}, {}, {}), 0.0);
}

TEST(WrappedPath, goes_around_the_cylinder_that_it_meets) {
  const auto points = passed({{-0.2, -0.01, 0}, {0.2, -0.01, 0}});
  const std::vector wraps{around("a")};
  // The axis passes 0.01 above the way: round below.
  EXPECT_NEAR(wrapped_length(points, wraps, std::vector{moved(0.0, 0.0)}), over_one(0.2, -0.01), 1e-14);
  EXPECT_NEAR(wrapped_length(points, wraps, std::vector{moved(0.0, -1.0)}), 0.4, 1e-15);
}

TEST(WrappedPath, a_surface_that_is_switched_off_or_no_cylinder_is_passed_through) {
  const auto points = passed({{-0.2, 0.01, 0}, {0.2, 0.01, 0}});
  auto off = around("a"), ellipsoid = around("a");
  off.surface.active = false;
  ellipsoid.surface.is_cylinder = false;
  for (const auto& wrap : {off, ellipsoid})
    EXPECT_NEAR(wrapped_length(points, std::vector{wrap}, std::vector{moved(0.0, 0.0)}), 0.4, 1e-15);
}

TEST(WrappedPath, only_pieces_within_the_range_wrap) {
  // Through the cylinder between the first and the second point, and back beside it.
  const auto points = passed({{-0.2, 0.01, 0}, {0.2, 0.01, 0}, {0.2, 0.2, 0}});
  const std::vector pose{moved(0.0, 0.0)};
  const double straight = 0.4 + 0.19, bent = over_one(0.2, -0.01) + 0.19;
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a")}, pose), bent, 1e-14);
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a", 0, 1)}, pose), bent, 1e-14);
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a", 1, 2)}, pose), straight, 1e-15);
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a", 2, -1)}, pose), straight, 1e-15);
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a", 7, 9)}, pose), straight, 1e-15);
}

TEST(WrappedPath, the_range_counts_points_of_the_path_not_those_passed) {
  // The second of four points does not count in this pose.
  const std::vector<PassedPoint> points{{0, {-0.2, 0.3, 0}}, {2, {-0.2, 0.01, 0}}, {3, {0.2, 0.01, 0}}};
  const std::vector pose{moved(0.0, 0.0)};
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a", 1, 3)}, pose), 0.29 + over_one(0.2, -0.01),
              1e-14);
  EXPECT_NEAR(wrapped_length(points, std::vector{around("a", 0, 1)}, pose), 0.29 + 0.4, 1e-15);
}

TEST(WrappedPath, of_two_pieces_that_could_wrap_the_one_with_the_smaller_detour_does) {
  // Held to +y while all points lie below: every piece may bend. The second is the one nearer to the
  // cylinder.
  auto wrap = around("a");
  wrap.surface.side_axis = 1;
  const auto points = passed({{-0.3, -0.3, 0}, {-0.2, -0.02, 0}, {0.2, -0.02, 0}});
  const double first = std::hypot(0.1, 0.28);
  EXPECT_NEAR(wrapped_length(points, std::vector{wrap}, std::vector{moved(0.0, 0.0)}),
              first + over_one(0.2, 0.02), 1e-14);
}

TEST(WrappedPath, several_cylinders_are_each_bent_around) {
  const auto points = passed({{-0.2, 0.01, 0}, {0.6, 0.01, 0}});
  const std::vector wraps{around("a"), around("b")};
  const std::vector poses{moved(0.0, 0.0), moved(0.4, 0.0)};
  // Both touched from above: tangents at the ends, and the straight line between the tops of equal circles.
  const double distance = std::hypot(0.2, 0.01);
  const double turn = 0.5 * std::numbers::pi - std::acos(kRound / distance) - std::atan2(0.01, 0.2);
  const double expected = 2.0 * (std::sqrt(distance * distance - kRound * kRound) + kRound * turn) + 0.4;
  EXPECT_NEAR(wrapped_length(points, wraps, poses), expected, 5e-4);  // the rounds end at 0.5 mm
  EXPECT_NEAR(wrapped_length(points, std::vector{wraps[1], wraps[0]}, std::vector{poses[1], poses[0]}),
              expected, 5e-4);
}

}  // namespace
}  // namespace kinemark::motion::internal
