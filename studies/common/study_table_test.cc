// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>

namespace kinemark::studies {
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
      R"({"quantity":"error","unit":"mm","paper":30.0,"classic":null,"ours":2.5,"expected":null,"expected_is":null,"bound":3.0,"pass":true})");
  EXPECT_EQ(json["rows"][1]["bound"].dump(), "[90.0,null]");
  EXPECT_FALSE(json["pass"].get<bool>());
  const auto text = study_text(table);
  EXPECT_THAT(text, HasSubstr("<= 3"));
  EXPECT_THAT(text.substr(text.find("share")), HasSubstr("FAILS"));
  EXPECT_THAT(text, Not(HasSubstr("figure")));
  EXPECT_THAT(text.substr(0, text.find("share")), Not(HasSubstr("FAILS")));
}

TEST(StudyTable, ColumnsAreAsWideAsTheirWidestCell) {
  const std::string long_name(90, 'q');
  const StudyTable table{
      .seeds = {1},
      .rows = {{.quantity = long_name, .unit = "1", .ours = 1.0},
               {.quantity = "b", .unit = "mm", .ours = 123456.0, .at_least = 0.5, .at_most = 2.0}}};
  std::istringstream text(study_text(table));
  std::string head, first, second, legend;
  std::getline(text, head);
  std::getline(text, first);
  std::getline(text, second);
  std::getline(text, legend);
  EXPECT_EQ(head.size(), first.size());
  EXPECT_EQ(second.size(), head.size() + std::string("  FAILS").size());
  const auto end_of = [](const std::string& line, const char* word) {
    return line.find(word) + std::string(word).size();
  };
  EXPECT_EQ(end_of(head, "ours"), end_of(second, "1.235e+05"));
  EXPECT_EQ(end_of(head, "bound"), end_of(second, "0.5 to 2"));
  EXPECT_EQ(end_of(head, "bound"), end_of(first, "figure"));
  EXPECT_EQ(first.find(" 1 ", long_name.size()), first.find_last_of('1') - 1);  // the value, not the unit
  EXPECT_THAT(legend, HasSubstr("asked of ours"));
}

TEST(StudyTable, BoundsAreAskedOfOursAlone) {
  StudyRow row{.quantity = "x", .paper = 9.0, .classic = 9.0, .ours = 2.0, .expected = 9.0, .at_most = 2.0};
  EXPECT_TRUE(row.pass());  // a bound that is met exactly is met
  row.at_most.reset();
  row.at_least = 2.0;
  EXPECT_TRUE(row.pass());
  row.ours = std::nan("");
  row.at_least.reset();
  EXPECT_TRUE(row.pass());  // no bound
}

TEST(StudyTable, WithoutABoundNothingPasses) {
  const StudyTable table{.seeds = {1}, .rows = {{.quantity = "a", .ours = 1.0}}};
  const auto json = study_json(table);
  EXPECT_TRUE(json["rows"][0]["pass"].is_null());
  EXPECT_TRUE(json["rows"][0]["bound"].is_null());
  EXPECT_TRUE(json["pass"].is_null());
  EXPECT_TRUE(table.pass()) << "no bound is missed either: exit status 0";
  EXPECT_THAT(study_text(table), HasSubstr("  figure\n"));
  EXPECT_THAT(study_text(table), HasSubstr("figure: a number of which nothing is asked"));
}

TEST(StudyTable, CountsTheBoundsThatAreMissedByName) {
  const StudyRow kept{.quantity = "a", .ours = 1.0, .at_most = 2.0}, free{.quantity = "b", .ours = 9.0},
      missed{.quantity = "c", .ours = 3.0, .at_most = 2.0},
      none{.quantity = "d", .ours = std::nan(""), .at_least = 0.0};
  EXPECT_EQ(missed_text({.seeds = {1}, .rows = {free}}), "");
  EXPECT_EQ(missed_text({.seeds = {1}, .rows = {kept, free}}),
            "None of 1 bounds is missed. 1 more row has no bound.");
  EXPECT_EQ(missed_text({.seeds = {1}, .rows = {kept, free, free, missed}}),
            "1 of 2 bounds is missed: c. 2 more rows have no bound.");
  EXPECT_EQ(missed_text({.seeds = {1}, .rows = {kept, missed, none}}), "2 of 3 bounds are missed: c; d.");
  EXPECT_THAT(study_text({.seeds = {1}, .rows = {kept, missed}}), testing::EndsWith("missed: c.\n"));
}

TEST(StudyTable, SaysWhatIsExpectedAndNothingOfWhatItDoesNotHold) {
  const StudyRow bound{
      .quantity = "a", .ours = 1.2, .expected = 1.0, .expected_is = Expectation::cramer_rao, .at_most = 2.0};
  const StudyRow predicted{
      .quantity = "b", .ours = 1.2, .expected = 1.5, .expected_is = Expectation::predicted_sd};
  const StudyRow alone{
      .quantity = "c", .ours = 0.5, .expected = 1.0, .expected_is = Expectation::frame_alone};
  const StudyRow share{.quantity = "d", .ours = 68.0, .expected = 68.3};
  constexpr const char* kBound = "least standard deviation of an unbiased estimate";
  constexpr const char* kPredicted = "standard deviation that ours states";
  for (const auto& [row, word, other] :
       {std::tuple{bound, kBound, kPredicted}, std::tuple{predicted, kPredicted, kBound},
        std::tuple{alone, "may lie", kPredicted}, std::tuple{share, "that are right", kBound}}) {
    const StudyTable table{.seeds = {1}, .rows = {row}};
    EXPECT_THAT(study_text(table), HasSubstr(word)) << row.quantity;
    EXPECT_THAT(study_text(table), Not(HasSubstr(other))) << row.quantity;
    EXPECT_EQ(study_json(table)["rows"][0]["expected_is"], to_string(row.expected_is));
  }
  EXPECT_THAT(study_text({.seeds = {1}, .rows = {{.quantity = "e", .ours = 1.0}}}),
              Not(HasSubstr("expected:")));
  EXPECT_EQ(expected_text(bound), "1 CR");
  EXPECT_EQ(expected_text(predicted), "1.5 SD");
  EXPECT_EQ(expected_text(share), "68.3");
}

TEST(StudyTable, SeedsAreBoundedAndKeepTheirOrder) {
  EXPECT_THAT(parse_seeds("7,1-2,7").value(), ElementsAre(7, 1, 2, 7));
  EXPECT_EQ(parse_seeds("1-1000").value().size(), 1000U);
  EXPECT_EQ(parse_seeds("1-1001").error().code, Code::usage);
  EXPECT_EQ(parse_seeds("1-600,1-600").error().code, Code::usage);
  EXPECT_THAT(parse_seeds("18446744073709551615").value(), ElementsAre(18446744073709551615U));
  EXPECT_EQ(parse_seeds("18446744073709551614-18446744073709551615").value().size(), 2U);
  EXPECT_FALSE(parse_seeds("18446744073709551616"));
}

}  // namespace
}  // namespace kinemark::studies
