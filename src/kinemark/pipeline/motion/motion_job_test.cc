// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/motion_job.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MotionRun, AsksForTheFirstFileThatIsNotNamed) {
  MotionJob job;
  EXPECT_EQ(internal::check_named(job).error().message, "no model; give --model");
  job.model = "m.osim";
  EXPECT_EQ(internal::check_named(job, " or else").error().message, "no marker file; give --markers or else");
  job.markers = "m.c3d";
  EXPECT_TRUE(internal::check_named(job));
  EXPECT_EQ(internal::check_output_named(job).error().message, "no output; give --output");
  EXPECT_EQ(internal::check_output_named(job).error().code, Code::usage);
  job.output = "q.mot";
  EXPECT_TRUE(internal::check_output_named(job));
}

TEST(MotionRun, AModelWithoutMarkersIsRefusedBeforeTheRecordingIsRead) {
  const testing_support::ScratchFolder folder;
  auto bare = human_model().value();
  bare.markers.clear();
  ASSERT_TRUE(io::write_osim(folder / "bare.osim", bare));
  MotionJob job;
  job.model = folder / "bare.osim";
  job.markers = folder / "none.c3d";
  EXPECT_THAT(internal::read_inputs(job).error().message, HasSubstr("has no markers; need at least one"));
}

TEST(MotionRun, WhatAVerbFoundJoinsTheRunOnce) {
  report::IkRun run;
  run.warnings = {"first"};
  workflow::Remarks remarks{.warnings = {"second"}, .gates = {{.name = "g", .passed = true}}};
  internal::add_found(run, {.markers = {{.name = "A"}}, .warnings = {"second"}},
                      {.facts = {{"force", "on foot"}}}, remarks);
  EXPECT_THAT(run.warnings, ElementsAre("first", "second"));
  EXPECT_THAT(run.options, ElementsAre(std::pair<std::string, std::string>{"force", "on foot"}));
  EXPECT_EQ(run.gates.size(), 1U);
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_THAT(run.fit.warnings, IsEmpty());
  EXPECT_EQ(run.fit.markers.at(0).name, "A");
  remarks.gates[0].passed = false;
  internal::add_found(run, {}, {}, remarks);
  EXPECT_EQ(run.exit_status, 1);
}

TEST(MotionRun, WhatExistsIsRefusedEvenIfItMightNotBeWritten) {
  const testing_support::ScratchFolder folder;
  ASSERT_TRUE(io::write_text(folder / "Q_sd.sto", "old", false));
  MotionJob job;
  job.output = folder / "Q.mot";
  EXPECT_EQ(internal::stage(job, {"_sd.sto"}).error().code, Code::io);
  job.force = true;
  EXPECT_TRUE(internal::stage(job, {"_sd.sto"}));
}

data::JointMotion one_angle() {
  data::JointMotion motion;
  motion.coordinates = {"knee"};
  motion.is_rotation = {true};
  motion.markers = {"A"};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 2};
  motion.q.assign({0.5, 0.6});
  motion.determined.assign({1, 1});
  motion.marker_error.assign({0.003, 0.004, 0.0, 0.0, 0.0, 0.0});
  motion.status.assign(2, data::FrameStatus::converged);
  return motion;
}

TEST(MotionRun, JudgingFillsTheOutcomeFromTheRun) {
  report::IkRun run;
  run.warnings = {"odd"};
  internal::add_found(run, {}, {}, {.gates = {{.name = "g", .passed = false, .value = 2.0, .bound = 1.0}}});
  MotionOutcome outcome;
  const auto motion = one_angle();
  ASSERT_TRUE(internal::judge(run, motion, nullptr, outcome));
  EXPECT_THAT(outcome.warnings, ElementsAre("odd"));
  ASSERT_EQ(outcome.gates.size(), 1U);
  EXPECT_EQ(outcome.exit_status(), 1);
  EXPECT_EQ(outcome.summary.time.frames, 2);
}

TEST(MotionRun, FilesAreThoseOfWhatTheMotionHolds) {
  MotionJob job;
  job.output = "a/Q.mot";
  auto motion = one_angle();
  const auto names = [&] {
    std::vector<std::string> list;
    for (const auto& file : internal::motion_files(job, motion, {})) list.push_back(file.target.string());
    return list;
  };
  EXPECT_THAT(names(), ElementsAre("a/Q.mot", "a/Q_marker_errors.sto", "a/Q_report.json"));
  motion.q_sd.assign({0.1, 0.1});
  motion.tau.assign({1.0, 2.0});
  EXPECT_THAT(names(), ElementsAre("a/Q.mot", "a/Q_sd.sto", "a/Q_tau.sto", "a/Q_marker_errors.sto",
                                   "a/Q_report.json"));
}

TEST(MotionRun, StoppedInTheLastMomentNothingAppears) {
  const testing_support::ScratchFolder folder;
  MotionJob job;
  job.output = folder / "Q.mot";
  std::int64_t reported = -1;
  job.progress = [&](std::int64_t done, std::int64_t total) {
    reported = done == total ? total : -1;
    return false;
  };
  const auto motion = one_angle();
  MotionOutcome outcome;
  ASSERT_TRUE(internal::judge({}, motion, nullptr, outcome));
  {
    auto staging = internal::stage(job, {"_marker_errors.sto", "_report.json"}).value();
    const auto stopped = internal::write(job, staging, internal::motion_files(job, motion, outcome.summary),
                                         "the work", motion, outcome);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, Code::cancelled);
    EXPECT_EQ(stopped.error().message, "the work was stopped");
  }
  EXPECT_EQ(reported, 2) << "all frames are done by then";
  EXPECT_THAT(outcome.written, IsEmpty());
  EXPECT_EQ(folder.count_files(), 0);
  job.progress = {};
  auto staging = internal::stage(job, {"_marker_errors.sto", "_report.json", "_sd.sto"}).value();
  ASSERT_TRUE(internal::write(job, staging, internal::motion_files(job, motion, outcome.summary), "the work",
                              motion, outcome));
  EXPECT_EQ(outcome.written.size(), 3U) << "the deviations were not there to write";
  EXPECT_EQ(folder.count_files(), 3);
}

}  // namespace
}  // namespace kinemark::pipeline
