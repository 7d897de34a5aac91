// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/retest_job.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The six subjects and four judges of Shrout & Fleiss 1979, table 2: ICC(2,1) = 0.29, ICC(3,1) = 0.71.
constexpr double kRatings[6][4] = {{9, 2, 5, 8}, {6, 1, 3, 2},  {8, 4, 6, 8},
                                   {7, 1, 2, 6}, {10, 5, 6, 9}, {6, 2, 4, 7}};

class RetestJobTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(io::write_text(scratch_ / name, text, true));
    return scratch_ / name;
  }
  std::string ratings(const std::string& measure, const std::string& sd) {
    std::string text;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 4; ++j)
        text += fmt::format("{},S{},day {},{},mm{}\n", measure, i, j, kRatings[i][j], sd);
    return text;
  }

  testing_support::ScratchFolder scratch_;
};

TEST_F(RetestJobTest, NumbersOfShroutAndFleiss) {
  const auto table = write("t.csv", "measure,participant,session,value,unit\n" + ratings("length", ""));
  const auto outcome = run_retest({.inputs = {table}, .output = scratch_ / "o.csv"});
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->measures.size(), 1u);
  const auto& r = outcome->measures[0].reliability;
  EXPECT_NEAR(r.agreement.value, 0.29, 0.005);
  EXPECT_NEAR(r.consistency.value, 0.71, 0.005);
  EXPECT_TRUE(std::isnan(r.noise));
  const auto text = retest_text(*outcome);
  EXPECT_THAT(text, HasSubstr("length: 6 subjects; intervals of 95 %\n  ICC(2,1) 0.29"));
  EXPECT_THAT(text, Not(HasSubstr("with a value missing are left out")));
  EXPECT_THAT(text, HasSubstr(" mm, MDC95 "));
  EXPECT_THAT(text, Not(HasSubstr("measurement noise")));
  EXPECT_THAT(io::read_text(scratch_ / "o.csv").value(), HasSubstr("\nlength,mm,6,0,"));
}

TEST_F(RetestJobTest, ASubjectWithoutAValueInASessionIsLeftOutAndCounted) {
  const auto table = write("t.csv", "measure,participant,session,value,unit\n" + ratings("length", "") +
                                        "length,S7,day 0,5,mm\nlength,S7,day 1,4,mm\n");
  const auto outcome = run_retest({.inputs = {table}});
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_NEAR(outcome->measures[0].reliability.agreement.value, 0.29, 0.005);
  EXPECT_THAT(retest_text(*outcome), HasSubstr("length: 6 subjects (1 with a value missing are left out)"));
}

TEST_F(RetestJobTest, NoiseIsTakenOutWhereItIsKnown) {
  const auto table =
      write("t.csv", "measure,participant,session,value,unit,sd\n" + ratings("length", ",0.5"));
  const auto outcome = run_retest({.inputs = {table}});
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto& r = outcome->measures[0].reliability;
  EXPECT_NEAR(r.noise, 0.5, 1e-12);
  EXPECT_NEAR(r.sem_movement, std::sqrt(r.sem.value * r.sem.value - 0.25), 1e-9);
  EXPECT_THAT(retest_text(*outcome), HasSubstr("measurement noise 0.5 mm; without it SEM "));
}

TEST_F(RetestJobTest, ValuesOfASessionAreAveragedAndTheirNoiseWithThem) {
  std::string text = "participant,session,value,sd\n";
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 4; ++j)
      for (const double d : {-1.0, 1.0}) text += fmt::format("S{},{},{},0.4\n", i, j, kRatings[i][j] + d);
  const auto outcome = run_retest({.inputs = {write("t.csv", text)}});
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_NEAR(outcome->measures[0].reliability.agreement.value, 0.29, 0.005);
  EXPECT_NEAR(outcome->measures[0].reliability.noise, 0.4 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(outcome->measures[0].name, "value");
}

TEST_F(RetestJobTest, MeasuresAreTestedByThemselvesAndOneThatCannotBeIsSaid) {
  const auto table = write("t.csv", "measure,participant,session,value,unit\n" + ratings("length", "") +
                                        ratings("width", "") + "height,S0,day 0,1,mm\n");
  const auto outcome = run_retest({.inputs = {table}});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->measures.size(), 2u);
  ASSERT_EQ(outcome->warnings.size(), 1u);
  EXPECT_THAT(outcome->warnings[0], HasSubstr("height: "));
  EXPECT_EQ(run_retest({.inputs = {table}, .where = {"measure=height"}}).error().code, Code::bad_input);
}

TEST_F(RetestJobTest, WhatIsWrongInTheTableIsSaid) {
  const auto sentence = [&](const std::string& text) {
    const auto outcome = run_retest({.inputs = {write("w.csv", text)}});
    return outcome ? "" : outcome.error().message;
  };
  EXPECT_THAT(sentence("participant,value\nS1,1\n"), HasSubstr("no column 'session' (--session)"));
  EXPECT_THAT(sentence("participant,session,value\nS1,,1\n"), HasSubstr("line 2: session is blank"));
  EXPECT_THAT(sentence("participant,session,value,sd\nS1,1,1,-2\n"), HasSubstr("line 2: sd is negative"));
  EXPECT_THAT(sentence("participant,session,value,unit\nS1,1,1,mm\nS1,2,1,m\n"),
              HasSubstr("line 3: is in 'm', other values of value in 'mm'"));
  EXPECT_EQ(run_retest({.inputs = {write("w.csv", "participant,session,value\nS1,1,1\n")}, .output = "o.txt"})
                .error()
                .code,
            Code::usage);
}

}  // namespace
}  // namespace kinemark::pipeline
