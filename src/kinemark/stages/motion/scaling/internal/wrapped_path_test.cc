// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/wrapped_path.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadius = 0.04;

data::WrapSurface whole() {
  return {.name = "cylinder", .is_cylinder = true, .radius = kRadius, .length = 1.0};
}

data::WrapSurface side(int axis, int sign) {
  auto cylinder = whole();
  cylinder.side_axis = axis;
  cylinder.side_sign = sign;
  return cylinder;
}

double length_of(const Vector3d& from, const Vector3d& to, const CylinderWrap& wrap) {
  return (wrap.onto - from).norm() + wrap.arc_m + (to - wrap.off).norm();
}

/// Shortest way around the cylinder through `turn` rad of it: a straight line on the surface rolled flat.
double rolled_flat(const Vector3d& from, const Vector3d& to, double turn) {
  const auto straight = [](const Vector3d& x) {
    return std::sqrt(x.head<2>().squaredNorm() - kRadius * kRadius);
  };
  return std::hypot(straight(from) + kRadius * turn + straight(to), to.z() - from.z());
}

double between(const Vector3d& a, const Vector3d& b) {
  return std::acos(a.head<2>().normalized().dot(b.head<2>().normalized()));
}

/// Of points whose straight way goes through, on the nearer way round.
double turn_of(const Vector3d& from, const Vector3d& to) {
  return between(from, to) - std::acos(kRadius / from.head<2>().norm()) -
         std::acos(kRadius / to.head<2>().norm());
}

TEST(CylinderWrap, a_piece_across_the_axis_takes_tangents_and_an_arc) {
  const Vector3d from(-0.1, 0.01, 0.2), to(0.12, 0.005, 0.2);
  for (const bool settle : {false, true}) {
    const auto wrap = wrap_cylinder(from, to, whole(), settle);
    ASSERT_EQ(wrap.contact, Contact::needed);
    EXPECT_NEAR(length_of(from, to, wrap), rolled_flat(from, to, turn_of(from, to)), 1e-14);
    for (const auto& [touch, end] : {std::pair(wrap.onto, from), std::pair(wrap.off, to)}) {
      EXPECT_NEAR(touch.head<2>().norm(), kRadius, 1e-15);
      EXPECT_NEAR(touch.head<2>().dot((end - touch).head<2>()), 0.0, 1e-15);
      EXPECT_NEAR(touch.z(), 0.2, 1e-12);
      EXPECT_GT(touch.y(), 0.0);  // the nearer side
    }
  }
}

TEST(CylinderWrap, a_settled_way_is_the_shortest_one_to_a_millionth_of_a_metre) {
  Random random(41, 0);
  int seen = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d from(-0.05 - 0.1 * random.uniform(), 0.03 * random.uniform(), 0.1 * random.uniform());
    const Vector3d to(0.05 + 0.1 * random.uniform(), 0.03 * random.uniform(), 0.1 * random.uniform());
    const auto settled = wrap_cylinder(from, to, whole(), true),
               rough = wrap_cylinder(from, to, whole(), false);
    if (settled.contact != Contact::needed) continue;
    ++seen;
    const double shortest = rolled_flat(from, to, turn_of(from, to));
    EXPECT_GE(length_of(from, to, settled), shortest - 1e-14) << i;
    EXPECT_LE(length_of(from, to, settled), shortest + 1e-6) << i;
    EXPECT_GE(length_of(from, to, rough), shortest - 1e-14) << i;
    EXPECT_LE(length_of(from, to, rough), shortest + 2e-3) << i;
  }
  EXPECT_GT(seen, 100);
}

