// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/io/file.h"
#include "kinemark/io/matlab/internal/mat_parse.h"
#include "kinemark/io/matlab/internal/struct_fields.h"
#include "kinemark/io/matlab/mat.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

data::Table sample() {
  return {.name = "walk",
          .header = {{"version", "1"}, {"note", "by hand"}},
          .columns = {"knee_angle_r", "hip_flexion_r"},
          .time_s = {0.0, 0.01, 0.02},
          .values = {1.0, 2.0, 3.0, kNaN, 5.0, -0.0}};
}

TEST(MatTable, EveryNumberIsInItsColumn) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_mat(scratch / "q.mat", sample(), true));
  const auto bytes = read_text(scratch / "q.mat").value();
  const auto file = internal::parse_mat_variables(std::as_bytes(std::span(bytes)));
  ASSERT_TRUE(file && file->variables.size() == 1) << file.error().message;
  const internal::MatPlace table{.array = &file->variables.front(), .where = "table"};
  EXPECT_EQ(table("name").text(), "walk");
  EXPECT_EQ(table("in_degrees").number().value(), 1.0);
  EXPECT_THAT(table("labels").texts().value(), ElementsAre("knee_angle_r", "hip_flexion_r"));
  EXPECT_THAT(table("header_keys").texts().value(), ElementsAre("version", "note"));
  EXPECT_THAT(table("time").numbers({3, 1}).value(), ElementsAre(0.0, 0.01, 0.02));
  const auto values = table("data").frame_first(3, 2, 1).value();
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::isnan(values[i]), i == 3) << i;
    if (i != 3) {
      EXPECT_EQ(values[i], sample().values[i]) << i;
    }
  }
  EXPECT_TRUE(std::signbit(values[5]));
}

TEST(MatTable, TheSameTableGivesTheSameBytesAndReplacesNothingUnasked) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_mat(scratch / "a.mat", sample(), false));
  ASSERT_TRUE(write_mat(scratch / "b.mat", sample(), false));
  EXPECT_EQ(read_text(scratch / "a.mat").value(), read_text(scratch / "b.mat").value());
  EXPECT_EQ(write_mat(scratch / "a.mat", sample(), true).error().code, Code::io);
  EXPECT_EQ(read_text(scratch / "a.mat").value(), read_text(scratch / "b.mat").value());
}

TEST(MatTable, AnInvalidTableIsRefusedAndATableIsNoTrial) {
  const testing_support::ScratchFolder scratch;
  auto table = sample();
  table.columns.front() = table.columns.back();
  EXPECT_EQ(write_mat(scratch / "a.mat", table, false).error().code, Code::bad_input);
  EXPECT_EQ(scratch.count_files(), 0);
  ASSERT_TRUE(write_mat(scratch / "b.mat", sample(), false));
  const auto trial = read_mat(scratch / "b.mat");
  ASSERT_FALSE(trial);
  EXPECT_EQ(trial.error().code, Code::bad_input);
  EXPECT_THAT(trial.error().message, HasSubstr("b.mat"));
}

}  // namespace
}  // namespace kinemark::io
