// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/gait/gait_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/gait/testing/known_curves.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::Side;
using ::testing::ElementsAre;

constexpr std::array kNine = {"PelvisAngles x", "PelvisAngles y", "PelvisAngles z",
                              "HipAngles x",    "HipAngles y",    "HipAngles z",
                              "KneeAngles x",   "AnkleAngles x",  "FootProgressAngles z"};

// The norm is the known mean curve, shifted by `shift(i)` deg for variable i.
template <class Shift>
GaitNorms norms_beside(const Shift& shift) {
  GaitNorms out;
  for (std::size_t i = 0; i < kNine.size(); ++i) {
    NormCurve norm{.name = kNine[i], .unit = "deg", .meaning = "m", .source = "s"};
    for (int p = 0; p <= 100; ++p) {
      const double mean = testing::known_angle_deg(1, 3, p / 100.0) + shift(i);
      norm.at.push_back(p);
      norm.mean.push_back(mean);
      norm.low.push_back(mean - 1.0);
      norm.high.push_back(mean + 1.0);
    }
    out.curves.push_back(std::move(norm));
  }
  return out;
}

GaitDeviation deviation_of(const std::vector<SheetInput>& curves, const GaitNorms& norms) {
  return gait_deviation(make_gait_sheet("walk", curves, testing::known_gait(), norms));
}

TEST(GaitDeviation, AShiftOfAllByThreeDegreesScoresThree) {
  const auto out = deviation_of(testing::known_walk(), norms_beside([](std::size_t) { return 3.0; }));
  ASSERT_EQ(out.scores.size(), 9u);
  for (const auto& score : out.scores)
    for (const double v : score.value_deg) EXPECT_NEAR(v, 3.0, 1e-9) << score.title;
  EXPECT_NEAR(out.side_deg[0], 3.0, 1e-9);
  EXPECT_NEAR(out.side_deg[1], 3.0, 1e-9);
  EXPECT_NEAR(out.both_deg, 3.0, 1e-9);
  EXPECT_TRUE(out.lacking.empty());
}

TEST(GaitDeviation, ThePelvisCountsOnceForBothSides) {
  // 5 deg in the pelvis alone: of nine, three are 5; of fifteen, three are 5.
  const auto out =
      deviation_of(testing::known_walk(), norms_beside([](std::size_t i) { return i < 3 ? 5.0 : 0.0; }));
  EXPECT_NEAR(out.side_deg[0], 5.0 * std::sqrt(3.0 / 9.0), 1e-9);
  EXPECT_NEAR(out.both_deg, 5.0 * std::sqrt(3.0 / 15.0), 1e-9);
}

TEST(GaitDeviation, ASineScoresItsRootMeanSquare) {
  auto norms = norms_beside([](std::size_t) { return 0.0; });
  auto& knee = norms.curves[6];
  for (std::size_t p = 0; p < knee.mean.size(); ++p)
    knee.mean[p] += 4.0 * std::sin(2.0 * std::numbers::pi * static_cast<double>(p) / 100.0);
  const auto out = deviation_of(testing::known_walk(), norms);
  EXPECT_EQ(out.scores[6].title, "Knee flexion");
  EXPECT_NEAR(out.scores[6].value_deg[0], 4.0 * std::sqrt(50.0 / 101.0),
              1e-9);  // 101 points, the first twice
}

TEST(GaitDeviation, WithoutOneOfTheNineThereIsNoScoreButAProfile) {
  auto curves = testing::known_walk();
  std::erase_if(curves, [](const SheetInput& one) { return one.curves.id == "RKneeAngles x"; });
  const auto out = deviation_of(curves, norms_beside([](std::size_t) { return 1.0; }));
  EXPECT_NEAR(out.side_deg[0], 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(out.side_deg[1]));
  EXPECT_TRUE(std::isnan(out.both_deg));
  EXPECT_THAT(out.lacking, ElementsAre("Knee flexion"));
}

TEST(GaitDeviation, ANormWithoutMeansHasNone) {
  auto norms = norms_beside([](std::size_t) { return 1.0; });
  for (auto& curve : norms.curves) curve.mean.assign(curve.mean.size(), kNaN);
  EXPECT_TRUE(deviation_of(testing::known_walk(), norms).scores.empty());
  EXPECT_TRUE(deviation_of(testing::known_walk(), {}).scores.empty());
}

