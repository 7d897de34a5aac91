// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/many_measures_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

// Two participants, two sessions: RFIN goes around an ellipse.
class ManyMeasuresTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::uint64_t seed = 1;
    for (const char* who : {"sub-01", "sub-02"})
      for (const char* when : {"ses-1", "ses-2"}) {
        const auto path = folder_ / who / when / (std::string(who) + "_" + when + "_task-circle.c3d");
        std::filesystem::create_directories(path.parent_path());
        data::Trial trial;
        trial.markers = analysis::testing::recording_of(
            analysis::testing::sampled(300, 100.0, analysis::testing::ellipse), 100.0, 5e-4, seed++);
        trial.markers.names = {"RFIN"};
        ASSERT_TRUE(io::write_markers(path, trial, false));
        files_.push_back(path);
      }
    ASSERT_TRUE(io::write_text(folder_ / "participants.tsv",
                               "participant_id\tage\tgroup\nsub-01\t34\told\nsub-02\t21\tyoung\n", false));
    job_.inputs = {folder_};
    job_.measures = {"peak_speed", "cycle_time"};
    job_.refits = 39;
  }

  // Lines of the table that a recording has alone, without their columns' names.
  std::string alone(const std::filesystem::path& path, const std::string& ending) {
    MeasuresJob one = job_;
    one.input = path;
    one.participants_file = folder_ / "participants.tsv";
    for (auto* target : {&one.output, &one.gait.write_cycles, &one.gait.write_events}) target->clear();
    const auto to = scratch_ / ("alone" + ending + path.filename().string() + ".csv");
    (ending == "cycles"   ? one.gait.write_cycles
     : ending == "events" ? one.gait.write_events
                          : one.output) = to;
    const auto outcome = run_measures(one);
    EXPECT_TRUE(outcome) << outcome.error().message;
    const auto text = io::read_text(to).value();
    return text.substr(text.find('\n') + 1);
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_ / "set";
  std::vector<std::filesystem::path> files_;
  ManyMeasuresJob job_;
};

TEST_F(ManyMeasuresTest, TheLinesOfEachRecordingAreThoseOfItsOwnRun) {
  job_.output = scratch_ / "all.csv";
  job_.gait.write_cycles = scratch_ / "cycles.csv";
  job_.gait.write_events = scratch_ / "events.csv";
  job_.jobs = 2;
  const auto outcome = run_many_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_THAT(outcome->written, SizeIs(3));
  EXPECT_THAT(outcome->notes, ::testing::Contains(HasSubstr("participants.tsv: is joined to the rows")));
  std::string measures, cycles, events;
  for (const auto& file : files_) {
    measures += alone(file, "");
    cycles += alone(file, "cycles");
    events += alone(file, "events");
  }
  const auto rows = [](const std::filesystem::path& path) {
    const auto text = io::read_text(path).value();
    return text.substr(text.find('\n') + 1);
  };
  EXPECT_EQ(rows(job_.output), measures);
  EXPECT_EQ(rows(job_.gait.write_cycles), cycles);
  EXPECT_EQ(rows(job_.gait.write_events), events);
  EXPECT_THAT(measures, HasSubstr("sub-02_ses-1_task-circle.c3d,sub-02,ses-1,task-circle,RFIN,"));
  EXPECT_THAT(measures, HasSubstr(",21,young\n"));
}

TEST_F(ManyMeasuresTest, ATableThatIsGivenIsNotFoundBesideThem) {
  job_.output = scratch_ / "all.csv";
  job_.participants_file = folder_ / "participants.tsv";
  const auto outcome = run_many_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->notes, Not(Contains(HasSubstr(": is joined to the rows"))));
}

TEST_F(ManyMeasuresTest, OneBadFileLeavesTheOthers) {
  ASSERT_TRUE(io::write_text(folder_ / "sub-01/ses-1/broken.c3d", "no C3D", false));
  job_.output = scratch_ / "all.json";
  const auto outcome = run_many_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 3);
  EXPECT_THAT(outcome->recordings, SizeIs(4));
  const auto json = nlohmann::json::parse(io::read_text(job_.output).value());
  EXPECT_THAT(json["recordings"], SizeIs(4));
  ASSERT_THAT(json["failed"], SizeIs(1));
  EXPECT_THAT(json["failed"][0]["error"].get<std::string>(), HasSubstr("broken.c3d"));
  EXPECT_EQ(json["recordings"][3]["participant"].get<std::string>(), "sub-02");
  EXPECT_EQ(json["recordings"][3]["more"]["group"].get<std::string>(), "young");
}

TEST_F(ManyMeasuresTest, WhereAllFailNothingIsWritten) {
  job_.inputs = {scratch_ / "a.c3d", scratch_ / "b.c3d"};
  job_.output = scratch_ / "all.csv";
  const auto outcome = run_many_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 4);
  EXPECT_FALSE(std::filesystem::exists(job_.output));
}

TEST_F(ManyMeasuresTest, TablesOfNwbHoldAllRecordings) {
  job_.output = scratch_ / "all.nwb";
  const auto outcome = run_many_measures(job_);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GT(std::filesystem::file_size(job_.output), 10'000u);
}

TEST_F(ManyMeasuresTest, WhatIsOfOneRecordingAloneIsRefused) {
  const auto says = [this](const auto& change) {
    auto job = job_;
    change(job);
    const auto outcome = run_many_measures(job);
    return outcome ? std::string("no failure") : outcome.error().message;
  };
  EXPECT_THAT(says([](auto& job) { job.figures = "f"; }), HasSubstr("--figures f: is made of one recording"));
  EXPECT_THAT(says([](auto& job) { job.report = "p.html"; }), HasSubstr("--report"));
  EXPECT_THAT(says([](auto& job) { job.gait.write_events = "e.c3d"; }), HasSubstr("--write-events e.c3d"));
  EXPECT_THAT(says([](auto& job) { job.edits = "walk.json"; }), HasSubstr("need 'beside'"));
  EXPECT_THAT(says([](auto& job) { job.output = "m.xlsx"; }), HasSubstr(".csv, .json or .nwb"));
  EXPECT_THAT(says([](auto& job) { job.participants_file = "none.tsv"; }), HasSubstr("none.tsv"));
  EXPECT_THAT(says([](auto& job) { job.measures = {"peek_speed"}; }), HasSubstr("nearest: peak_speed"));
}

}  // namespace
}  // namespace kinemark::pipeline
