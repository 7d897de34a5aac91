// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/internal/motion_page.h"

#include <gmock/gmock.h>

#include <numbers>

namespace kinemark::pipeline::internal {
namespace {

using ::testing::ElementsAre;

/// An upper arm that swings about z at the origin, and a forearm that is fixed to its end; a third body has
/// no mass.
model::Model arm() {
  data::ModelDescription d;
  d.name = "arm";
  d.bodies = {{.name = "upper", .mass = 2.0, .com_in_body = {0.0, -0.15, 0.0}},
              {.name = "fore", .mass = 1.0, .com_in_body = {0.0, -0.1, 0.0}},
              {.name = "nothing", .mass = 0.0, .com_in_body = {0.0, -0.1, 0.0}}};
  d.coordinates = {{.name = "swing"}};
  data::JointDescription shoulder{.name = "shoulder", .type = "PinJoint", .child_body_idx = 0};
  shoulder.axes = {{.is_rotation = true,
                    .axis = Eigen::Vector3d::UnitZ(),
                    .coordinate_idx = 0,
                    .function = math::ScalarFunction::linear(1.0, 0.0)}};
  data::JointDescription elbow{
      .name = "elbow", .type = "WeldJoint", .parent_body_idx = 0, .child_body_idx = 1};
  elbow.parent_from_joint.translation = {0.0, -0.3, 0.0};
  data::JointDescription wrist{
      .name = "wrist", .type = "WeldJoint", .parent_body_idx = 1, .child_body_idx = 2};
  wrist.parent_from_joint.translation = {0.0, -0.25, 0.0};
  d.joints = {shoulder, elbow, wrist};
  return model::Model::compile(d).value();
}

data::JointMotion two_poses() {
  data::JointMotion motion;
  motion.coordinates = {"swing"};
  motion.is_rotation = {true};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 2};
  motion.q.assign(2, 0.0);
  motion.q[1] = std::numbers::pi / 2.0;
  return motion;
}

TEST(BodyPositions, BodiesEndWhereTheNextBeginsAndTurnWithTheModel) {
  const auto bodies = body_positions(arm(), two_poses());
  EXPECT_THAT(bodies.names, ElementsAre("upper", "fore"));
  EXPECT_THAT(bodies.mass_kg, ElementsAre(2.0, 1.0));
  ASSERT_EQ(bodies.end_in_world.size(), 12U);
  const auto end = [&](std::size_t frame, std::size_t body) {
    return Eigen::Vector3d(bodies.end_in_world.data() + 6 * frame + 3 * body);
  };
  EXPECT_LT((end(0, 0) - Eigen::Vector3d(0.0, -0.3, 0.0)).norm(), 1e-12);
  EXPECT_LT((end(0, 1) - Eigen::Vector3d(0.0, -0.55, 0.0)).norm(), 1e-12);
  EXPECT_LT((end(1, 1) - Eigen::Vector3d(0.55, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((Eigen::Vector3d(bodies.origin_in_world.data() + 6 + 3) - end(1, 0)).norm(), 1e-12)
      << "the forearm begins at the elbow";
}

}  // namespace
}  // namespace kinemark::pipeline::internal