TEST(GaitDeviation, ACurveWithAGapHasNoScore) {
  auto curves = testing::known_walk();
  for (auto& one : curves)
    if (one.curves.id == "LHipAngles x")
      for (std::size_t c = 0; c < 3; ++c) one.curves.values[101 * c + 40] = kNaN;
  const auto out = deviation_of(curves, norms_beside([](std::size_t) { return 1.0; }));
  EXPECT_TRUE(std::isnan(out.scores[3].value_deg[0]));
  EXPECT_NEAR(out.scores[3].value_deg[1], 1.0, 1e-9);
}

using data::Side;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string page_of(const GaitSheet& sheet, const GaitPageFacts& facts = {.angles_from = "Plug-in Gait"}) {
  return gait_page(sheet, gait_deviation(sheet), gait_figures(sheet), facts);
}

// What the page shows.
json shown(const std::string& page) {
  const std::string begin = "id=\"kinemark-data\">";
  const auto first = page.find(begin) + begin.size();
  return json::parse(page.substr(first, page.find("</script>", first) - first));
}

json result_of(const GaitSheet& sheet, const GaitPageFacts& facts = {.angles_from = "Plug-in Gait"}) {
  return shown(page_of(sheet, facts))["result"];
}

GaitSheet page_walk(const GaitNorms& norms = {}, double sd_deg = 0.5) {
  return make_gait_sheet("walk.c3d", testing::known_walk(sd_deg), testing::known_gait(), norms);
}

GaitNorms all_norms() {
  GaitNorms out;
  for (const auto& name : testing::grid_names()) out.curves.push_back(testing::known_norm(name));
  out.measures.push_back({.id = "stride_time", .unit = "s", .low = 1.1, .high = 1.3, .source = "B"});
  return out;
}

json row_of(const json& result, const std::string& title) {
  for (const auto& row : result["measures"])
    if (row["title"] == title) return row;
  return nullptr;
}

TEST(GaitPage, HoldsFiguresMeasuresAndEvents) {
  const auto page = page_of(page_walk());
  EXPECT_THAT(page, StartsWith("<!doctype html>"));
  const auto data = shown(page);
  EXPECT_EQ(data["summary"]["kind"], "gait");
  EXPECT_EQ(data["summary"]["trial"], "walk.c3d");
  const auto& result = data["result"];
  EXPECT_EQ(result["feet"][0]["cycles"], 3);
  EXPECT_THAT(result["feet"][0]["in_words"].get<std::string>(),
              StartsWith("Left: 3 cycles, toe-off at 60.0"));
  EXPECT_EQ(result["figures"][0]["name"], "gait_kinematics");
  EXPECT_THAT(result["figures"][0]["body"].get<std::string>(), StartsWith("<svg"));
  const auto row = row_of(result, "Stride time");
  EXPECT_EQ(row["unit"], "s");
  EXPECT_THAT(row["value"][0].get<std::string>(), StartsWith("1 [0.99 to 1.01]"));
  EXPECT_EQ(result["level"], 0.95);
  EXPECT_EQ(result["events"][0]["foot"], "Left");
  EXPECT_EQ(result["events"][0]["event"], "Foot Strike");
  EXPECT_EQ(result["events"][0]["time_s"], 0.0);
  EXPECT_THAT(result["events"][0]["by"].get<std::string>(), HasSubstr("O'Connor 2007"));
  EXPECT_EQ(result["own_error"], true);
  EXPECT_EQ(result["angles_from"], "Plug-in Gait");
}

TEST(GaitPage, WhereNoAngleIsDrawnNoneHasASource) {
  auto moment = testing::known_curve("LHipMoment x", Side::left);
  moment.curves.quantity = data::Quantity::moment;
  for (const auto& curves : {std::vector<SheetInput>{}, std::vector{moment}}) {
    const auto page = page_of(make_gait_sheet("walk.c3d", curves, testing::known_gait(), {}));
    EXPECT_TRUE(shown(page)["result"]["angles_from"].is_null());
    EXPECT_THAT(page, Not(HasSubstr("Plug-in Gait")));
  }
}

