// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/gait_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "kinemark/io/file.h"
#include "kinemark/io/text/tidy_csv.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class GaitDrawingTest : public ::testing::Test {
 protected:
  GaitDrawingTest() {
    trial_.markers = walk_.markers(0.0005, 3);
    job_.refits = 0;
    job_.figures = scratch_ / "figures";
    job_.figure_formats = "svg";
  }

  // Two angles of each side that follow the phase of its stride, 30 + 20 sin and 10 cos.
  [[nodiscard]] std::vector<SheetInput> angles(const analysis::Gait& gait) const {
    std::vector<SheetInput> out;
    for (const auto side : data::kBothSides)
      for (const bool knee : {true, false}) {
        analysis::CycleSeries one{.id = std::string(knee ? "knee_flexion" : "hip_flexion") +
                                        (side == data::Side::left ? "_l" : "_r")};
        for (std::int64_t f = 0; f < trial_.markers.frames(); ++f) {
          const double t = trial_.markers.time.time_s(f);
          const double phase = 2.0 * std::numbers::pi * (t - walk_.strike_s(side, 0)) / walk_.stride_s;
          one.time_s.push_back(t);
          one.values.push_back(knee ? 0.5 + 0.3 * std::sin(phase) : 0.2 * std::cos(phase));
          one.sd.push_back(0.01);
        }
        add_series(one, gait.cycles, "", out);
      }
    return out;
  }

  Status draw(JobOutcome& outcome) {
    auto staging = Staging::create({}, job_, {}).value();
    auto drawing = GaitDrawing::begin(job_, staging);
    if (!drawing) return std::unexpected(drawing.error());
    if (auto s = drawing->find_walking({.trial = trial_}); !s) return s;
    const auto inputs = angles(*drawing->gait());
    std::vector<data::CycleCurves> curves;
    for (const auto& one : inputs) curves.push_back(one.curves);
    const auto files =
        drawing->draw("walk.trc", trial_, curves, inputs, {.angles_from = "a test"}, staging, outcome);
    if (!files) return std::unexpected(files.error());
    auto written = write_results(staging, *files, {}, "walking");
    if (!written) return std::unexpected(written.error());
    outcome.written = std::move(*written);
    return {};
  }

  [[nodiscard]] std::string text_of(const std::string& name) const {
    const auto text = io::read_text(scratch_ / name);
    return text ? *text : std::string();
  }

  testing_support::ScratchFolder scratch_;
  analysis::testing::KnownWalk walk_;
  data::Trial trial_;
  GaitDrawingJob job_;
};

TEST_F(GaitDrawingTest, WritesWhatIsAskedFor) {
  job_.report = scratch_ / "gait.html";
  job_.gait.write_cycles = scratch_ / "cycles.csv";
  job_.gait.write_events = scratch_ / "events.csv";
  JobOutcome outcome;
  const auto status = draw(outcome);
  ASSERT_TRUE(status) << status.error().message;
  for (const char* name :
       {"gait.html", "cycles.csv", "events.csv", "figures/gait_kinematics.svg",
        "figures/gait_hip_flexion_knee_flexion.svg", "figures/gait_curves.csv", "figures/gait_pairs.csv"}) {
    EXPECT_THAT(outcome.written, Contains(scratch_ / name));
    EXPECT_FALSE(text_of(name).empty()) << name;
  }
  EXPECT_THAT(text_of("gait.html"), HasSubstr("\"angles_from\":\"a test\""));
  EXPECT_THAT(text_of("events.csv"), HasSubstr("walk.trc,,,walk,,Left,,Foot Strike"));
}

TEST_F(GaitDrawingTest, TheDrawnMeanIsTheCurveThatWasPutIn) {
  JobOutcome outcome;
  ASSERT_TRUE(draw(outcome));
  const auto table = io::read_tidy_csv(scratch_ / "figures/gait_curves.csv");
  ASSERT_TRUE(table);
  std::int64_t means = 0;
  for (std::int64_t r = 0; r < table->rows(); ++r) {
    if ((*table)(r, table->find("cycle")) != "mean" || (*table)(r, table->find("quantity")) != "knee_flexion")
      continue;
    ++means;
    const double percent = table->number(r, table->find("percent")).value();
    // Strikes are found within some milliseconds, of a stride of 1.08 s.
    EXPECT_NEAR(table->number(r, table->find("value")).value(),
                57.29578 * (0.5 + 0.3 * std::sin(2.0 * std::numbers::pi * percent / 100.0)), 3.0);
    EXPECT_NEAR(table->number(r, table->find("own_sd")).value(), 0.5729578, 1e-6);
  }
  EXPECT_EQ(means, 2 * 101);
}

