// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/table_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> notes_on(const std::vector<double>& column) {
  data::Table table;
  table.columns = {"knee", "steady"};
  std::vector<std::int64_t> lines;
  for (std::size_t r = 0; r < column.size(); ++r) {
    table.time_s.push_back(0.01 * static_cast<double>(r));
    table.values.push_back(column[r]);
    table.values.push_back(1.0);
    lines.push_back(static_cast<std::int64_t>(r) + 8);
  }
  std::vector<std::string> warnings;
  note_absurd_values(table, lines, warnings);
  return warnings;
}

std::vector<double> swing(double amplitude, int rows = 100) {
  std::vector<double> out;
  for (int r = 0; r < rows; ++r) out.push_back(amplitude * std::sin(0.1 * r));
  return out;
}

TEST(TableValues, OneValueFarFromAll) {
  for (const double wrong : {1e30, -6e8, 3e4, std::numeric_limits<double>::infinity()})
    for (const std::size_t row : {0U, 50U, 99U}) {
      auto column = swing(60.0);
      column[row] = wrong;
      const auto notes = notes_on(column);
      ASSERT_EQ(notes.size(), 1U) << wrong << " in row " << row;
      EXPECT_THAT(notes[0], HasSubstr("1 value is far"));
      EXPECT_THAT(notes[0], HasSubstr("'knee' in line " + std::to_string(row + 8)));
    }
}

TEST(TableValues, ManyAreCountedAndFourNamed) {
  auto column = swing(60.0);
  for (const std::size_t row : {5U, 15U, 25U, 35U, 45U, 55U}) column[row] = 1e20;
  EXPECT_THAT(notes_on(column),
              ElementsAre(testing::AllOf(HasSubstr("6 values are far"), HasSubstr("and 2 more"))));
}

TEST(TableValues, WhatIsLargeButGoesOnIsGood) {
  EXPECT_THAT(notes_on(swing(60.0)), IsEmpty());
  EXPECT_THAT(notes_on(swing(1e6)), IsEmpty()) << "moments in Nmm";
  auto plate = swing(0.0);
  for (std::size_t r = 40; r < 60; ++r) plate[r] = 9000.0;
  EXPECT_THAT(notes_on(plate), IsEmpty()) << "a force that sets in at once";
  auto blank = swing(60.0);
  blank[3] = blank[4] = std::nan("");
  EXPECT_THAT(notes_on(blank), IsEmpty());
  EXPECT_THAT(notes_on({}), IsEmpty());
  EXPECT_THAT(notes_on({5.0}), IsEmpty());
}

TEST(TableValues, BeyondAllIsSaidOfEveryRow) {
  EXPECT_THAT(notes_on(std::vector<double>(10, 1e30)), ElementsAre(HasSubstr("10 values")));
}

}  // namespace
}  // namespace kinemark::io::internal
