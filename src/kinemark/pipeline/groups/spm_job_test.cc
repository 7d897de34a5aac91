// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/spm_job.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SpmJobTest : public ::testing::Test {
 protected:
  // Ten curves of 21 points: slow waves with noise, higher by `bump` around the middle; of the last one point
  // may be missing.
  std::filesystem::path write(const std::string& name, std::uint64_t seed, double bump, int missing = -1) {
    Random random(seed, 0);
    std::string text;
    for (int curve = 0; curve < 10; ++curve) {
      const double height = random.gaussian();
      for (int p = 0; p < 21; ++p) {
        const double value = height * std::cos(0.3 * p) + 0.3 * random.gaussian() +
                             bump * std::exp(-0.5 * (p - 10.0) * (p - 10.0) / 4.0);
        text += p > 0 ? "," : "";
        text += curve == 9 && p == missing ? "nan" : fmt::format("{:.6f}", value);
      }
      text += "\n";
    }
    EXPECT_TRUE(io::write_text(scratch_ / name, text, true));
    return scratch_ / name;
  }

  testing_support::ScratchFolder scratch_;
};

TEST_F(SpmJobTest, ADifferenceIsSaidWhereItIs) {
  SpmJob job{.inputs = {write("up.csv", 1, 2.5), write("flat.csv", 2, 0.0)}, .output = scratch_ / "spm.csv"};
  const auto outcome = run_spm(job);
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->mapping.spans.size(), 1u);
  const auto text = spm_text(*outcome);
  EXPECT_THAT(text, HasSubstr("Two samples: up (10 curves), flat (10 curves); 21 points\n"));
  EXPECT_THAT(text, HasSubstr("t(18) beyond +-"));
  EXPECT_THAT(text, HasSubstr("(10000 of 184756 arrangements, seed 1)"));
  EXPECT_THAT(text, ::testing::ContainsRegex("  point [5-8].* to 1[1-4].*: t up to [4-9].*, p = 0.0"));
  EXPECT_THAT(text, HasSubstr("anywhere with probability 0.05 at most if the groups do not differ ("));
  EXPECT_THAT(text, Not(HasSubstr("is found: largest")));
  EXPECT_THAT(text, Not(HasSubstr("Nothing can be found:")));
  EXPECT_THAT(text, Not(HasSubstr("the mean is 0 everywhere")));
  EXPECT_THAT(text, Not(HasSubstr("points are not tested: a curve is missing")));
  const auto csv = io::read_text(job.output).value();
  EXPECT_THAT(csv, ::testing::StartsWith("point,mean up,sd up,mean flat,sd flat,t,threshold,beyond\n0,"));
  EXPECT_THAT(csv, ::testing::ContainsRegex("\n10,.*,yes\n"));
  EXPECT_THAT(csv, ::testing::ContainsRegex("\n0,.*,no\n"));
}

TEST_F(SpmJobTest, NoDifferenceIsSaidWhereThereIsNone) {
  const auto outcome = run_spm({.inputs = {write("a.csv", 3, 0.0), write("b.csv", 4, 0.0)}});
  ASSERT_TRUE(outcome);
  EXPECT_THAT(spm_text(*outcome), HasSubstr("No difference is found: largest t "));
  EXPECT_THAT(spm_text(*outcome), HasSubstr("at most if the groups do not differ ("));
  EXPECT_EQ(outcome->exit_status(), 0);
}

TEST_F(SpmJobTest, OneGroupIsComparedWithZeroAndSaysSo) {
  const auto outcome = run_spm({.inputs = {write("a.csv", 3, 0.0)}});
  ASSERT_TRUE(outcome);
  EXPECT_THAT(spm_text(*outcome), HasSubstr("at most if the mean is 0 everywhere ("));
  EXPECT_THAT(spm_text(*outcome), HasSubstr("No difference from 0 is found: largest t "));
  EXPECT_THAT(spm_text(*outcome), Not(HasSubstr("the groups do not differ")));
}

