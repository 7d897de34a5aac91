// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/groups_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

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

using ::testing::HasSubstr;

data::CycleCurves three() {
  return {.id = "c", .points = 2, .cycles = {"1", "2", "3"}, .values = {1.0, kNaN, 3.0, 4.0, 8.0, kNaN}};
}

TEST(GroupsTables, MeansOverTheCurvesThatAreThere) {
  const auto means = point_means(three());
  EXPECT_EQ(means.mean[0], 4.0);
  EXPECT_NEAR(means.sd[0], std::sqrt(13.0), 1e-12);
  EXPECT_EQ(means.mean[1], 4.0);
  EXPECT_TRUE(std::isnan(means.sd[1]));
}

TEST(GroupsTables, MeansFollowShiftAndScale) {
  auto moved = three();
  for (double& value : moved.values) value = 10.0 - 2.0 * value;
  const auto before = point_means(three()), after = point_means(moved);
  EXPECT_NEAR(after.mean[0], 10.0 - 2.0 * before.mean[0], 1e-12);
  EXPECT_NEAR(after.sd[0], 2.0 * before.sd[0], 1e-12);
}

TEST(GroupsTables, NothingThereIsNotDetermined) {
  const auto means = point_means({.id = "c", .points = 2, .cycles = {"1"}, .values = {kNaN, 1.0}});
  EXPECT_TRUE(std::isnan(means.mean[0]));
  EXPECT_EQ(means.mean[1], 1.0);
}

TEST(GroupsTables, NumbersOfJsonAreNullWhereNotDetermined) {
  const auto json = json_numbers({1.5, kNaN});
  EXPECT_EQ(json[0], 1.5);
  EXPECT_TRUE(json[1].is_null());
}

TEST(GroupsTables, TheEndingDecidesAndOthersAreRefused) {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(check_table_name({}, "bands"));
  EXPECT_TRUE(check_table_name("a.CSV", "bands"));
  EXPECT_EQ(check_table_name("a.xlsx", "bands").error().message,
            "a.xlsx: bands are written as .csv or .json");
  const nlohmann::ordered_json json{{"x", 1}};
  EXPECT_TRUE(write_table_of_groups({}, {}, {}, "a\n", json, "the bands")->empty());
  ASSERT_TRUE(write_table_of_groups(scratch / "o.csv", {}, {}, "a,b\n", json, "the bands"));
  ASSERT_TRUE(write_table_of_groups(scratch / "o.json", {}, {}, "a,b\n", json, "the bands"));
  EXPECT_EQ(io::read_text(scratch / "o.csv").value(), "a,b\n");
  EXPECT_THAT(io::read_text(scratch / "o.json").value(), HasSubstr("\"x\": 1"));
}

TEST(GroupsTables, NothingIsReplacedUnlessForcedAndNoInputEver) {
  const testing_support::ScratchFolder scratch;
  const auto write = [&](const char* text, bool force, const std::vector<std::filesystem::path>& inputs) {
    return write_table_of_groups(scratch / "o.csv", inputs, {.force = force}, text, {}, "the bands");
  };
  ASSERT_TRUE(write("first\n", false, {}));
  EXPECT_EQ(write("second\n", false, {}).error().code, Code::io);
  EXPECT_EQ(io::read_text(scratch / "o.csv").value(), "first\n");
  EXPECT_FALSE(write("third\n", true, {scratch / "o.csv"}));
  ASSERT_TRUE(write("fourth\n", true, {}));
  EXPECT_EQ(io::read_text(scratch / "o.csv").value(), "fourth\n");
}

}  // namespace

}  // namespace kinemark::pipeline
