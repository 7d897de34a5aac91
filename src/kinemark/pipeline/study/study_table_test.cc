// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/study/study_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(StudyTable, ReadsSeeds) {
  EXPECT_THAT(parse_seeds("3").value(), ElementsAre(3));
  EXPECT_THAT(parse_seeds("1-4").value(), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parse_seeds("1,7-8").value(), ElementsAre(1, 7, 8));
  for (const char* wrong : {"", "1,", "a", "4-2", "1-", "-3", "1-99999", "1 2"})
    EXPECT_EQ(parse_seeds(wrong).error().code, Code::usage) << wrong;
}

TEST(StudyTable, RowsPassWithinTheirBounds) {
  StudyRow row{.quantity = "x", .unit = "mm", .ours = 0.7, .at_least = 0.6, .at_most = 1.3};
  EXPECT_TRUE(row.pass());
  row.ours = 1.4;
  EXPECT_FALSE(row.pass());
  row.ours = 0.5;
  EXPECT_FALSE(row.pass());
  row.ours = std::nan("");
  EXPECT_FALSE(row.pass());
}

TEST(StudyTable, PassesWhenEveryRowDoes) {
  StudyTable table{.seeds = {1}, .rows = {{.quantity = "a", .ours = 1.0, .at_most = 2.0}, {.quantity = "b"}}};
  EXPECT_TRUE(table.pass());
  table.rows.push_back({.quantity = "c", .ours = 3.0, .at_most = 2.0});
  EXPECT_FALSE(table.pass());
}

TEST(StudyTable, SaysTheSameInJsonAndInWords) {
  const StudyTable table{
      .seeds = {1, 5},
      .rows = {{.quantity = "error", .unit = "mm", .paper = 30.0, .ours = 2.5, .at_most = 3.0},
               {.quantity = "share", .unit = "%", .ours = 80.0, .at_least = 90.0}}};
  const auto json = study_json(table);
  EXPECT_EQ(json["seeds"].dump(), "[1,5]");
  EXPECT_EQ(
      json["rows"][0].dump(),
      R"({"quantity":"error","unit":"mm","paper":30.0,"classic":null,"ours":2.5,"limit":null,"bound":3.0,"pass":true})");
  EXPECT_EQ(json["rows"][1]["bound"].dump(), "[90.0,null]");
  EXPECT_FALSE(json["pass"].get<bool>());
  const auto text = study_text(table);
  EXPECT_THAT(text, HasSubstr("<= 3"));
  EXPECT_THAT(text.substr(text.find("share")), HasSubstr("FAILS"));
  EXPECT_THAT(text.substr(0, text.find("share")), Not(HasSubstr("FAILS")));
}

}  // namespace
}  // namespace kinemark::pipeline