TEST(GaitPage, HoldsNothingOfWhatIsAbsent) {
  const auto data = shown(page_of(page_walk({}, 0.0)));
  const auto& result = data["result"];
  EXPECT_EQ(result["own_error"], false);
  EXPECT_EQ(result["curve_norm"], "");
  EXPECT_TRUE(result["norm_sources"].empty());
  EXPECT_TRUE(result["deviation"]["scores"].empty());
  EXPECT_EQ(result["treadmill"], false);
  EXPECT_TRUE(data["summary"]["groups"].empty());
  EXPECT_EQ(data["summary"]["verdict"], "good");
}

TEST(GaitPage, ComparesWithTheNormAndNamesItsSource) {
  const auto result = result_of(page_walk(all_norms()));
  EXPECT_EQ(result["curve_norm"], "A book (mean \u00b1 2 SD at each point)");
  EXPECT_EQ(result["norm_sources"], json({"B"}));
  EXPECT_EQ(row_of(result, "Stride time")["judgement"][0], "below");
  EXPECT_EQ(row_of(result, "Stride time")["norm"], "1.1 to 1.3");
}

TEST(GaitPage, TheProfileScoreIsThatOfTheCurves) {
  const auto full = result_of(page_walk(all_norms()))["deviation"];
  EXPECT_NEAR(full["both_deg"].get<double>(), 30.0 * std::sqrt(50.0 / 101.0), 0.05);  // a sine of 30 deg
  EXPECT_TRUE(full["lacking"].empty());
  auto curves = testing::known_walk();
  std::erase_if(curves, [](const SheetInput& one) { return one.curves.id.ends_with("HipAngles z"); });
  const auto partial =
      result_of(make_gait_sheet("walk.c3d", curves, testing::known_gait(), all_norms()))["deviation"];
  EXPECT_TRUE(partial["both_deg"].is_null());
  EXPECT_EQ(partial["lacking"], json({"Hip rotation"}));
}

TEST(GaitPage, RemarksOfJobAndSheetOnceEach) {
  const auto sheet = make_gait_sheet("walk", {testing::known_curve("LKneeAngles x", Side::left, 1)},
                                     testing::known_gait(1, 0), {});
  const auto data = shown(page_of(sheet, {.angles_from = "x", .warnings = {sheet.remarks[0], "a < b"}}));
  std::vector<std::string> said;
  for (const auto& group : data["summary"]["groups"])
    for (const auto& item : group["items"]) said.push_back(item["text"]);
  auto expected = sheet.remarks;
  expected.emplace_back("a < b");
  EXPECT_THAT(said, ::testing::UnorderedElementsAreArray(expected));
}

TEST(GaitPage, AMissedBoundComesFirstAndOnePassedIsNotSaid) {
  const auto data = shown(page_of(
      page_walk(),
      {.gates = {{.name = "feet", .sentence = "fine"},
                 {.name = "recording", .passed = false, .sentence = "'LHEE' and 'LTOE' are exchanged"}}}));
  EXPECT_EQ(data["summary"]["verdict"], "attention");
  ASSERT_EQ(data["summary"]["groups"].size(), 1U);
  EXPECT_EQ(data["summary"]["groups"][0]["items"][0]["text"], "'LHEE' and 'LTOE' are exchanged");
}

TEST(GaitPage, NamesAreTextInIt) {
  const auto sheet = make_gait_sheet("</script><b>", {testing::known_curve("L<i>Angles x", Side::left)},
                                     testing::known_gait(), {});
  const auto page = page_of(sheet, {.angles_from = "</script><u>", .command_line = "kinemark </script><x>"});
  for (const char* word : {"</script><b>", "</script><u>", "</script><x>"})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

TEST(GaitPage, ATreadmillIsSaid) {
  auto gait = testing::known_gait();
  gait.treadmill = true;
  EXPECT_EQ(result_of(make_gait_sheet("w", testing::known_walk(), gait, {}))["treadmill"], true);
}

TEST(GaitPage, TheSameGivesTheSameBytes) {
  EXPECT_EQ(page_of(page_walk(all_norms())), page_of(page_walk(all_norms())));
}

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
