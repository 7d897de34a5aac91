// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_norms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "kinemark/pipeline/gait/testing/known_curves.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Result<GaitNorms> parsed(const std::string& text) {
  const auto table = io::parse_tidy_csv(text, "norms/adults.csv");
  if (!table) return std::unexpected(table.error());
  return gait_norms_of(*table);
}

std::string refused(const std::string& text) {
  const auto norms = parsed(text);
  if (norms) return "accepted";
  EXPECT_EQ(norms.error().code, Code::bad_input);
  return norms.error().message;
}

TEST(GaitNorms, OfManyCurvesByTheirNames) {
  const auto norms = parsed(
      "curve,percent,mean,sd,unit\n"
      "LKneeAngles x,100,6,2,deg\nLKneeAngles x,0,5,2,deg\nHipAngles x,0,30,5,deg\n");
  ASSERT_TRUE(norms) << norms.error().message;
  ASSERT_EQ(norms->curves.size(), 2u);
  const auto& knee = norms->curves[0];
  EXPECT_EQ(knee.name, "LKneeAngles x");
  EXPECT_THAT(knee.at, ElementsAre(0.0, 100.0));  // put in order
  EXPECT_THAT(knee.low, ElementsAre(1.0, 2.0));
  EXPECT_THAT(knee.high, ElementsAre(9.0, 10.0));
  EXPECT_THAT(knee.mean, ElementsAre(5.0, 6.0));
  EXPECT_EQ(knee.source, "adults.csv");
  EXPECT_THAT(knee.meaning, HasSubstr("2 SD at each point"));
  EXPECT_THAT(knee.meaning, Not(HasSubstr("band of one further curve")));
}

TEST(GaitNorms, AsGroupsBandWritesThem) {
  const auto norms = parsed(
      "group,percent,mean,sd,curves,low,high,one_low,one_high,unit\n"
      "RKneeAngles x,0,5,2,9,4,6,0,10,deg\n");
  ASSERT_TRUE(norms) << norms.error().message;
  EXPECT_THAT(norms->curves[0].low, ElementsAre(0.0));  // of one further curve, not of the mean
  EXPECT_EQ(norms->curves[0].meaning, "band of one further curve, at all points at once");
  EXPECT_THAT(norms->curves[0].meaning, Not(HasSubstr("band as in the file")));
  EXPECT_THAT(norms->curves[0].meaning, Not(HasSubstr("2 SD at each point")));
}

TEST(GaitNorms, OfMeasuresInTheSameFile) {
  const auto norms = parsed(
      "curve,percent,measure,context,low,high,unit,source\n"
      "KneeAngles x,0,,,0,10,deg,Schwartz 2008\n"
      ",,stride_time,,1.0,1.2,s,Schwartz 2008\n"
      ",,step_length,Left,600,700,mm,Schwartz 2008\n");
  ASSERT_TRUE(norms) << norms.error().message;
  ASSERT_EQ(norms->measures.size(), 2u);
  EXPECT_EQ(norms->measures[0].id, "stride_time");
  EXPECT_FALSE(norms->measures[0].side);
  EXPECT_EQ(norms->measures[1].side, Side::left);
  EXPECT_EQ(norms->measures[1].high, 700.0);
  EXPECT_EQ(norms->curves[0].source, "Schwartz 2008");
}

TEST(GaitNorms, EachLineHasTheEndsThatItGives) {
  const auto norms = parsed(
      "curve,percent,mean,sd,measure,low,high\n"
      "KneeAngles x,0,5,2,,,\n,,,,stride_time,1.0,1.2\n");
  ASSERT_TRUE(norms) << norms.error().message;
  EXPECT_THAT(norms->curves[0].low, ElementsAre(1.0));
  EXPECT_EQ(norms->measures[0].high, 1.2);
}

TEST(GaitNorms, ABandIsOfOneKind) {
  const auto norms =
      parsed("group,percent,mean,sd,one_low,one_high\nknee,0,5,2,0,10\nknee,50,5,2,,\nknee,100,5,2,0,10\n");
  ASSERT_TRUE(norms) << norms.error().message;
  EXPECT_TRUE(std::isnan(norms->curves[0].low[1]));
  EXPECT_TRUE(std::isnan(norm_at(norms->curves[0], 70.0).high));
  EXPECT_EQ(norm_at(norms->curves[0], 100.0).high, 10.0);
}

TEST(GaitNorms, AFileOfOneCurveIsCalledByItsName) {
  const auto norms = parsed("percent,low,high\n0,1,2\n100,1,2\n");
  ASSERT_TRUE(norms);
  EXPECT_EQ(norms->curves[0].name, "adults");
  EXPECT_EQ(norms->curves[0].meaning, "band as in the file");
  EXPECT_TRUE(std::isnan(norms->curves[0].mean[0]));
}

TEST(GaitNorms, SaysInOneSentenceWhatIsWrong) {
  EXPECT_THAT(refused("curve,percent,value\nknee,0,1\n"), HasSubstr("groups band"));
  EXPECT_THAT(refused("curve,low,high\nknee,0,1\n"), HasSubstr("column percent"));
  EXPECT_THAT(refused("curve,percent,low,high\nknee,0,2,1\n"), HasSubstr("line 2: the band's lower end 2"));
  EXPECT_THAT(refused("curve,percent,mean,sd\nknee,0,2,-1\n"), HasSubstr("the deviation -1 is negative"));
  EXPECT_THAT(refused("curve,percent,low,high\nknee,120,1,2\n"),
              HasSubstr("percent is '120'; expected 0 to 100"));
  EXPECT_THAT(refused("curve,percent,low,high\nknee,0,1,2\nknee,0,1,2\n"), HasSubstr("comes twice"));
  EXPECT_THAT(refused("curve,percent,low,high\nknee,0,x,2\n"), HasSubstr("line 2"));
  EXPECT_THAT(refused("curve,percent,low,high\nknee,0,,\n"), HasSubstr("no line has both ends"));
  EXPECT_THAT(refused("curve,percent,low,high,unit\nknee,0,1,2,deg\nknee,50,1,2,rad\n"),
              HasSubstr("is in 'rad' here and in 'deg' above"));
  EXPECT_THAT(refused("curve,percent,low,high,context\nknee,0,1,2,both\n"),
              HasSubstr("Left, Right or nothing"));
  EXPECT_THAT(refused("measure,low,high\nstride_time,1,2\nstride_time,1,2\n"), HasSubstr("comes twice"));
}