TEST_F(GaitDrawingTest, EventsGoIntoACopyOfTheRecording) {
  job_.figures.clear();
  job_.gait.write_events = scratch_ / "events.c3d";
  JobOutcome outcome;
  const auto status = draw(outcome);
  ASSERT_TRUE(status) << status.error().message;
  EXPECT_EQ(outcome.written.size(), 1u);
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "events.c3d"));
}

TEST_F(GaitDrawingTest, WhatCannotWorkIsReportedBeforeAnything) {
  auto staging = Staging::create({}, job_, {}).value();
  job_.figure_formats = "pdf";
  EXPECT_EQ(GaitDrawing::begin(job_, staging).error().code, Code::usage);
  job_.figure_formats = "svg";
  job_.gait.sheet.norms = {scratch_ / "none.csv"};
  EXPECT_EQ(GaitDrawing::begin(job_, staging).error().code, Code::io);
  job_.gait.sheet.norms.clear();
  job_.gait.sheet.angle_angle = {"hip"};
  EXPECT_EQ(GaitDrawing::begin(job_, staging).error().code, Code::usage);
  job_.gait.sheet.angle_angle.clear();
  job_.report = scratch_ / "gait.pdf";
  EXPECT_EQ(GaitDrawing::begin(job_, staging).error().code, Code::usage);
}

TEST_F(GaitDrawingTest, ALevelThatIsNoneIsRefused) {
  auto staging = Staging::create({}, job_, {}).value();
  for (const double level : {0.5, 1.0, 2.0}) {
    job_.level = level;
    const auto begun = GaitDrawing::begin(job_, staging);
    ASSERT_FALSE(begun);
    EXPECT_EQ(begun.error().code, Code::usage);
    EXPECT_THAT(begun.error().message, HasSubstr("need one above 0.5 and at most 0.9999"));
  }
  job_.level = 0.95;
  job_.refits = 20;  // too few for an interval
  EXPECT_THAT(GaitDrawing::begin(job_, staging).error().message,
              HasSubstr("need 0 (no intervals) or at least 39"));
}

TEST_F(GaitDrawingTest, WhoDoesNotWalkIsNotDrawn) {
  auto still = trial_.markers;
  for (std::int64_t f = 0; f < still.frames(); ++f)
    for (std::int64_t m = 0; m < still.markers(); ++m) still.x(f, m) = trial_.markers.x(0, m);
  trial_.markers = still;
  JobOutcome outcome;
  const auto status = draw(outcome);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::bad_input);
  EXPECT_FALSE(std::filesystem::exists(job_.figures));
}

TEST_F(GaitDrawingTest, AFigureThatCannotBeWrittenTakesPageAndTablesWithIt) {
  std::filesystem::create_directory(job_.figures);
  ASSERT_TRUE(io::write_text(job_.figures / "gait_pairs.csv", "mine", false));
  job_.report = scratch_ / "gait.html";
  job_.gait.write_cycles = scratch_ / "cycles.csv";
  JobOutcome outcome;
  const auto status = draw(outcome);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("gait_pairs.csv: exists already"));
  EXPECT_EQ(scratch_.count_files(), 1);
}

TEST_F(GaitDrawingTest, NormsAreRead) {
  std::ofstream(scratch_ / "norm.csv") << "curve,percent,low,high,unit,source\nknee_flexion,0,10,50,deg,Ten "
                                          "people\nknee_flexion,100,10,50,deg,Ten people\n";
  job_.gait.sheet.norms = {scratch_ / "norm.csv"};
  JobOutcome outcome;
  ASSERT_TRUE(draw(outcome));
  EXPECT_THAT(text_of("figures/gait_kinematics.svg"), HasSubstr("Norm: Ten people (band as in the file)."));
}

TEST_F(GaitDrawingTest, AsksForNothingUnlessReportedTo) {
  EXPECT_FALSE(GaitDrawingJob{}.wanted());
  EXPECT_TRUE(job_.wanted());
  GaitDrawingJob cycles;
  cycles.gait.write_cycles = "c.csv";
  EXPECT_TRUE(cycles.wanted());
}

TEST(GaitRequest, NormsAndPairsNeedADrawing) {
  GaitRequest request;
  request.sheet.norms = {"norm.csv"};
  EXPECT_TRUE(request.wanted());
  EXPECT_THAT(request.check().error().message, HasSubstr("--norm is drawn"));
  EXPECT_TRUE(request.check(true));
  request = {};
  request.sheet.angle_angle = {"a:b"};
  EXPECT_THAT(request.check().error().message, HasSubstr("--angle-angle is drawn"));
  request = {};
  request.angles = "Q.mot";
  EXPECT_FALSE(request.check());
  EXPECT_TRUE(request.check(true));
}

}  // namespace
}  // namespace kinemark::pipeline
