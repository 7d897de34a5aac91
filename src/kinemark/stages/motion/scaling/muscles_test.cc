// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/muscles.h"

#include <gtest/gtest.h>

#include <numbers>

#include "kinemark/math/euler.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/scaling/scale.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

/// Two bodies in a row: "thigh" from the ground, "shank" 0.4 m below it, a hinge q between.
data::ModelDescription hinge(double q = 0.0) {
  data::ModelDescription model{.name = "hinge"};
  model.bodies = {{.name = "thigh", .mass = 1.0}, {.name = "shank", .mass = 1.0}};
  model.coordinates = {{.name = "knee", .default_value = q}};
  model.joints = {{.name = "hip", .type = "WeldJoint", .child_body_idx = 0},
                  {.name = "knee_joint", .type = "CustomJoint", .parent_body_idx = 0, .child_body_idx = 1}};
  model.joints[1].parent_from_joint.translation = Vector3d(0.0, -0.4, 0.0);
  model.joints[1].axes = {{.axis = Vector3d::UnitZ(), .coordinate_idx = 0}};
  return model;
}

data::PathPoint at_body(int body, const Vector3d& x) { return {.body_idx = body, .x_in_frame = x}; }

/// From the front of the thigh to the front of the shank.
data::MusclePath front() {
  return {.name = "front", .points = {at_body(0, {0.05, 0.0, 0.0}), at_body(1, {0.05, -0.1, 0.0})}};
}

double length_of(const data::MusclePath& path, double q = 0.0) {
  const auto model = model::Model::compile(hinge(q)).value();
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  return path_length(model, w, path);
}

TEST(PathLength, goes_straight_from_point_to_point) {
  EXPECT_NEAR(length_of(front()), 0.5, 1e-15);
  auto via = front();
  via.points.insert(via.points.begin() + 1, at_body(data::kGround, {0.05, -0.3, 0.4}));
  EXPECT_NEAR(length_of(via), 0.5 + std::sqrt(0.04 + 0.16), 1e-15);
}

TEST(PathLength, a_conditional_point_counts_in_its_range_and_at_its_ends) {
  auto path = front();
  auto via = at_body(0, {0.2, -0.4, 0.0});
  via.condition_idx = 0;
  via.range_min = -1.0;
  via.range_max = 0.5;
  path.points.insert(path.points.begin() + 1, via);
  const double without = length_of(front(), 0.6);
  EXPECT_NEAR(length_of(path, 0.6), without, 1e-15);
  EXPECT_GT(length_of(path, 0.4), length_of(front(), 0.4) + 0.01);
  EXPECT_GT(length_of(path, 0.5 + 0.9e-5), length_of(front(), 0.5) + 0.01);
  EXPECT_NEAR(length_of(path, 0.5 + 1.1e-5), length_of(front(), 0.5 + 1.1e-5), 1e-15);
}

TEST(PathLength, a_moving_point_follows_its_coordinate_in_its_frame) {
  data::MusclePath path{.name = "moving", .points = {at_body(0, Vector3d::Zero()), at_body(1, {})}};
  auto& point = path.points[1];
  point.moves = true;
  point.body_from_frame.translation = Vector3d(0.0, -0.1, 0.0);
  point.place[0] = {.coordinate_idx = -1, .function = math::ScalarFunction::constant(0.0)};
  point.place[1] = {.coordinate_idx = 0, .function = math::ScalarFunction::linear(-0.2, -0.05)};
  point.place[2] = {.coordinate_idx = -1, .function = math::ScalarFunction::constant(0.0)};
  EXPECT_NEAR(length_of(path), 0.55, 1e-15);
  // Turned by q about the knee, the point is 0.15 + 0.2 q away from it.
  const double q = 0.3, away = 0.15 + 0.2 * q;
  EXPECT_NEAR(length_of(path, q), Vector3d(away * std::sin(q), -0.4 - away * std::cos(q), 0.0).norm(), 1e-15);
}

TEST(ScalePaths, every_length_grows_with_a_model_that_grows_alike_everywhere) {
  const auto before = hinge(0.7);
  auto after = before;
  const std::vector<Vector3d> factors(2, Vector3d::Constant(1.3));
  apply_factors(after, factors, true);
  auto moving = front();
  moving.name = "moving";
  moving.points[1].moves = true;
  for (auto& place : moving.points[1].place)
    place = {.coordinate_idx = 0, .function = math::ScalarFunction::linear(0.1, 0.02)};
  moving.points[0].body_from_frame.translation = Vector3d(0.01, 0.02, 0.03);
  const std::vector<data::MusclePath> paths{front(), moving};
  const auto scales = scale_paths(before, after, paths, factors).value();
  ASSERT_EQ(scales.size(), 2);
  for (const auto& scale : scales) {
    EXPECT_NEAR(scale.ratio, 1.3, 1e-14) << scale.name;
    EXPECT_NEAR(scale.after_m, 1.3 * scale.before_m, 1e-15) << scale.name;
  }
}

