// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/motion_job.h"

#include <gmock/gmock.h>

#include <limits>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/pipeline/motion/internal/motion_page.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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

TEST(MotionRun, AFewBadFramesOfManyDoNotFailATrial) {
  struct Case {
    std::int64_t bad, all;
    bool passes;
  };
  for (const Case& c : {Case{3, 100'000, true},
                        {1, 1'000, true},
                        {1, 999, false},
                        {101, 100'000, false},
                        {0, 50, true},
                        {0, 0, true}}) {
    report::IkRun run;
    internal::add_frames_gate(run, "not_converged", c.bad, c.all, "did not converge");
    EXPECT_EQ(run.exit_status, c.passes ? 0 : 1) << c.bad << " of " << c.all;
    EXPECT_EQ(run.gates.at(0).unit, "%");
  }
  report::IkRun run;
  internal::add_frames_gate(run, "flagged", 2, 100, "are flagged");
  EXPECT_EQ(run.gates.at(0).value, 2.0);
  EXPECT_EQ(run.gates.at(0).sentence, "2 of 100 frames are flagged; at most 0.1 % are accepted.");
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

TEST(MotionRun, EachGateSaysWhatItCounted) {
  auto motion = one_angle();
  motion.marker_state = {data::SampleState::rejected, data::SampleState::measured};
  report::IkRun run;
  internal::add_left_out_gate(run, motion);
  internal::add_marker_gates(run, {}, 0.0, "no offset", 0.061);
  ASSERT_EQ(run.gates.size(), 3U);
  const auto &left_out = run.gates[0].sentence, &rms = run.gates[2].sentence;
  EXPECT_EQ(left_out, "1 of 2 samples were left out; at most 5 % are accepted.");
  EXPECT_EQ(rms,
            "The RMS distance between measured and model markers is 61.0 mm; at most 50.0 mm is accepted.");
  EXPECT_THAT(left_out, Not(HasSubstr("The RMS distance between measured and model markers is")));
  EXPECT_THAT(rms, Not(AnyOf(HasSubstr("samples were left out; at most"), HasSubstr("% are accepted."))));
  motion.marker_state.clear();
  report::IkRun not_judged;
  internal::add_left_out_gate(not_judged, motion);
  EXPECT_THAT(not_judged.gates, IsEmpty());
}

TEST(MotionRun, MarkersOfAPageAreThoseThatWereSolved) {
  auto recorded =
      data::Trajectories::all_missing({"S:A", "x", "S:B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 6});
  for (std::int64_t f = 0; f < 6; ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      recorded.x(f, m) = Eigen::Vector3d(static_cast<double>(f), static_cast<double>(m), 0.5);
      recorded.state[recorded.index(f, m)] = data::SampleState::measured;
    }
  recorded.set_missing(3, 2);
  auto motion = one_angle();
  motion.markers = {"A", "B"};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.01, .frames = 4};
  motion.marker_state.assign(8, data::SampleState::measured);
  motion.marker_state[6] = data::SampleState::rejected;
  const data::Finding swap{.kind = data::FindingKind::label_swap, .subject = "A", .partner = "B"};
  auto listed = swap, stretch = swap;
  listed.frames = {0, 2};
  listed.first_frame = 0, listed.last_frame = 2;
  stretch.first_frame = 0, stretch.last_frame = 1;
  data::MarkerFit fit{.markers = {{.name = "A", .name_in_data = "S:A"}, {.name = "B", .name_in_data = "S:B"}},
                      .findings = {listed}};
  fit.first_frame = 1;
  const auto markers = internal::solved_markers(recorded, fit, motion);
  EXPECT_EQ(markers.names, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(markers.frames(), 4);
  EXPECT_EQ(markers.x(0, 0).y(), 2.0) << "frame 1 of the recording, B's label";
  EXPECT_EQ(markers.x(0, 1).y(), 0.0);
  EXPECT_EQ(markers.x(1, 0).y(), 0.0) << "as recorded";
  EXPECT_FALSE(markers.present(2, 0)) << "B was not seen there, and A carried its label";
  EXPECT_EQ(markers.x(2, 1).y(), 0.0);
  EXPECT_EQ(markers.state[markers.index(3, 0)], data::SampleState::rejected);
  fit.findings = {stretch};
  const auto other = internal::solved_markers(recorded, fit, motion);
  EXPECT_EQ(other.x(1, 0).y(), 2.0);
  EXPECT_EQ(other.x(3, 1).y(), 2.0) << "behind the span";
  fit.findings[0].partner = "nobody";
  EXPECT_EQ(internal::solved_markers(recorded, fit, motion).x(0, 0).y(), 0.0) << "no such marker";
}

TEST(MotionRun, JudgingFillsTheOutcomeFromTheRun) {
  report::IkRun run;
  run.warnings = {"odd"};
  internal::add_gate(run, "g", 2.0, 1.0, "mm", "too far");
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
