// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/around_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr analysis::AroundOptions kOptions{.from_s = -0.1, .to_s = 0.1, .bin_s = 0.1};

std::vector<analysis::AroundCurve> example_curves() {
  return {{.events = "unit 3",
           .subject = "f7",
           .id = "speed",
           .quantity = data::Quantity::speed,
           .used = 2,
           .outside = 1,
           .bins = {{.mean = 0.1234567890123, .sd = 0.01, .low = 0.1, .high = 0.15, .count = 2},
                    {.count = 0, .missing = 2}}}};
}

TEST(AroundTable, HoldsEveryBinToTheLastDigit) {
  const auto csv = around_csv(example_curves(), kOptions, {.file = "s.nwb"});
  EXPECT_THAT(csv,
              StartsWith("file,participant,session,trial,events,subject,curve,from_s,to_s,mean,sd,low,high,"
                         "level,unit,count,missing,used,outside\n"));
  EXPECT_THAT(csv,
              HasSubstr("s.nwb,,,,unit 3,f7,speed,-0.1,0,123.4567890123,10,100,150,0.95,mm/s,2,0,2,1\n"));
  EXPECT_THAT(csv, HasSubstr("unit 3,f7,speed,0,0.1,,,,,0.95,mm/s,0,2,2,1\n"));
}

TEST(AroundTable, JsonIsNullWhereNothingIsDetermined) {
  const auto json = around_json(example_curves(), kOptions);
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["unit"], "mm/s");
  EXPECT_EQ(json[0]["outside"], 1);
  EXPECT_NEAR(json[0]["bins"][0]["mean"].get<double>(), 123.4567890123, 1e-12);
  EXPECT_TRUE(json[0]["bins"][1]["mean"].is_null());
  EXPECT_EQ(json[0]["bins"][1]["missing"], 2);
}

TEST(AroundTable, NwbHasTheRowsOfTheCsv) {
  const auto table = around_nwb(example_curves(), kOptions, {.file = "s.nwb"});
  EXPECT_EQ(table.name, "around");
  for (const auto& column : table.columns)
    EXPECT_EQ(column.texts.size() + column.numbers.size(), 2U) << column.name;
}

TEST(AroundTable, TextNamesTheExtremes) {
  auto curves = example_curves();
  EXPECT_THAT(around_text(curves, kOptions), HasSubstr("Around unit 3: 2 used, 1 outside"));
  EXPECT_THAT(around_text(curves, kOptions), HasSubstr("123.5 mm/s at -0.050 s"));
  curves[0].bins = {{}, {}};
  EXPECT_THAT(around_text(curves, kOptions), HasSubstr("f7 speed                 not determined"));
}

}  // namespace
}  // namespace kinemark::pipeline
