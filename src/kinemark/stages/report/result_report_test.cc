// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/result_report.h"

#include <gtest/gtest.h>

namespace kinemark::report {
namespace {

TEST(ResultReport, TellsItsKindItsVerdictAndItsDocument) {
  ResultReport report{.kind = "scale", .trial = "arm.osim", .version = "1", .result = {{"mass_kg", 70.0}}};
  auto json = result_report_json(report);
  EXPECT_EQ(json["summary"]["schema"], "kinemark.result_report");
  EXPECT_EQ(json["summary"]["kind"], "scale");
  EXPECT_EQ(json["summary"]["verdict"], "good");
  EXPECT_TRUE(json["summary"]["clock"].is_null());
  EXPECT_TRUE(json["scene"].is_null());
  EXPECT_EQ(json["result"]["mass_kg"], 70.0);
  add_remarks(report.groups, std::vector<std::string>{"a", "b"});
  EXPECT_EQ(result_report_json(report)["summary"]["verdict"], "good") << "remarks alone are notes";
  add_gates(report.groups, std::vector<Gate>{{.name = "g", .passed = true},
                                             {.name = "h", .passed = false, .sentence = "too far"}});
  json = result_report_json(report);
  EXPECT_EQ(json["summary"]["verdict"], "attention");
  ASSERT_EQ(json["summary"]["groups"].size(), 2U);
  EXPECT_EQ(json["summary"]["groups"][0]["title"], "2 remarks");
  EXPECT_EQ(json["summary"]["groups"][1]["title"], "1 quality check missed");
  EXPECT_EQ(json["summary"]["groups"][1]["items"][0]["text"], "too far");
}

TEST(ResultReport, GatesThatWereMetMakeNoGroup) {
  std::vector<NoticeGroup> groups;
  add_gates(groups, std::vector<Gate>{{.name = "g", .passed = true}});
  EXPECT_TRUE(groups.empty());
  EXPECT_EQ(verdict_of(groups), Verdict::good);
}

TEST(ResultReport, TheClockIsThatOfItsScene) {
  const auto markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 240.0, .t0_s = 1.5, .frames = 10});
  const ResultReport report{.kind = "joints", .scene = Scene{.markers = &markers}, .first_frame = 361};
  const auto json = result_report_json(report);
  EXPECT_EQ(json["summary"]["clock"]["rate_hz"], 240.0);
  EXPECT_EQ(json["summary"]["clock"]["first_frame"], 361);
  EXPECT_EQ(json["scene"]["points"], 10);
}

TEST(ResultReport, NamesCannotEndTheScript) {
  const std::string hostile = "</script><img onerror=alert(1)>";
  const auto page = result_report_html({.kind = "study", .trial = hostile, .result = {{"x", hostile}}});
  EXPECT_EQ(page.find(hostile), std::string::npos);
  EXPECT_NE(page.find("\\u003c/script>"), std::string::npos);
}

}  // namespace
}  // namespace kinemark::report
