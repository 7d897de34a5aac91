// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/tidy_rows.h"

#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

io::TidyTable measures() {
  return io::parse_tidy_csv(
             "measure,subject,value,unit\npeak_speed,RHEE,1200,mm/s\npeak_speed,LHEE,1300,mm/"
             "s\npath,RHEE,900,mm\n",
             "m.csv")
      .value();
}

TEST(TidyRows, ColumnsByNameOrTheNearestNames) {
  const auto table = measures();
  EXPECT_EQ(*column_of(table, "value", "--value"), 2);
  const auto wrong = column_of(table, "valeu", "--value");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(
      wrong.error().message,
      "m.csv: no column 'valeu' (--value); did you mean 'value'?; there are measure, subject, value, unit");
  const std::vector<std::string> two{"subject", "unit"};
  EXPECT_EQ(*columns_of(table, two, "--by"), (std::vector<std::int64_t>{1, 3}));
  const auto plain = io::parse_tidy_csv("1,2\n", "y.csv").value();
  EXPECT_EQ(column_of(plain, "value", "--value").error().message,
            "y.csv: --value names column 'value', but the first line holds numbers, not names");
}

TEST(TidyRows, ConditionsChooseRows) {
  const auto table = measures();
  EXPECT_EQ(rows_where(table, {})->size(), 3u);
  const std::vector<std::string> both{"measure=peak_speed", "subject=LHEE"};
  EXPECT_EQ(*rows_where(table, both), (std::vector<std::int64_t>{1}));
  const std::vector<std::string> none{"measure=peak"};
  const auto empty = rows_where(table, none);
  EXPECT_EQ(empty.error().code, Code::bad_input);
  EXPECT_EQ(empty.error().message,
            "m.csv: no row is left where measure is 'peak'; there are peak_speed, path");
  const std::vector<std::string> wrong{"measure"};
  EXPECT_EQ(rows_where(table, wrong).error().code, Code::usage);
}

TEST(TidyRows, CellsAreJoinedAndUnitsMustAgree) {
  const auto table = measures();
  const std::vector<std::int64_t> columns{0, 1}, same{0, 1}, mixed{0, 2};
  EXPECT_EQ(joined_cells(table, 1, columns), "peak_speed LHEE");
  EXPECT_EQ(*unit_of(table, same), "mm/s");
  const auto units = unit_of(table, mixed);
  ASSERT_FALSE(units);
  EXPECT_EQ(units.error().message,
            "m.csv: line 2 is in 'mm/s', line 4 in 'mm'; choose one quantity with --where, such as --where "
            "measure=NAME");
}

}  // namespace
}  // namespace kinemark::pipeline
