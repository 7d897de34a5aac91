// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/emg_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/workflow/measures/testing/muscles.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using workflow::testing::muscles;

TEST(EmgRequest, EnvelopesAreWrittenAtTheFrames) {
  const auto trial = muscles();
  const auto choice = emg_choice({.maximum = "trial"}).value();
  const auto out = workflow::measure_channels(trial, choice, {}, {.refits = 0}).value();
  const auto table = envelope_table(trial, out, true);
  EXPECT_TRUE(table.validate());
  EXPECT_EQ(table.rows(), 200);
  EXPECT_THAT(table.columns, ElementsAre("LSOL", "RSOL"));
  EXPECT_DOUBLE_EQ(table.time_s[0], 1.0);
  double most = 0.0;
  for (const double v : table.values) most = std::max(most, v);
  EXPECT_NEAR(most, 100.0, 1.0);
  const auto csv = envelope_csv(table);
  EXPECT_THAT(csv, ::testing::StartsWith("time_s,LSOL,RSOL\n1.000000,"));
  const std::vector<analysis::GaitCycle> cycles{{.side = data::Side::left, .start_s = 1.2, .end_s = 2.2},
                                                {.side = data::Side::right, .start_s = 1.5, .end_s = 2.5}};
  const auto curves = envelope_cycles(trial, out, cycles, true);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].id, "LSOL");
  EXPECT_EQ(curves[0].context, "Left");
  EXPECT_EQ(curves[1].context, "Right");
  EXPECT_EQ(curves[0].points, 101);
}

TEST(EmgRequest, RefusesInOneSentence) {
  EXPECT_TRUE(EmgRequest{}.check());
  EXPECT_FALSE(EmgRequest{}.wanted());
  EXPECT_THAT((EmgRequest{.write = "a.txt"}.check().error().message), HasSubstr("written as .sto or .csv"));
  EXPECT_THAT((EmgRequest{.write_cycles = "a.sto"}.check().error().message), HasSubstr("written as .csv"));
  EXPECT_EQ(emg_choice({.maximum = "/nowhere.c3d"}).error().code, Code::io);
  EXPECT_FALSE(emg_choice({}).value().to_maximum);
}

}  // namespace
}  // namespace kinemark::pipeline
