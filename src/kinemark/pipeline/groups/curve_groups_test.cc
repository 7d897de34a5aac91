// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/groups/curve_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

io::TidyTable table_of(const std::string& text, const std::string& name = "t.csv") {
  return io::parse_tidy_csv(text, name).value();
}

std::string sentence(const std::vector<io::TidyTable>& tables, const CurveColumns& columns = {}) {
  const auto groups = make_curve_groups(tables, columns);
  return groups ? "" : groups.error().message;
}

// Two subjects, one of whom walked twice, before and after.
const std::string kWalks =
    "subject,when,cycle,percent,value,unit\n"
    "S1,before,1,0,10,deg\nS1,before,1,100,20,deg\nS1,before,2,0,14,deg\nS1,before,2,100,nan,deg\n"
    "S2,before,1,0,1,deg\nS2,before,1,100,2,deg\n"
    "S2,after,1,0,3,deg\nS2,after,1,100,4,deg\nS1,after,1,0,5,deg\nS1,after,1,100,6,deg\n"
    "S3,after,1,0,7,deg\nS3,after,1,100,8,deg\n";

TEST(CurveGroups, NumbersAloneAreACurveARowAndAGroupAFile) {
  const auto groups =
      make_curve_groups({table_of("1,2,3\n4,5,6\n", "a/old.csv"), table_of("7,8,9\n", "young.csv")}, {});
  ASSERT_TRUE(groups) << groups.error().message;
  EXPECT_THAT(groups->names, ElementsAre("old", "young"));
  EXPECT_THAT(groups->at, ElementsAre(0, 1, 2));
  EXPECT_EQ(groups->at_name, "point");
  EXPECT_EQ(groups->curves[0].count(), 2);
  EXPECT_EQ(groups->curves[0](1, 2), 6);
  EXPECT_TRUE(groups->curves[0].validate());
}

TEST(CurveGroups, CurvesOfASubjectAreAveragedOverThoseThatAreThere) {
  const auto groups = make_curve_groups({table_of(kWalks)}, {.group = "when", .subject = "subject"});
  ASSERT_TRUE(groups) << groups.error().message;
  EXPECT_THAT(groups->names, ElementsAre("before", "after"));
  EXPECT_THAT(groups->curves[0].cycles, ElementsAre("S1", "S2"));
  EXPECT_EQ(groups->curves[0](0, 0), 12.0);
  EXPECT_EQ(groups->curves[0](0, 1), 20.0);
  EXPECT_EQ(groups->unit, "deg");
  EXPECT_THAT(groups->warnings,
              ElementsAre("6 curves are averaged to 5, one for each subject in each group"));
  const auto first =
      make_curve_groups({table_of(kWalks)}, {.group = "when", .subject = "subject", .where = {"cycle=1"}});
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_THAT(first->warnings, Not(Contains(HasSubstr("one for each subject in each group"))))
      << "there was one of each";
}

TEST(CurveGroups, TheMeanOfCyclesIsNoFurtherCurve) {
  const auto table = table_of(
      "curve,cycle,percent,value\nknee,1,0,1\nknee,1,100,2\nknee,2,0,3\nknee,2,100,6\n"
      "knee,mean,0,2\nknee,mean,100,4\n");
  const auto groups = make_curve_groups({table}, {});
  ASSERT_TRUE(groups) << groups.error().message;
  EXPECT_THAT(groups->curves[0].cycles, ElementsAre("1 knee", "2 knee"));
  EXPECT_THAT(groups->warnings, ElementsAre(HasSubstr("lines of the mean of cycles are left out")));
  const auto mean = make_curve_groups({table}, {.where = {"cycle=mean"}});
  ASSERT_TRUE(mean) << mean.error().message;
  EXPECT_THAT(mean->curves[0].cycles, ElementsAre("mean knee"));
  EXPECT_THAT(mean->warnings, Not(Contains(HasSubstr("lines of the mean of cycles are left out"))));
}

TEST(CurveGroups, WithoutASubjectEachCurveStandsForItself) {
  const auto groups = make_curve_groups({table_of(kWalks)}, {.group = "when"});
  ASSERT_TRUE(groups);
  EXPECT_EQ(groups->curves[0].count(), 3);
  EXPECT_TRUE(std::isnan(groups->curves[0](1, 1)));
  EXPECT_TRUE(groups->warnings.empty());
}

TEST(CurveGroups, PairsGoBySubjectWhateverTheirOrder) {
  auto groups = make_curve_groups({table_of(kWalks)}, {.group = "when", .subject = "subject"}).value();
  ASSERT_TRUE(pair_curves(groups));
  EXPECT_THAT(groups.curves[0].cycles, ElementsAre("S1", "S2"));
  EXPECT_THAT(groups.curves[1].cycles, ElementsAre("S1", "S2"));
  EXPECT_EQ(groups.curves[1](0, 0), 5.0);
  EXPECT_THAT(groups.warnings.back(), HasSubstr("1 curves without a partner are left out"));
  auto rows =
      make_curve_groups({table_of("1,2\n3,4\n", "a.csv"), table_of("5,6\n7,8\n", "b.csv")}, {}).value();
  ASSERT_TRUE(pair_curves(rows));
  EXPECT_EQ(rows.curves[1](1, 0), 7.0);
  EXPECT_THAT(rows.warnings, Not(Contains(HasSubstr("curves without a partner are left out"))));
  auto apart =
      make_curve_groups({table_of(kWalks)}, {.group = "when", .curve = {"when", "subject", "cycle"}}).value();
  EXPECT_THAT(pair_curves(apart).error().message, HasSubstr("no curve of 'before' has a partner"));
  auto one = make_curve_groups({table_of("1,2\n3,4\n")}, {}).value();
  EXPECT_EQ(pair_curves(one).error().message, "a paired comparison takes two groups; there are 1");
}

TEST(CurveGroups, WhatDoesNotFitIsSaid) {
  EXPECT_EQ(sentence({table_of("1,2\n", "a.csv"), table_of("1,2,3\n", "b.csv")}),
            "b.csv has 3 points a curve, a.csv has 2");
  EXPECT_EQ(sentence({table_of("1,2\n", "a.csv"), table_of("percent,value\n0,1\n", "b.csv")}),
            "b.csv has names of columns, a.csv has none; need the same of all");
  EXPECT_THAT(sentence({table_of("1,2\n", "a.csv")}, {.group = "x"}), HasSubstr("no column can be named"));
  EXPECT_THAT(
      sentence({table_of("percent,value\n0,1\n0,2\n")}),
      HasSubstr(
          "t.csv: line 3: curve '' has a second value at 0; name what tells curves apart with --curve"));
  EXPECT_EQ(sentence({table_of("percent,value\n0,1\n,2\n")}),
            "t.csv: line 3: percent is blank; need a number");
  EXPECT_EQ(sentence({table_of("percent,value\n0,x\n")}),
            "t.csv: line 2: column 'value' is 'x'; need a number");
  EXPECT_EQ(sentence({table_of("percent,value\n0,1\n")}), "the curves have a single point; need two or more");
  EXPECT_THAT(sentence({table_of("cycle,percent,value\n1,0,1\n1,10,1\n2,1,1\n2,11,1\n3,2,1\n3,12,1\n")}),
              HasSubstr("no curve has more than 2 of the 6 different points"));
}

}  // namespace
}  // namespace kinemark::pipeline
