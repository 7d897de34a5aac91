// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/markers_report.h"

#include <gmock/gmock.h>

#include <numbers>

namespace kinemark::report {
namespace {

using data::SampleState;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// Whole; half there; never there; made in parts; not named.
data::Trial five_markers() {
  data::Trial trial;
  trial.format = "C3D";
  auto& t = trial.markers = data::Trajectories::all_missing({"whole", "half", "never", "made", "*5"},
                                                            {.rate_hz = 50.0, .t0_s = 1.0, .frames = 100});
  for (std::int64_t f = 0; f < 100; ++f)
    for (std::int64_t m = 0; m < 5; ++m) {
      if (m == 2 || (m == 1 && f >= 20 && f < 70)) continue;
      t.state[t.index(f, m)] = m == 3 && f < 10 ? SampleState::interpolated : SampleState::measured;
      t.x(f, m) = Eigen::Vector3d(0.01 * static_cast<double>(f), static_cast<double>(m), std::numbers::pi);
    }
  return trial;
}

std::vector<std::string> titles(const std::vector<NoticeGroup>& groups) {
  std::vector<std::string> out;
  for (const auto& group : groups) out.push_back(group.title);
  return out;
}

TEST(MarkersReport, FoldsWhatStandsOutByKindTheSeriousFirst) {
  auto trial = five_markers();
  trial.warnings = {"the header lies"};
  const auto groups = markers_notices({.recording = &trial});
  EXPECT_THAT(titles(groups), ::testing::ElementsAre("1 marker in no frame",
                                                     "1 marker missing in more than a fifth of the frames",
                                                     "1 marker with samples that were made",
                                                     "1 point that nobody named", "1 remark about the file"));
  EXPECT_EQ(groups[0].level, Verdict::attention);
  EXPECT_EQ(groups[2].level, Verdict::good);
  EXPECT_EQ(groups[1].items[0].subject, "half");
  EXPECT_EQ(groups[1].items[0].text,
            "half: missing in 50 of 100 frames (50.0 %), 1 gap, the longest 1.000 s from 1.400 s");
  EXPECT_DOUBLE_EQ(groups[1].items[0].time_s, 1.4);
}

TEST(MarkersReport, TwoOfAKindAreOneGroup) {
  data::Trial trial;
  auto& t = trial.markers = data::Trajectories::all_missing(
      {"half", "half too", "never", "nor this", "made", "made too", "out", "out too", "*9", "*10"},
      {.rate_hz = 50.0, .t0_s = 0.0, .frames = 100});
  for (std::int64_t f = 0; f < 100; ++f)
    for (const std::int64_t m : {0, 1, 4, 5, 6, 7, 8, 9}) {
      if (m < 2 && f >= 20 && f < 70) continue;
      t.x(f, m).setConstant(0.01 * static_cast<double>(f));
      t.state[t.index(f, m)] =
          (m == 4 || m == 5) && f < 10 ? SampleState::model_filled : SampleState::measured;
    }
  for (const std::int64_t m : {6, 7}) t.set_missing(50, m, SampleState::rejected);
  trial.warnings = {"the header lies", "so does its end"};
  EXPECT_THAT(
      titles(markers_notices({.recording = &trial})),
      ::testing::ElementsAre("2 markers in no frame", "2 markers missing in more than a fifth of the frames",
                             "2 markers partly missing", "2 markers with rejected samples",
                             "2 markers with samples that were made", "2 points that nobody named",
                             "2 remarks about the file"));
  t.set_missing(50, 7);
  const auto groups = markers_notices({.recording = &trial});
  EXPECT_EQ(groups[3].title, "1 marker with rejected samples");
  EXPECT_EQ(groups[3].items[0].text, "out: rejected in 1 of 100 frames (1.0 %)");
}

TEST(MarkersReport, OfAWholeRecordingSaysNothing) {
  auto trial = five_markers();
  trial.markers.names[4] = "named";
  for (std::int64_t f = 0; f < 100; ++f)
    for (std::int64_t m = 0; m < 5; ++m) {
      trial.markers.state[trial.markers.index(f, m)] = SampleState::measured;
      trial.markers.x(f, m).setConstant(1.0);
    }
  EXPECT_THAT(markers_notices({.recording = &trial}), IsEmpty());
  EXPECT_EQ(markers_report_json({.recording = &trial})["summary"]["verdict"], "good");
}

TEST(MarkersReport, CountsSamplesByState) {
  const auto trial = five_markers();
  const auto json = markers_report_json({.trial = "walk", .recording = &trial})["summary"];
  EXPECT_EQ(json["schema"], "kinemark.markers_report");
  EXPECT_EQ(json["verdict"], "attention");
  EXPECT_EQ(json["markers"][1]["states"]["missing"], 50);
  EXPECT_EQ(json["markers"][1]["gaps"], 1);
  EXPECT_EQ(json["markers"][1]["longest_gap_s"], 1.0);
  EXPECT_EQ(json["markers"][3]["states"]["interpolated"], 10);
  EXPECT_EQ(json["markers"][4]["labelled"], false);
  EXPECT_TRUE(json["markers"][0]["longest_gap_s"].is_null());
}

TEST(MarkersReport, ListsChannelsAndEvents) {
  auto trial = five_markers();
  trial.channels.names = {"LKneeAngles"};
  trial.channels.kinds = {data::ChannelKind::angle};
  trial.channels.units = {"deg"};
  trial.channels.rate_hz = 50.0;
  trial.analog.names = {"EMG1", "EMG2"};
  trial.analog.units = {"V"};
  trial.analog.rate_hz = 1000.0;
  trial.events = {{"Foot Strike", "Left", 1.25}};
  const auto json = markers_report_json({.recording = &trial})["summary"];
  ASSERT_THAT(json["channels"], SizeIs(3));
  EXPECT_EQ(json["channels"][0]["kind"], "angle");
  EXPECT_EQ(json["channels"][2]["unit"], "");
  EXPECT_EQ(json["events"][0]["time_s"], 1.25);
}

TEST(MarkersReport, TellsTheCyclesOfEachFoot) {
  const auto trial = five_markers();
  EXPECT_TRUE(markers_report_json({.recording = &trial})["summary"]["cycles"].is_null());
  const auto json =
      markers_report_json({.recording = &trial,
                           .cycles = {{.side = data::Side::right, .start_s = 1.1, .end_s = 2.2},
                                      {.side = data::Side::right, .start_s = 2.2, .end_s = 2.9}}});
  EXPECT_EQ(json["summary"]["cycles"],
            nlohmann::ordered_json::parse(R"({"Left": [], "Right": [[1.1, 2.2], [2.2, 2.9]]})"));
}

TEST(MarkersReport, AnUnknownRateIsAFinding) {
  const auto trial = five_markers();
  const auto groups = markers_notices({.recording = &trial, .rate_known = false});
  EXPECT_EQ(groups.front().title, "1 frame rate that is not known");
  EXPECT_EQ(groups.front().items.front().text,
            "The file tells no frame rate: frames are counted at 1 Hz. Give one with --rate.");
  EXPECT_THAT(titles(markers_notices({.recording = &trial})),
              Not(Contains("1 frame rate that is not known")));
}

TEST(MarkersReport, HostileNamesStayText) {
  auto trial = five_markers();
  trial.markers.names[0] = "</script><img src=x onerror=alert(1)>";
  trial.events = {{"<b>", "\"", 0.0}};
  const auto html = markers_report_html({.trial = "<!--", .recording = &trial});
  EXPECT_EQ(html.find("<img src=x"), std::string::npos);
  EXPECT_EQ(html.find("<!--</h1>"), std::string::npos);
  EXPECT_NE(html.find("\\u003cimg src=x"), std::string::npos);
}

TEST(MarkersReport, OfNothingIsAPageThatSaysSo) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({}, {.rate_hz = 1.0, .t0_s = 0.0, .frames = 0});
  const auto groups = markers_notices({.recording = &trial});
  ASSERT_THAT(groups, SizeIs(1));
  EXPECT_THAT(groups[0].items[0].text, HasSubstr("The file holds 0 markers and 0 frames."));
  EXPECT_THAT(markers_report_html({.recording = &trial}), HasSubstr("kinemark.markers_report"));
}

TEST(MarkersReport, PagesStaySmall) {
  data::Trial trial;
  for (const auto& [frames, most] : {std::pair{2000, 1'500'000U}, std::pair{100'000, 3'000'000U}}) {
    std::vector<std::string> names;
    for (int m = 0; m < 60; ++m) names.push_back("M" + std::to_string(m));
    auto& t = trial.markers =
        data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
    std::uint64_t noise = 1;
    for (std::size_t i = 0; i < t.state.size(); ++i) {
      t.state[i] = SampleState::measured;
      for (std::size_t k = 0; k < 3; ++k) {
        noise = noise * 6364136223846793005U + 1442695040888963407U;
        t.x_in_world[3 * i + k] =
            std::sin(0.001 * static_cast<double>(i)) + 1e-3 * static_cast<double>(noise >> 44) / 1048576.0;
      }
    }
    EXPECT_LT(markers_report_html({.recording = &trial}).size(), most) << frames;
  }
}

}  // namespace
}  // namespace kinemark::report