TEST(ScalePaths, a_path_takes_the_factors_of_its_own_bodies_and_axes) {
  const auto before = hinge();
  auto after = before;
  const std::vector<Vector3d> factors{Vector3d(1.0, 1.5, 1.0), Vector3d(3.0, 1.0, 7.0)};
  apply_factors(after, factors, true);
  auto wrapped = front();
  wrapped.wraps = {{.surface = {.name = "knee_ellipsoid", .body_idx = 0}}};
  const auto scale = scale_paths(before, after, std::vector{wrapped}, factors).value().front();
  EXPECT_NEAR(scale.after_m, std::hypot(0.1, 0.4 * 1.5 + 0.1), 1e-15);
  EXPECT_TRUE(scale.wraps);
  EXPECT_EQ(scale.name, "front");
}

TEST(ScalePaths, a_cylinder_takes_the_factors_of_its_body_along_its_own_axes) {
  data::MusclePath path{.name = "around",
                        .points = {at_body(0, {0.0, 0.1, 0.0}), at_body(0, {0.0, -0.1, 0.0})}};
  path.wraps = {
      {.surface = {.name = "bar", .is_cylinder = true, .body_idx = 0, .radius = 0.02, .length = 0.3}}};
  auto& bar = path.wraps[0].surface;
  bar.frame_from_surface.translation = Vector3d(0.01, 0.0, 0.2);
  bar.body_from_frame.translation = Vector3d(-0.005, 0.0, -0.2);
  const double before = length_of(path);
  EXPECT_GT(before, 0.2);
  const auto scaled = scale_path(path, std::vector<Vector3d>{{2.0, 3.0, 5.0}, {1.0, 1.0, 1.0}});
  const auto& grown = scaled.wraps[0].surface;
  EXPECT_EQ(grown.frame_from_surface.translation, Vector3d(0.02, 0.0, 1.0));
  EXPECT_EQ(grown.body_from_frame.translation, Vector3d(-0.01, 0.0, -1.0));
  EXPECT_NEAR(grown.radius, 0.02 * 2.5, 1e-16);
  EXPECT_NEAR(grown.length, 0.3 * 5.0, 1e-15);
  bar.frame_from_surface.rotation =
      math::from_body_xyz({0.0, std::numbers::pi / 2, 0.0});  // along x of the body
  const auto turned =
      scale_path(path, std::vector<Vector3d>{{2.0, 3.0, 5.0}, {1.0, 1.0, 1.0}}).wraps[0].surface;
  EXPECT_NEAR(turned.length, 0.3 * 2.0, 1e-15);
  EXPECT_NEAR(turned.radius, 0.02 * 4.0, 1e-16);
  const auto all = scale_path(path, std::vector<Vector3d>(2, Vector3d::Constant(1.5)));
  EXPECT_NEAR(length_of(all), 1.5 * length_of(path), 1e-15);
}

TEST(ScalePaths, a_path_around_cylinders_alone_leaves_nothing_out) {
  auto path = front();
  path.wraps = {
      {.surface = {.name = "bar", .is_cylinder = true, .body_idx = 0, .radius = 0.02, .length = 0.3}}};
  const std::vector<Vector3d> factors(2, Vector3d::Ones());
  EXPECT_FALSE(scale_paths(hinge(), hinge(), std::vector{path}, factors).value().front().wraps);
  path.wraps.push_back({.surface = {.name = "ball", .body_idx = 0}});
  EXPECT_TRUE(scale_paths(hinge(), hinge(), std::vector{path}, factors).value().front().wraps);
  path.wraps[1].surface.active = false;
  EXPECT_FALSE(scale_paths(hinge(), hinge(), std::vector{path}, factors).value().front().wraps);
}

TEST(ScalePaths, a_path_without_length_keeps_its_lengths_at_rest) {
  const data::MusclePath point{.name = "point", .points = {at_body(0, {0.1, 0.0, 0.0})}};
  const std::vector<Vector3d> factors(2, Vector3d::Constant(2.0));
  const auto scale = scale_paths(hinge(), hinge(), std::vector{point}, factors).value().front();
  EXPECT_EQ(scale.ratio, 1.0);
}

TEST(ScalePaths, fails_with_the_sentence_of_a_model_that_cannot_be_computed) {
  auto broken = hinge();
  broken.joints[1].child_body_idx = 0;
  const std::vector<Vector3d> factors(2, Vector3d::Ones());
  EXPECT_FALSE(scale_paths(hinge(), broken, std::vector{front()}, factors));
  EXPECT_FALSE(scale_paths(broken, hinge(), std::vector{front()}, factors));
}

}  // namespace
}  // namespace kinemark::motion