TEST(CylinderWrap, passes_by_what_it_does_not_meet) {
  EXPECT_EQ(wrap_cylinder({-0.1, 0.05, 0.0}, {0.1, 0.05, 0.0}, whole(), false).contact, Contact::none);
  EXPECT_EQ(wrap_cylinder({0.1, 0.0, 0.0}, {0.2, 0.001, 0.0}, whole(), false).contact,
            Contact::none);  // before it
  EXPECT_EQ(wrap_cylinder({-0.1, 0.0, 0.6}, {0.1, 0.001, 0.7}, whole(), false).contact,
            Contact::none);  // beyond its end
  EXPECT_EQ(wrap_cylinder({-0.1, 0.0, 0.3}, {0.1, 0.001, 0.6}, whole(), false).contact, Contact::needed);
  auto nothing = whole();
  nothing.radius = 0.0;
  EXPECT_EQ(wrap_cylinder({-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, nothing, false).contact, Contact::none);
  EXPECT_EQ(wrap_cylinder({0.1, 0.0, -0.1}, {0.1, 0.0, 0.1}, whole(), false).contact,
            Contact::none);  // along the axis
}

TEST(CylinderWrap, an_end_within_the_radius_leaves_the_piece_straight) {
  EXPECT_EQ(wrap_cylinder({0.03, 0.0, 0.0}, {0.2, 0.0, 0.0}, whole(), false).contact, Contact::inside);
  EXPECT_EQ(wrap_cylinder({0.2, 0.0, 0.0}, {0.0, 0.03, 0.4}, whole(), false).contact, Contact::inside);
}

TEST(CylinderWrap, keeps_to_the_side_that_it_must_keep_to) {
  // The nearer way is over +y. Held to -y, it goes round there, the long way.
  const Vector3d from(-0.1, 0.01, 0.0), to(0.1, 0.01, 0.0);
  const auto over = wrap_cylinder(from, to, side(1, 1), false),
             under = wrap_cylinder(from, to, side(1, -1), false);
  ASSERT_EQ(over.contact, Contact::needed);
  EXPECT_GT(over.onto.y(), 0.0);
  EXPECT_NEAR(length_of(from, to, over), rolled_flat(from, to, turn_of(from, to)), 1e-14);
  ASSERT_EQ(under.contact, Contact::possible);  // both ends are on the other side
  EXPECT_LT(under.onto.y(), 0.0);
  const double turn =
      2.0 * std::numbers::pi - between(from, to) - 2.0 * std::acos(kRadius / from.head<2>().norm());
  EXPECT_NEAR(length_of(from, to, under), rolled_flat(from, to, turn), 1e-14);
}

TEST(CylinderWrap, goes_more_than_half_around_where_its_side_asks_for_it) {
  // Both ends above the cylinder and close together: held below, the way goes nearly all around.
  const Vector3d from(-0.01, 0.1, 0.0), to(0.01, 0.1, 0.0);
  const auto wrap = wrap_cylinder(from, to, side(1, -1), false);
  ASSERT_EQ(wrap.contact, Contact::possible);
  EXPECT_GT(wrap.arc_m, std::numbers::pi * kRadius);
  const double turn =
      2.0 * std::numbers::pi - between(from, to) - 2.0 * std::acos(kRadius / from.head<2>().norm());
  EXPECT_NEAR(wrap.arc_m, kRadius * turn, 1e-14);
}

TEST(CylinderWrap, a_piece_on_the_right_side_that_does_not_go_through_stays_straight) {
  EXPECT_EQ(wrap_cylinder({-0.1, 0.05, 0.0}, {0.1, 0.06, 0.0}, side(1, 1), false).contact, Contact::none);
  // One end on the side, the nearest point of the way on the other: it is pulled over.
  EXPECT_EQ(wrap_cylinder({-0.1, -0.09, 0.0}, {0.1, 0.001, 0.0}, side(1, 1), false).contact,
            Contact::possible);
}

TEST(CylinderWrap, turned_mirrored_and_reversed_it_is_the_same_way) {
  const Vector3d from(-0.1, 0.01, 0.05), to(0.12, 0.015, -0.02);
  for (const bool settle : {false, true}) {
    const double length = length_of(from, to, wrap_cylinder(from, to, whole(), settle));
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d a = turn * from, b = turn * to;
    EXPECT_NEAR(length_of(a, b, wrap_cylinder(a, b, whole(), settle)), length, 1e-12);
    EXPECT_NEAR(length_of(to, from, wrap_cylinder(to, from, whole(), settle)), length, 1e-12);
    const Vector3d c(from.x(), from.y(), -from.z()), d(to.x(), to.y(), -to.z());
    EXPECT_NEAR(length_of(c, d, wrap_cylinder(c, d, whole(), settle)), length, 1e-12);
  }
}

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
