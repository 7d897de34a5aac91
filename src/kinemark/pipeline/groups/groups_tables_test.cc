// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/groups_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/core/missing.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

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