TEST(GaitNorms, WhatIsJustRightIsNotRefused) {
  const auto accepted = [](const std::string& text, const std::string& sentence) {
    const auto norms = parsed(text);
    EXPECT_TRUE(norms) << sentence;
    return norms ? std::string() : norms.error().message;
  };
  EXPECT_THAT(accepted("curve,percent,low,high\nknee,0,1,1\n", "a band without width"),
              Not(HasSubstr("is above its upper end")));
  EXPECT_THAT(accepted("curve,percent,mean,sd\nknee,0,2,0\n", "a deviation of 0"),
              Not(HasSubstr("the deviation")));
  EXPECT_THAT(accepted("curve,percent,low,high\nknee,0,1,2\nknee,100,1,2\n", "from 0 to 100"),
              Not(HasSubstr("'; expected 0 to 100")));
  EXPECT_THAT(accepted("curve,percent,low,high\nknee,0,1,2\nhip,0,1,2\n", "the same place of two curves"),
              Not(HasSubstr("comes twice")));
  EXPECT_THAT(
      accepted("measure,context,low,high\nstep_length,Left,1,2\nstep_length,Right,1,2\n", "both sides"),
      Not(HasSubstr("comes twice")));
  EXPECT_THAT(accepted("curve,percent,low,high,unit\nknee,0,1,2,deg\nhip,0,1,2,rad\n", "units of two curves"),
              Not(HasSubstr("' here and in '")));
  EXPECT_THAT(accepted("curve,percent,low,high,context\nknee,0,1,2,Right\nhip,0,1,2,\n", "a side and none"),
              Not(HasSubstr("Left, Right or nothing")));
}

TEST(GaitNorms, OfSeveralFiles) {
  const testing_support::ScratchFolder scratch;
  std::ofstream(scratch / "a.csv") << "curve,percent,low,high\nhip,0,1,2\n";
  std::ofstream(scratch / "b.csv") << "measure,low,high\nstride_time,1,2\n";
  const std::vector<std::filesystem::path> files{scratch / "a.csv", scratch / "b.csv"};
  const auto norms = read_gait_norms(files);
  ASSERT_TRUE(norms) << norms.error().message;
  EXPECT_EQ(norms->curves.size(), 1u);
  EXPECT_EQ(norms->measures.size(), 1u);
  const std::vector<std::filesystem::path> none{scratch / "none.csv"};
  EXPECT_EQ(read_gait_norms(none).error().code, Code::io);
}

TEST(GaitNorms, FitACurveByNameSideAndDirection) {
  GaitNorms norms{.curves = {testing::known_norm("LKneeAngles x"), testing::known_norm("hip_flexion"),
                             testing::known_norm("Ankle dorsiflexion"), testing::known_norm("pelvis_tilt")}};
  EXPECT_EQ(find_norm(norms, "LKneeAngles x", Side::left), norms.curves.data());
  EXPECT_EQ(find_norm(norms, "RKneeAngles x", Side::right), nullptr);  // it is of the left
  EXPECT_EQ(find_norm(norms, "LKneeAngles_flexion", Side::left), norms.curves.data());
  EXPECT_EQ(find_norm(norms, "RHipAngles x", Side::right), &norms.curves[1]);
  EXPECT_EQ(find_norm(norms, "hip_flexion_l", Side::left), &norms.curves[1]);
  EXPECT_EQ(find_norm(norms, "LAnkleAngles x", Side::left), &norms.curves[2]);
  // A model's tilt may count the other way: only the same name fits.
  EXPECT_EQ(find_norm(norms, "LPelvisAngles x", Side::left), nullptr);
  EXPECT_EQ(find_norm(norms, "pelvis_tilt", Side::left), &norms.curves[3]);
  norms.curves[1].side = Side::left;
  EXPECT_EQ(find_norm(norms, "hip_flexion_r", Side::right), nullptr);
}

TEST(GaitNorms, AreLinearBetweenPointsAndNowhereElse) {
  NormCurve norm{
      .name = "x", .at = {10.0, 20.0}, .low = {0.0, 10.0}, .high = {5.0, 25.0}, .mean = {2.0, kNaN}};
  EXPECT_DOUBLE_EQ(norm_at(norm, 15.0).low, 5.0);
  EXPECT_DOUBLE_EQ(norm_at(norm, 15.0).high, 15.0);
  EXPECT_TRUE(std::isnan(norm_at(norm, 15.0).mean));
  EXPECT_DOUBLE_EQ(norm_at(norm, 10.0).mean, 2.0);
  EXPECT_DOUBLE_EQ(norm_at(norm, 20.0).high, 25.0);
  EXPECT_TRUE(std::isnan(norm_at(norm, 9.9).low));
  EXPECT_TRUE(std::isnan(norm_at(norm, 20.1).low));
}

}  // namespace
}  // namespace kinemark::pipeline
