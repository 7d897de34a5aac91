// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/markers_page.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/report_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class MarkersPage : public testing::RecordedTest<IkJob> {
 protected:
  static nlohmann::json data_of(const std::string& html) {
    const std::string begin = "id=\"kinemark-data\">";
    const auto first = html.find(begin) + begin.size();
    return nlohmann::json::parse(html.substr(first, html.find("</script>", first) - first));
  }
};

/// Markers on a line of this length along one axis.
data::Trial line(const Eigen::Vector3d& along) {
  data::Trial trial;
  auto& t = trial.markers = data::Trajectories::all_missing({"a", "b", "c", "d", "e", "f"},
                                                            {.rate_hz = 10.0, .t0_s = 0.0, .frames = 20});
  for (std::int64_t f = 0; f < 20; ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      t.state[t.index(f, m)] = data::SampleState::measured;
      t.x(f, m) =
          static_cast<double>(m) / 5.0 * along + 0.1 * Eigen::Vector3d::Constant(static_cast<double>(m % 2));
    }
  return trial;
}

TEST_F(MarkersPage, IsAPageOfAnyMarkerFile) {
  const auto page = markers_page(at("in/markers.c3d"), {.command_line = "kinemark report"});
  ASSERT_TRUE(page) << page.error().message;
  const auto data = data_of(*page);
  const auto trial = io::read_marker_input({.path = at("in/markers.c3d")}).value().trial;
  EXPECT_EQ(data["summary"]["schema"], "kinemark.markers_report");
  EXPECT_EQ(data["summary"]["trial"], "markers.c3d");
  EXPECT_EQ(data["summary"]["command_line"], "kinemark report");
  EXPECT_EQ(data["summary"]["frames"], trial.markers.frames());
  EXPECT_EQ(data["summary"]["markers"].size(), trial.markers.names.size());
  EXPECT_EQ(data["summary"]["inputs"][0]["hash_kind"], "XXH3-64");
  ASSERT_TRUE(io::write_trc(at("other.trc"), trial, {}));
  EXPECT_EQ(data_of(page_of(at("other.trc")).value())["summary"]["format"], "TRC")
      << "page_of() takes the same";
  EXPECT_EQ(page_of(at("in/markers.c3d")).value(), page_of(at("in/markers.c3d")).value());
}

TEST_F(MarkersPage, TheContentDecidesNotTheName) {
  fs::copy_file(at("in/markers.c3d"), at("renamed.dat"));
  EXPECT_EQ(data_of(page_of(at("renamed.dat")).value())["summary"]["format"], "C3D");
}

TEST_F(MarkersPage, ReportWritesThePageAndRefusesWhatItCannotRead) {
  ReportJob job;
  job.input = at("in/markers.c3d");
  job.page = at("page.html");
  ASSERT_TRUE(run_report(job));
  EXPECT_THAT(io::read_text(at("page.html")).value(), HasSubstr("kinemark.markers_report"));
  EXPECT_EQ(run_report(job).error().code, Code::io) << "exists already";
  job.page = at("in/markers.c3d");
  job.force = true;
  EXPECT_FALSE(run_report(job)) << "would overwrite its own input";
  job.page = at("none.html");
  job.input = at("nothing.c3d");
  EXPECT_EQ(run_report(job).error().code, Code::io);
  ASSERT_TRUE(io::write_text(at("torn.c3d"), "\x02\x50 torn", false));
  job.input = at("torn.c3d");
  EXPECT_EQ(run_report(job).error().code, Code::bad_input);
  EXPECT_FALSE(fs::exists(at("none.html")));
}

TEST_F(MarkersPage, OptionsAreChecked) {
  EXPECT_EQ(page_of(at("in/markers.c3d"), {.recording = {.axes = {.up = "w"}}}).error().code, Code::usage);
  EXPECT_EQ(page_of(at("in/markers.c3d"), {.recording = {.rate_hz = -1.0}}).error().code, Code::usage);
  EXPECT_EQ(page_of(at("R.mot"), {.recording = {.axes = {.up = "y"}}}).error().code, Code::usage)
      << "not of joint angles";
  const auto data = data_of(page_of(at("in/markers.c3d"), {.recording = {.axes = {.up = "-x"}}}).value());
  EXPECT_EQ(data["scene"]["up"][0], -1.0);
  EXPECT_EQ(data["scene"]["up_from"], "--up");
}

TEST(VerticalWithoutModel, IsTheAxisAlongWhichABodyStands) {
  EXPECT_TRUE(vertical_without_model(line({0.2, 1.6, 0.3})).up.isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(vertical_without_model(line({0.2, 0.4, 1.6})).up.isApprox(Eigen::Vector3d::UnitZ()));
  const auto unsure = vertical_without_model(line({0.9, 0.9, 0.1}));
  EXPECT_TRUE(unsure.up.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(unsure.from, "") << "nobody says so";
  EXPECT_EQ(vertical_without_model(line({0.0, 0.5, 0.1})).from, "") << "too short for a body";
}

TEST(VerticalWithoutModel, PlatesComeFirst) {
  auto trial = line({0.2, 1.6, 0.3});
  auto& plate = trial.force_plates.emplace_back();
  plate.corners_in_world = {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, -1), Eigen::Vector3d(1, 1, -1),
                            Eigen::Vector3d(0, 1, -1)};
  EXPECT_EQ(vertical_without_model(trial).from, "the force plates");
  EXPECT_TRUE(vertical_without_model(trial).up.isApprox(Eigen::Vector3d::UnitZ()));
}

}  // namespace
}  // namespace kinemark::pipeline
