// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/consistency/table_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::analysis {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Angles that swing by `size` to both sides; columns as named.
data::Table swinging(std::vector<std::string> columns, double size, bool in_degrees) {
  data::Table out{.name = "Coordinates",
                  .header = {},
                  .in_degrees = in_degrees,
                  .columns = std::move(columns),
                  .time_s = {},
                  .values = {},
                  .warnings = {}};
  for (int r = 0; r < 50; ++r) {
    out.time_s.push_back(0.01 * r);
    for (std::size_t c = 0; c < out.columns.size(); ++c)
      out.values.push_back(size * std::sin(0.2 * r + static_cast<double>(c)));
  }
  return out;
}

const std::vector<std::string> kJoints{"hip_flexion_r", "knee_angle_r", "ankle_angle_r", "lumbar_bending",
                                       "pelvis_tx"};

TEST(TableFacts, NothingIsSaidOfAngles) {
  EXPECT_THAT(contradicted_values(swinging(kJoints, 60.0, true), "walk.mot"), IsEmpty());
  EXPECT_THAT(contradicted_values(swinging(kJoints, 1.0, false), "walk.mot"), IsEmpty());
}

TEST(TableFacts, DegreesCalledRadians) {
  EXPECT_THAT(contradicted_values(swinging(kJoints, 60.0, false), "walk.mot"),
              ElementsAre(HasSubstr("says inDegrees=no, but 4 angles lie beyond a whole turn as radians")));
  auto silent = swinging(kJoints, 60.0, false);
  silent.degrees_stated = false;
  EXPECT_THAT(contradicted_values(silent, "walk.mot"), IsEmpty()) << "the file says nothing";
  EXPECT_THAT(contradicted_values(swinging(kJoints, 60.0, true), "walk.mot"),
              Not(Contains(HasSubstr("angles lie beyond a whole turn as radians"))));
}

TEST(TableFacts, AnAngleThatTurnsAndTurns) {
  auto table = swinging(kJoints, 30.0, true);
  for (std::int64_t r = 0; r < table.rows(); ++r)
    table.values[static_cast<std::size_t>(5 * r + 1)] += 47.0 * static_cast<double>(r);
  const auto said = contradicted_values(table, "walk.mot");
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said[0], HasSubstr("'knee_angle_r' turns by 2248 deg"));
  EXPECT_THAT(said[0], HasSubstr("no joint does, and a body only if it spins"));
  EXPECT_THAT(contradicted_values(swinging(kJoints, 350.0, true), "walk.mot"),
              Not(Contains(HasSubstr("no joint does, and a body only if it spins"))));
}

TEST(TableFacts, WhatIsNoAngleMayBeAsLargeAsItIs) {
  for (const auto& name :
       {"pelvis_tx", "ground_force_vx", "1_ground_torque_x", "soleus_activation", "knee_speed", "point_x"})
    EXPECT_THAT(contradicted_values(swinging({name}, 5000.0, true), "walk.mot"), IsEmpty()) << name;
  for (const auto& name : {"pelvis_rx", "ground_thorax_rot_x", "/jointset/knee/knee_angle/value"})
    EXPECT_EQ(contradicted_values(swinging({name}, 5000.0, true), "walk.mot").size(), 1U) << name;
}

TEST(TableFacts, DeviationsBelowZero) {
  auto table = swinging({"hip", "knee"}, 1.0, true);
  for (auto& value : table.values) value = std::abs(value);
  EXPECT_THAT(contradicted_values(table, "walk_sd.sto"), IsEmpty());
  table.values[7] = -0.1;
  EXPECT_THAT(contradicted_values(table, "walk_sd.sto"),
              ElementsAre("1 cells hold a negative standard deviation, of knee: that is none"));
  EXPECT_THAT(contradicted_values(table, "walk.mot"),
              Not(Contains(HasSubstr("cells hold a negative standard deviation"))));
  table.name = "Standard deviations of coordinates";
  EXPECT_EQ(contradicted_values(table, "renamed.sto").size(), 1U);
  table.values[7] = std::nan("");
  EXPECT_THAT(contradicted_values(table, "walk_sd.sto"), IsEmpty());
}

}  // namespace
}  // namespace kinemark::analysis
