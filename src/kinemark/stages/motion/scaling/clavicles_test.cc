// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/clavicles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A torso with two arms, hung on it directly or by welded clavicles; a marker at each shoulder.
data::ModelDescription torso(bool clavicles) {
  data::ModelDescription model;
  model.name = "torso";
  model.bodies = {{.name = "torso", .mass = 30.0}};
  model.joints = {{.name = "ground", .type = "WeldJoint", .child_body_idx = 0}};
  for (const std::string side : {"_r", "_l"}) {
    const double z = side == "_r" ? 1.0 : -1.0;
    int parent = 0;
    Vector3d shoulder(0.0, 0.4, 0.17 * z);
    if (clavicles) {
      parent = static_cast<int>(model.bodies.size());
      model.bodies.push_back({.name = "clavicle" + side, .mass = 0.5});
      model.joints.push_back({.name = "sc" + side, .type = "WeldJoint", .child_body_idx = parent});
      model.joints.back().parent_body_idx = 0;
      model.joints.back().parent_from_joint.translation = Vector3d(0.02, 0.4, 0.03 * z);
      shoulder -= model.joints.back().parent_from_joint.translation;
    }
    const int arm = static_cast<int>(model.bodies.size());
    model.bodies.push_back({.name = "humerus" + side, .mass = 2.0});
    model.joints.push_back({.name = "shoulder" + side, .parent_body_idx = parent, .child_body_idx = arm});
    model.joints.back().parent_from_joint.translation = shoulder;
    model.joints.back().axes = {{.coordinate_idx = static_cast<int>(model.coordinates.size())}};
    model.coordinates.push_back({.name = "arm" + side});
    model.markers.push_back({.name = "SHO" + side, .body_idx = arm});
  }
  return model;
}

/// Marker positions with one coordinate set.
Eigen::Matrix3Xd positions(const data::ModelDescription& description, const std::string& coordinate,
                           double value) {
  const auto model = model::Model::compile(description).value();
  model::Workspace w(model);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.coordinate_count());
  if (const int c = description.find_coordinate(coordinate); c >= 0) q[c] = value;
  model::kinematics(model, w, model::state_from_coordinates(model, q));
  return w.marker;
}

class Clavicles : public ::testing::TestWithParam<bool> {};

TEST_P(Clavicles, leave_the_shoulder_in_place_and_move_it_the_way_they_say) {
  auto model = torso(GetParam());
  const auto before = positions(model, "", 0.0);
  const auto added = add_clavicles(model);
  ASSERT_TRUE(added) << added.error().message;
  EXPECT_THAT(*added, ElementsAre("clavicle_r", "clavicle_l"));
  EXPECT_LT((positions(model, "", 0.0) - before).norm(), 1e-12);
  for (int side = 0; side < 2; ++side) {
    const std::string suffix = side == 0 ? "_r" : "_l";
    const Vector3d forward = positions(model, "clav_protraction" + suffix, 0.1).col(side) - before.col(side);
    EXPECT_GT(forward.x(), 0.01) << suffix;
    EXPECT_NEAR(forward.y(), 0.0, 1e-12);
    const Vector3d up = positions(model, "clav_elevation" + suffix, 0.1).col(side) - before.col(side);
    EXPECT_GT(up.y(), 0.01) << suffix;
    EXPECT_NEAR(up.x(), 0.0, 1e-12);
  }
}

TEST_P(Clavicles, keep_the_mass) {
  auto model = torso(GetParam());
  const auto mass = [](const data::ModelDescription& m) {
    double sum = 0.0;
    for (const auto& body : m.bodies) sum += body.mass;
    return sum;
  };
  const double before = mass(model);
  ASSERT_TRUE(add_clavicles(model));
  EXPECT_NEAR(mass(model), before, 1e-12);
  EXPECT_TRUE(model.validate());
}

TEST_P(Clavicles, are_set_free_once) {
  auto model = torso(GetParam());
  ASSERT_TRUE(add_clavicles(model));
  const auto coordinates = model.coordinates.size();
  const auto again = add_clavicles(model);
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("move already"));
  EXPECT_EQ(model.coordinates.size(), coordinates);
}

INSTANTIATE_TEST_SUITE_P(WeldedOrAbsent, Clavicles, ::testing::Bool());

TEST(NoClavicles, without_arms) {
  data::ModelDescription model;
  model.name = "snake";
  EXPECT_THAT(add_clavicles(model).error().message, HasSubstr("model 'snake' has no humerus_r"));
}

}  // namespace
}  // namespace kinemark::motion
