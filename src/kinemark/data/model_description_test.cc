// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/model_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

ModelDescription two_bodies() {
  ModelDescription m;
  m.bodies = {{.name = "upper", .mass = 1.0}, {.name = "lower", .mass = 0.5}};
  m.coordinates = {{.name = "shoulder"}, {.name = "elbow"}};
  m.joints = {
      {.name = "j1", .parent_body_idx = kGround, .child_body_idx = 0, .axes = {{.coordinate_idx = 0}}},
      {.name = "j2", .parent_body_idx = 0, .child_body_idx = 1, .axes = {{.coordinate_idx = 1}}}};
  m.markers = {{.name = "M", .body_idx = 1}};
  return m;
}

std::string sentence(const ModelDescription& m) {
  const Status status = m.validate();
  return status ? "" : status.error().message;
}

TEST(ModelDescription, ASmallTreeIsValidAndFindsByName) {
  const ModelDescription m = two_bodies();
  EXPECT_EQ(sentence(m), "");
  EXPECT_EQ(m.find_body("lower"), 1);
  EXPECT_EQ(m.find_body("ground"), kGround);
  EXPECT_EQ(m.find_body("tail"), -2);
  EXPECT_EQ(m.find_coordinate("elbow"), 1);
  EXPECT_EQ(m.find_marker("N"), -1);
}

TEST(ModelDescription, ValidateNamesWhatIsWrong) {
  ModelDescription m = two_bodies();
  m.bodies[1].name = "upper";
  EXPECT_THAT(sentence(m), HasSubstr("'upper' occurs twice"));
  m = two_bodies();
  m.bodies[0].mass = -1;
  EXPECT_THAT(sentence(m), HasSubstr("mass of -1"));
  m = two_bodies();
  m.joints.pop_back();
  EXPECT_THAT(sentence(m), HasSubstr("'lower' is not connected"));
  m = two_bodies();
  m.joints[1].child_body_idx = 0;
  EXPECT_THAT(sentence(m), HasSubstr("two joints"));
  m = two_bodies();
  m.joints[0].parent_body_idx = 1;  // a circle
  EXPECT_THAT(sentence(m), HasSubstr("not connected"));
  m = two_bodies();
  m.joints[0].axes[0].axis.setZero();
  EXPECT_THAT(sentence(m), HasSubstr("length zero"));
  m = two_bodies();
  m.joints[0].axes[0].coordinate_idx = 2;
  EXPECT_THAT(sentence(m), HasSubstr("coordinate that does not exist"));
  m = two_bodies();
  m.coordinates[0].range_min = 1;
  m.coordinates[0].range_max = 0;
  EXPECT_THAT(sentence(m), HasSubstr("'shoulder' has default"));
  m = two_bodies();
  m.markers[0].x_in_body.x() = std::nan("");
  EXPECT_THAT(sentence(m), HasSubstr("marker 'M'"));
  m = two_bodies();
  m.point_constraints.push_back({.name = "loop", .body_a_idx = 7});
  EXPECT_THAT(sentence(m), HasSubstr("'loop'"));
}

TEST(ModelDescription, RefusesCouplingsInACircle) {
  ModelDescription m = two_bodies();
  m.couplings = {{.name = "c", .dependent_idx = 1, .independent_idx = 0}};
  EXPECT_EQ(sentence(m), "");
  m.couplings.push_back({.name = "d", .dependent_idx = 0, .independent_idx = 1});
  EXPECT_THAT(sentence(m), HasSubstr("form a circle"));
  m.couplings[1] = {.name = "d", .dependent_idx = 1, .independent_idx = 0};
  EXPECT_THAT(sentence(m), HasSubstr("two couplings"));
}

}  // namespace
}  // namespace kinemark::data