TEST_F(SpmJobTest, TooFewCurvesCanShowNothingAndThatAloneIsSaid) {
  ASSERT_TRUE(io::write_text(scratch_ / "a.csv", "1,2,3\n2,4,5\n", false));
  ASSERT_TRUE(io::write_text(scratch_ / "b.csv", "9,8,7\n8,6,9\n", false));
  const auto outcome = run_spm({.inputs = {scratch_ / "a.csv", scratch_ / "b.csv"}});
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto text = spm_text(*outcome);
  EXPECT_THAT(text, HasSubstr("Nothing can be found: 6 arrangements of so few curves cannot show"));
  EXPECT_THAT(text, Not(HasSubstr("anywhere with probability")));
  EXPECT_THAT(text, Not(HasSubstr("is found: largest")));
}

TEST_F(SpmJobTest, PointsWhereACurveIsMissingAreNotTested) {
  const auto outcome = run_spm({.inputs = {write("a.csv", 3, 0.0, 20), write("b.csv", 4, 0.0)}});
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(spm_text(*outcome),
              HasSubstr("1 points are not tested: a curve is missing there, or all are equal\n"));
}

TEST_F(SpmJobTest, DesignsFollowFromTheGroups) {
  const auto a = write("a.csv", 5, 0.0), b = write("b.csv", 6, 0.0), c = write("c.csv", 7, 0.0);
  EXPECT_EQ(run_spm({.inputs = {a}})->mapping.options.design, analysis::Design::one_sample);
  EXPECT_EQ(run_spm({.inputs = {a, b}})->mapping.options.design, analysis::Design::two_sample);
  EXPECT_EQ(run_spm({.inputs = {a, b}, .paired = true})->mapping.error_df, 9);
  const auto one_way = run_spm({.inputs = {a, b, c}, .arrangements = 200});
  EXPECT_EQ(one_way->mapping.statistic, "F");
  EXPECT_THAT(spm_text(*one_way), HasSubstr("F(2, 27) beyond "));
  EXPECT_EQ(run_spm({.inputs = {a, b, c}, .paired = true}).error().code, Code::bad_input);
  EXPECT_EQ(run_spm({.inputs = {a, b, c}, .one_sided = true}).error().code, Code::usage);
}

TEST_F(SpmJobTest, JsonHoldsAllAndSpansAreInPercent) {
  std::string text = "group,cycle,percent,value\n";
  for (const std::string group : {"x", "y"})
    for (int cycle = 0; cycle < 6; ++cycle)
      for (int p = 0; p <= 4; ++p)
        text += fmt::format("{},{},{},{}\n", group, cycle, 25 * p,
                            (p == 2 && group == "x" ? 9.0 : 0.0) + 0.1 * ((7 * cycle + 3 * p) % 5));
  ASSERT_TRUE(io::write_text(scratch_ / "t.csv", text, false));
  const auto outcome =
      run_spm({.inputs = {scratch_ / "t.csv"}, .columns = {.group = "group"}, .output = scratch_ / "o.json"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto json = nlohmann::json::parse(io::read_text(scratch_ / "o.json").value());
  ASSERT_EQ(json["spans"].size(), 1u);
  EXPECT_GT(json["spans"][0]["first"], 25.0);
  EXPECT_LT(json["spans"][0]["last"], 75.0);
  EXPECT_EQ(json["at"], (nlohmann::json{0.0, 25.0, 50.0, 75.0, 100.0}));
  EXPECT_EQ(json["at_name"], "percent");
  EXPECT_EQ(json["groups"][0]["name"], "x");
  EXPECT_EQ(json["possible_arrangements"], 924.0);
}

TEST_F(SpmJobTest, BadOptionsAndTooFewCurvesAreRefused) {
  const auto a = write("a.csv", 8, 0.0);
  EXPECT_EQ(run_spm({.inputs = {a}, .alpha = 1.5}).error().code, Code::usage);
  EXPECT_EQ(run_spm({.inputs = {a}, .output = scratch_ / "o.txt"}).error().code, Code::usage);
  ASSERT_TRUE(io::write_text(scratch_ / "one.csv", "1,2,3\n", false));
  EXPECT_EQ(run_spm({.inputs = {a, scratch_ / "one.csv"}}).error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::pipeline
