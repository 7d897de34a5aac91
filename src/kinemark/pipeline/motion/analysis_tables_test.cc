// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/analysis_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/units.h"

namespace kinemark::pipeline {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

/// Two bodies, one point, three frames; each number tells where it stands: 100 frame + 30 order + column.
motion::BodyMotion numbered() {
  motion::BodyMotion m{.time = {.rate_hz = 10.0, .t0_s = 1.0, .frames = 3}, .bodies = 2, .points = 1};
  for (int f = 0; f < 3; ++f)
    for (int order = 0; order < 3; ++order)
      for (int k = 0; k < m.columns(); ++k) m.value.push_back(100.0 * f + 30.0 * order + k);
  return m;
}

data::ModelDescription two_bodies() {
  data::ModelDescription model;
  model.bodies = {{.name = "thigh"}, {.name = "shank"}};
  return model;
}

TEST(AnalysisTables, BodiesHaveOpenSimsLabelsAndDegrees) {
  const auto m = numbered();
  const auto table = bodies_table(two_bodies(), m, m.value, {1, 0}, true, 1, true, {1, 3});
  EXPECT_EQ(table.name, "Velocities");
  EXPECT_TRUE(table.in_degrees);
  EXPECT_THAT(table.time_s, ElementsAre(DoubleEq(1.1), DoubleEq(1.2)));
  EXPECT_THAT(table.columns, ElementsAre("shank_X", "shank_Y", "shank_Z", "shank_Ox", "shank_Oy", "shank_Oz",
                                         "thigh_X", "thigh_Y", "thigh_Z", "thigh_Ox", "thigh_Oy", "thigh_Oz",
                                         "center_of_mass_X", "center_of_mass_Y", "center_of_mass_Z"));
  EXPECT_EQ(table(0, 0), 130.0);
  EXPECT_DOUBLE_EQ(table(0, 3), 133.0 * kDegPerRad);
  EXPECT_DOUBLE_EQ(table(1, 11), 241.0 * kDegPerRad);
  EXPECT_EQ(table(1, 12), 242.0) << "the mass centre is no angle";
  ASSERT_TRUE(table.validate());
}

TEST(AnalysisTables, BodiesInRadiansWithoutTheMassCentre) {
  const auto m = numbered();
  const auto table = bodies_table(two_bodies(), m, m.value, {0, 1}, false, 0, false, {0, 1});
  EXPECT_EQ(table.columns.size(), 12U);
  EXPECT_FALSE(table.in_degrees);
  EXPECT_EQ(table(0, 3), 3.0);
}

TEST(AnalysisTables, APointIsTheColumnsBehindTheMassCentre) {
  const auto m = numbered();
  const auto table = point_table(m, m.value, 0, 2, {2, 3});
  EXPECT_EQ(table.name, "PointAcceleration");
  EXPECT_THAT(table.columns, ElementsAre("state_0", "state_1", "state_2"));
  EXPECT_THAT(table.values, ElementsAre(275.0, 276.0, 277.0));
}

TEST(AnalysisTables, CoordinatesInTheirUnits) {
  data::JointMotion motion;
  motion.coordinates = {"hip", "tx", "patella"};
  motion.is_rotation = {true, false, true};
  motion.keeps_radians = {false, false, true};
  motion.time = {.rate_hz = 10.0, .frames = 2};
  const Array<double> values{1, 2, 3, 4, 5, 6};
  const auto degrees = coordinate_rates_table("Speeds", motion, values, {2, 0, 1}, true, {1, 2});
  EXPECT_THAT(degrees.columns, ElementsAre("patella", "hip", "tx"));
  EXPECT_THAT(degrees.values, ElementsAre(6.0, DoubleEq(4.0 * kDegPerRad), 5.0));
  const auto radians = coordinate_rates_table("Speeds", motion, values, {0}, false, {0, 2});
  EXPECT_THAT(radians.values, ElementsAre(1.0, 4.0));
  EXPECT_FALSE(radians.in_degrees);
}

TEST(AnalysisTables, SomeRowsOfATable) {
  data::Table table{.columns = {"a", "b"}};
  table.time_s = {0, 1, 2};
  table.values = {1, 2, 3, 4, 5, 6};
  const auto some = rows_of(table, {1, 3});
  EXPECT_THAT(some.time_s, ElementsAre(1.0, 2.0));
  EXPECT_THAT(some.values, ElementsAre(3.0, 4.0, 5.0, 6.0));
  EXPECT_EQ(rows_of(table, {1, 1}).rows(), 0);
}

}  // namespace
}  // namespace kinemark::pipeline
