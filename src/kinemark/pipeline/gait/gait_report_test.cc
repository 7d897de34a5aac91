// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/gait/testing/known_curves.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::unique_ptr<GaitReport> report_of(const std::vector<std::string>& pairs = {}) {
  return make_gait_report("walk.c3d", testing::known_walk(), testing::known_gait(), {}, pairs);
}

TEST(GaitReport, FiguresThenPairs) {
  const auto report = report_of();
  std::vector<std::string> names;
  for (const auto& figure : report->figures) names.push_back(figure.name);
  EXPECT_THAT(names, ElementsAre("gait_kinematics", "gait_hip_flexion_knee_flexion",
                                 "gait_knee_flexion_ankle_dorsiflexion"));
  EXPECT_THAT(gait_report_files(*report, {"svg", "png"}),
              ElementsAre("gait_kinematics.svg", "gait_kinematics.png", "gait_hip_flexion_knee_flexion.svg",
                          "gait_hip_flexion_knee_flexion.png", "gait_knee_flexion_ankle_dorsiflexion.svg",
                          "gait_knee_flexion_ankle_dorsiflexion.png", "gait_curves.csv", "gait_pairs.csv"));
}

TEST(GaitReport, WritesWhatItNames) {
  const auto report = report_of();
  const testing_support::ScratchFolder scratch;
  const auto folder = scratch / "figures";
  const auto names = gait_report_files(*report, {"svg"});
  auto staging = Staging::create_in(folder, names, {}, {});
  ASSERT_TRUE(staging) << staging.error().message;
  const auto written =
      write_results(*staging, gait_report_results(*report, folder, {"svg"}), {}, "the figures");
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->size(), names.size());
  const auto svg = io::read_text(folder / "gait_kinematics.svg");
  ASSERT_TRUE(svg);
  EXPECT_THAT(*svg, HasSubstr(">Knee flexion (deg)</text>"));
  const auto csv = io::read_text(folder / "gait_pairs.csv");
  ASSERT_TRUE(csv);
  EXPECT_THAT(*csv, ::testing::StartsWith("x,y,context,percent"));
}

TEST(GaitReport, WhatIsAskedForInVainIsARemark) {
  const auto report = report_of({"hip_flexion:elbow"});
  EXPECT_EQ(report->figures.size(), 1u);
  EXPECT_TRUE(report->pairs.empty());
  EXPECT_THAT(report->sheet.remarks, Contains(HasSubstr("no curve 'elbow'")));
  EXPECT_THAT(gait_report_files(*report, {"svg"}), ElementsAre("gait_kinematics.svg", "gait_curves.csv"));
  EXPECT_THAT(gait_report_page(*report, {.angles_from = "x"}), HasSubstr("no curve 'elbow'"));
}

TEST(GaitReport, APairHasTwoNames) {
  EXPECT_TRUE(GaitReportRequest{.angle_angle = {"a:b"}}.check());
  for (const char* text : {"a", ":b", "a:"}) {
    const auto status = GaitReportRequest{.angle_angle = {text}}.check();
    ASSERT_FALSE(status) << text;
    EXPECT_EQ(status.error().code, Code::usage);
    EXPECT_THAT(status.error().message, HasSubstr("hip_flexion:knee_flexion"));
  }
}

}  // namespace
}  // namespace kinemark::pipeline
