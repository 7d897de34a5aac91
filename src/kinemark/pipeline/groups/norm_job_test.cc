// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/norm_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class NormJobTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(io::write_text(scratch_ / name, text, true));
    return scratch_ / name;
  }
  std::string sentence(const std::string& norm) {
    const auto read = read_norm(write("n.csv", norm), "percent", {});
    return read ? "" : read.error().message;
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path norm_ =
      write("norm.csv", "percent,mean,sd,unit\n0,10,1,deg\n50,20,2,deg\n100,10,1,deg\n");
  std::filesystem::path curves_ =
      write("curves.csv",
            "cycle,percent,value,unit\n1,0,10,deg\n1,25,15,deg\n1,50,20,deg\n1,100,11.5,deg\n"
            "2,0,7.5,deg\n2,25,19,deg\n2,50,25,deg\n2,100,10,deg\n");
};

TEST_F(NormJobTest, WhatIsWithinAndWhatIsOutsideIsSaid) {
  const auto outcome = run_norm({.norm = norm_, .inputs = {curves_}, .output = scratch_ / "o.csv"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->curves.size(), 2u);
  EXPECT_EQ(outcome->curves[0].outside, 0);
  EXPECT_EQ(outcome->curves[1].outside, 3);  // 7.5 below 8; 19 above 15 + 3; 25 above 24
  EXPECT_EQ(outcome->curves[1].largest, 1.0);
  EXPECT_EQ(outcome->curves[1].spans.size(), 1u);
  const auto text = norm_text(*outcome);
  EXPECT_THAT(text, HasSubstr("Beside the norm (mean +- 2 SD at each point):\n"));
  EXPECT_THAT(text, HasSubstr("curves 1: within at all of 4 points\n"));
  EXPECT_THAT(text, HasSubstr("curves 2: outside at 3 of 4 points (0 to 50), at most 1 deg above at 25\n"));
  EXPECT_THAT(text, Not(HasSubstr("curves 2: within at all of")));
  EXPECT_THAT(text, Not(HasSubstr("curves 1: outside at")));
  EXPECT_THAT(io::read_text(scratch_ / "o.csv").value(), HasSubstr("curves,2,4,3,0.75,1,25,0 to 50,deg\n"));
  EXPECT_EQ(norm_json(*outcome)["curves"][0]["largest"], nullptr);
}

TEST_F(NormJobTest, TheMeaningIsThatOfTheColumnsThatMadeTheBand) {
  const auto meaning = [&](const std::string& columns, const std::string& cells) {
    return read_norm(write("m.csv", "percent," + columns + "\n0," + cells + "\n"), "percent", {})
        .value()
        .meaning;
  };
  const auto one = meaning("mean,sd,low,high,one_low,one_high", "5,1,4,6,2,8");
  EXPECT_EQ(one, "simultaneous band of one further curve");
  EXPECT_THAT(one, Not(HasSubstr("band as in the file")));
  const auto ends = meaning("mean,sd,low,high", "5,1,4,6");
  EXPECT_EQ(ends, "band as in the file");
  EXPECT_THAT(ends, Not(HasSubstr("mean +- 2 SD at each point")));
  const auto spread = meaning("mean,sd", "5,1");
  EXPECT_EQ(spread, "mean +- 2 SD at each point");
  EXPECT_THAT(spread, Not(HasSubstr("simultaneous band of one further curve")));
}

TEST_F(NormJobTest, PointsBeyondTheBandAreNotCompared) {
  const auto part = write("part.csv", "percent,low,high\n0,0,30\n50,0,30\n");
  const auto outcome = run_norm({.norm = part, .inputs = {curves_}});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->curves[0].points, 3);
  const auto away = write("away.csv", "percent,low,high\n200,0,30\n300,0,30\n");
  EXPECT_THAT(run_norm({.norm = away, .inputs = {curves_}}).error().message,
              HasSubstr("no point of the curves (percent 0 to 100) lies within those of"));
}

TEST_F(NormJobTest, PointsBesideOneWithoutAValueAreNotCompared) {
  const auto holed = write("holed.csv", "percent,low,high\n0,0,30\n50,,\n100,0,30\n");
  const auto outcome = run_norm({.norm = holed, .inputs = {curves_}});
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->curves[0].points, 2);  // at 0 and at 100, not at 25 and 50
  EXPECT_EQ(outcome->curves[0].outside, 0);
}

TEST_F(NormJobTest, OneOfSeveralBandsIsChosen) {
  const auto two = write("two.csv", "age,percent,low,high\n5,0,0,1\n5,100,0,1\n40,0,0,30\n40,100,0,30\n");
  const auto both = run_norm({.norm = two, .inputs = {curves_}});
  EXPECT_THAT(both.error().message, HasSubstr("choose one band with --norm-where"));
  const auto one = run_norm({.norm = two, .norm_where = {"age=40"}, .inputs = {curves_}});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->curves[1].outside, 0);
}

TEST_F(NormJobTest, WhatIsNoBandIsRefused) {
  EXPECT_THAT(sentence("percent,mean\n0,1\n"),
              HasSubstr("has no columns one_low and one_high, low and high, or mean and sd"));
  EXPECT_THAT(sentence("percent,low,high\n0,2,1\n"),
              HasSubstr("line 2: the band's lower end 2 is above its upper end 1"));
  EXPECT_THAT(sentence("percent,low,high\n,1,2\n"), HasSubstr("line 2: percent is blank"));
  EXPECT_THAT(sentence("low,high\n1,2\n"), HasSubstr("no column 'percent' (--at)"));
  const auto in_mm = write("mm.csv", "percent,low,high,unit\n0,1,2,mm\n100,1,2,mm\n");
  EXPECT_THAT(run_norm({.norm = in_mm, .inputs = {curves_}}).error().message,
              HasSubstr("is in 'mm', the curves are in 'deg'"));
}

}  // namespace
}  // namespace kinemark::pipeline
