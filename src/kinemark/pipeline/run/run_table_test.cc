// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

RunOutcome outcome() {
  RunOutcome out;
  out.steps.push_back(
      {.step = {.subject = "S01", .name = "scale", .words = {"scale", "--mass=70"}, .outputs = {"m.osim"}},
       .status = TrialStatus::good,
       .seconds = 2.04});
  out.steps.push_back(
      {.step = {.subject = "S01", .trial = "walk 1", .name = "ik", .words = {"ik", "--markers=walk 1.c3d"}},
       .status = TrialStatus::failed,
       .said = "it's\nbroken",
       .exit_status = 3});
  return out;
}

TEST(RunTable, HasALineForEachStepAndTheTotals) {
  const std::string text = run_table(outcome());
  EXPECT_THAT(text, HasSubstr("S01                 scale  good    2.0  \n"));
  EXPECT_THAT(text, HasSubstr("S01      walk 1     ik     failed       it's"));
  EXPECT_THAT(text, HasSubstr("2 steps: 1 good, 1 failed\n"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 4) << "a line end in a sentence makes no line";
}

TEST(RunTable, JsonHoldsTheSame) {
  const auto json = run_json(outcome());
  EXPECT_EQ(json["exit_status"], 3);
  ASSERT_EQ(json["steps"].size(), 2U);
  EXPECT_TRUE(json["steps"][0]["trial"].is_null());
  EXPECT_EQ(json["steps"][0]["outputs"][0], "m.osim");
  EXPECT_EQ(json["steps"][1]["trial"], "walk 1");
  EXPECT_EQ(json["steps"][1]["status"], "failed");
}

TEST(RunTable, CommandsCanBeTypedInAShell) {
  RunOutcome out = outcome();
  out.steps[0].step.words.push_back("it's");
  EXPECT_EQ(commands_text(out), "kinemark scale --mass=70 'it'\\''s'\nkinemark ik '--markers=walk 1.c3d'\n");
}

}  // namespace
}  // namespace kinemark::pipeline
