// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/motion_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/units.h"

namespace kinemark::pipeline {
namespace {

data::JointMotion small() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  data::JointMotion m;
  m.coordinates = {"knee", "tx"};
  m.is_rotation = {true, false};
  m.markers = {"A", "B"};
  m.time = {.rate_hz = 100.0, .t0_s = 2.0, .frames = 3};
  m.q.assign({0.5, 1.0, 0.6, 1.1, 0.7, 1.2});
  m.q_sd.assign({0.01, 0.002, nan, 0.002, 0.01, 0.002});
  m.determined.assign({1, 1, 0, 1, 1, 1});
  m.marker_error.assign(
      {0.003, 0.004, 0.0, nan, nan, nan, 0.0, 0.0, 0.001, 0.0, 0.002, 0.0, nan, nan, nan, nan, nan, nan});
  m.status.assign(
      {data::FrameStatus::converged, data::FrameStatus::underdetermined, data::FrameStatus::no_markers});
  return m;
}

TEST(MotionTables, RotationsAreDegreesAndTranslationsMetres) {
  const auto table = coordinates_table(small());
  EXPECT_TRUE(table.in_degrees);
  EXPECT_DOUBLE_EQ(table(0, 0), 0.5 * kDegPerRad);
  EXPECT_DOUBLE_EQ(table(0, 1), 1.0);
  EXPECT_DOUBLE_EQ(table.time_s[1], 2.01);
  EXPECT_TRUE(std::isnan(deviations_table(small())(1, 0))) << "undetermined stays NaN";
}

TEST(MotionTables, MarkerErrorsAreDistancesWithNanWhereNotSeen) {
  const auto table = marker_errors_table(small());
  EXPECT_THAT(table.columns, testing::ElementsAre("rms", "max", "A", "B"));
  EXPECT_NEAR(table(0, 2), 0.005, 1e-15);
  EXPECT_TRUE(std::isnan(table(0, 3)));
  EXPECT_NEAR(table(1, 0), std::sqrt((1e-6 + 4e-6) / 2), 1e-15);
  EXPECT_NEAR(table(1, 1), 0.002, 1e-15);
  EXPECT_TRUE(std::isnan(table(2, 0)));
}

TEST(MotionTables, ComeBackAsTheSameMotion) {
  const auto motion = small();
  const auto q = coordinates_table(motion), sd = deviations_table(motion),
             errors = marker_errors_table(motion);
  const auto back = motion_from_tables(q, &sd, &errors, {.all = {"knee"}}).value();
  EXPECT_TRUE(back.validate());
  EXPECT_EQ(back.time, motion.time);
  for (std::size_t i = 0; i < motion.q.size(); ++i) {
    EXPECT_NEAR(back.q[i], motion.q[i], 1e-15);
    EXPECT_EQ(back.determined[i], motion.determined[i]);
  }
  EXPECT_EQ(back.status, motion.status);
  EXPECT_EQ(back.markers, motion.markers);
}

TEST(MotionTables, ACoordinateThatKeepsRadiansIsNeverInDegrees) {
  auto motion = small();
  motion.keeps_radians = {true, false};
  const auto q = coordinates_table(motion), sd = deviations_table(motion),
             errors = marker_errors_table(motion);
  EXPECT_DOUBLE_EQ(q(0, 0), 0.5);
  EXPECT_DOUBLE_EQ(sd(0, 0), 0.01);
  const auto back = motion_from_tables(q, &sd, &errors, {.all = {"knee"}, .keeps_radians = {"knee"}}).value();
  EXPECT_EQ(back.q[0], 0.5);
  EXPECT_EQ(back.q_sd[0], 0.01);
}

TEST(MotionTables, AColumnHasTheUnitThatOpenSimGivesIt) {
  data::ModelDescription model;
  model.bodies = {{.name = "shank", .mass = 1.0}};
  model.coordinates = {{.name = "knee"}, {.name = "tx", .is_rotation = false}};
  model.joints = {{.name = "j", .type = "CustomJoint", .child_body_idx = 0}};
  model.joints[0].axes = {{.coordinate_idx = 0}, {.is_rotation = false, .coordinate_idx = 1}};
  auto table = coordinates_table(small());
  EXPECT_EQ(column_unit(table, model, 0), kRadPerDeg);
  EXPECT_EQ(column_unit(table, model, 1), 1.0);
  model.joints[0].axes[0].function = math::ScalarFunction::linear(0.5, 0.0);
  EXPECT_EQ(column_unit(table, model, 0), 1.0) << "moved by a function alone";
  model.joints[0].axes[0].function = {};
  table.in_degrees = false;
  table.degrees_stated = true;
  EXPECT_EQ(column_unit(table, model, 0), 1.0) << "the table is in radians";
}

TEST(MotionTables, RefusesTablesThatDoNotFit) {
  const auto motion = small();
  auto q = coordinates_table(motion), sd = deviations_table(motion);
  sd.columns[0] = "ankle";
  EXPECT_THAT(motion_from_tables(q, &sd, nullptr, {}).error().message, testing::HasSubstr("other columns"));
  q.time_s[1] = 2.015;
  EXPECT_THAT(motion_from_tables(q, nullptr, nullptr, {}).error().message, testing::HasSubstr("row 2"));
}

}  // namespace
}  // namespace kinemark::pipeline
