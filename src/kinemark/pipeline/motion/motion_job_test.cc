// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/motion_job.h"

#include <gmock/gmock.h>

#include <limits>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

TEST(Beside, KeepsFolderAndStem) {
  EXPECT_EQ(beside("a/b/Q.mot", "_sd.sto"), fs::path("a/b/Q_sd.sto"));
  EXPECT_EQ(beside("Q.v2.mot", "_x"), fs::path("Q.v2_x"));
}

TEST(MotionRun, AsksForTheFirstFileThatIsNotNamed) {
  MotionJob job;
  EXPECT_EQ(internal::check_named(job).error().message, "no model; give --model");
  job.model = "m.osim";
  EXPECT_EQ(internal::check_named(job, " or else").error().message, "no marker file; give --markers or else");
  job.markers = "m.c3d";
  EXPECT_EQ(internal::check_named(job).error().code, Code::usage);
  job.output = "q.mot";
  EXPECT_TRUE(internal::check_named(job));
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

TEST(MotionRun, AGateFailsAboveItsBoundAndOnWhatIsNotANumber) {
  for (const auto& [value, passes] : {std::pair{1.0, true}, {1.0 + 1e-12, false}, {-1.0, true}}) {
    report::IkRun run;
    internal::add_gate(run, "g", value, 1.0, "mm", "text");
    EXPECT_EQ(run.gates.at(0).passed, passes) << value;
    EXPECT_EQ(run.exit_status, passes ? 0 : 1);
  }
  report::IkRun run;
  internal::add_marker_gates(run, {}, 0.0, "no offset", std::numeric_limits<double>::quiet_NaN());
  internal::add_gate(run, "later", 0.0, 1.0, "mm", "");
  EXPECT_TRUE(run.gates.at(0).passed);
  EXPECT_FALSE(run.gates.at(1).passed);
  EXPECT_EQ(run.exit_status, 1) << "a gate that passes later does not take back a failure";
}

TEST(MotionRun, WarningsOfTheFitJoinThoseOfTheRunOnce) {
  report::IkRun run;
  run.warnings = {"first"};
  internal::add_fit(run,
                    {.markers = {{.name = "A"}},
                     .warnings = {"second"},
                     .findings = {{.kind = data::FindingKind::flagged, .size = 3}}},
                    {.rate_hz = 100.0, .frames = 8});
  EXPECT_THAT(run.warnings, ElementsAre("first", "second", "3 of 8 frames are flagged"));
  EXPECT_THAT(run.fit.warnings, IsEmpty());
  EXPECT_EQ(run.fit.markers.at(0).name, "A");
}

class MotionFiles : public ::testing::Test {
 protected:
  MotionJob job_of(const char* output) const {
    MotionJob job;
    job.output = folder_ / output;
    return job;
  }
  testing_support::ScratchFolder folder_;
};

TEST_F(MotionFiles, OnlyWhatWasPutAppearsAndIsTold) {
  const auto job = job_of("Q.mot");
  auto staging = internal::stage(job, {"_a.txt", "_b.txt"}, {folder_ / "page.html"}).value();
  ASSERT_TRUE(internal::put(staging, beside(job.output, "_b.txt"), std::string("b")));
  ASSERT_TRUE(internal::put(staging, folder_ / "page.html", std::string("page")));
  EXPECT_FALSE(fs::exists(folder_ / "Q_b.txt")) << "not before the end";
  MotionOutcome outcome;
  ASSERT_TRUE(internal::reveal(staging, {}, "work", outcome));
  EXPECT_THAT(outcome.written, ElementsAre(folder_ / "Q_b.txt", folder_ / "page.html"));
  EXPECT_EQ(io::read_text(folder_ / "Q_b.txt").value(), "b");
  EXPECT_FALSE(fs::exists(folder_ / "Q_a.txt"));
}

TEST_F(MotionFiles, WhatExistsIsRefusedEvenIfItMightNotBeWritten) {
  ASSERT_TRUE(io::write_text(folder_ / "Q_sd.sto", "old", false));
  auto job = job_of("Q.mot");
  EXPECT_EQ(internal::stage(job, {"_sd.sto"}).error().code, Code::io);
  job.force = true;
  EXPECT_TRUE(internal::stage(job, {"_sd.sto"}));
}

TEST_F(MotionFiles, StoppedInTheLastMomentNothingAppears) {
  const auto job = job_of("Q.mot");
  {
    auto staging = internal::stage(job, {}).value();
    ASSERT_TRUE(internal::put(staging, job.output, std::string("q")));
    MotionOutcome outcome;
    const auto stopped =
        internal::reveal(staging, [](std::int64_t, std::int64_t) { return false; }, "the work", outcome);
    EXPECT_EQ(stopped.error().code, Code::cancelled);
    EXPECT_EQ(stopped.error().message, "the work was stopped");
    EXPECT_THAT(outcome.written, IsEmpty());
  }
  EXPECT_TRUE(fs::is_empty(folder_ / ""));
}

}  // namespace
}  // namespace kinemark::pipeline
