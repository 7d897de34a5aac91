// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_job.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "kinemark/core/text.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

RunOutcome outcome() {
  RunOutcome out;
  out.steps.push_back(
      {.step = {.subject = "S01", .name = "scale", .words = {"scale", "--mass=70"}, .outputs = {"m.osim"}},
       .status = TrialStatus::good,
       .seconds = 2.04});
  out.steps.push_back(
      {.step = {.subject = "S01", .trial = "walk 1", .name = "ik", .words = {"ik", "--markers=walk 1.c3d"}},
       .status = TrialStatus::failed,
       .said = "it's\nbroken",
       .exit_status = 3});
  return out;
}

TEST(RunTable, HasALineForEachStepAndTheTotals) {
  const std::string text = run_table(outcome());
  EXPECT_THAT(text, HasSubstr("S01                 scale  good    2.0  \n"));
  EXPECT_THAT(text, HasSubstr("S01      walk 1     ik     failed       it's"));
  EXPECT_THAT(text, HasSubstr("2 steps: 1 good, 1 failed\n"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 4) << "a line end in a sentence makes no line";
}

TEST(RunTable, JsonHoldsTheSame) {
  const auto json = run_json(outcome());
  EXPECT_EQ(json["exit_status"], 3);
  ASSERT_EQ(json["steps"].size(), 2U);
  EXPECT_TRUE(json["steps"][0]["trial"].is_null());
  EXPECT_EQ(json["steps"][0]["outputs"][0], "m.osim");
  EXPECT_EQ(json["steps"][1]["trial"], "walk 1");
  EXPECT_EQ(json["steps"][1]["status"], "failed");
}

TEST(RunTable, CommandsCanBeTypedInAShell) {
  RunOutcome out = outcome();
  out.steps[0].step.words.push_back("it's");
  EXPECT_EQ(commands_text(out), "kinemark scale --mass=70 'it'\\''s'\nkinemark ik '--markers=walk 1.c3d'\n");
}

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kStudy = R"(
steps = ["scale", "clean", "ik", "report"]
[scale]
model = "human.osim"
[[subject]]
name = "A"
static = "A.c3d"
trials = ["a1.c3d", "a2.c3d"]
[[subject]]
name = "B"
static = "B.c3d"
trials = ["b1.c3d"]
)";

/// A study whose commands only write down what they were asked.
class RunStudy : public ::testing::Test {
 protected:
  RunStudy() {
    put("study.toml", kStudy);
    for (const char* name : {"human.osim", "A.c3d", "B.c3d", "a1.c3d", "a2.c3d", "b1.c3d"}) put(name, name);
  }

  void put(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(io::write_text(scratch_ / name, text, true));
  }

  /// Writes the outputs of a step, unless it is told to fail at one.
  Result<CommandEnd> pretend(const std::vector<std::string>& words, const fs::path& folder) {
    const std::lock_guard lock(mutex_);
    ran_.push_back(words.front());
    EXPECT_THAT(words, ::testing::Contains("--reads=" + (scratch_ / "study.toml").string()));
    const std::string output = output_of(words);
    if (!fails_at_.empty() && output.find(fails_at_) != std::string::npos)
      return CommandEnd{.exit_status = 3, .said = {"note: odd", "kinemark: it is broken"}};
    const fs::path made = folder / output;
    auto asked = words;
    std::erase_if(asked, [](const std::string& word) {
      return word.starts_with("--threads=") || word.starts_with("--reads=");
    });
    const bool is_page = words.front() == "report";
    for (const auto& file :
         {made, is_page ? made : made.parent_path() / (made.stem().string() + "_report.json")})
      if (const auto s = io::write_text(file, "made of " + join(asked), true); !s)
        return std::unexpected(s.error());
    const bool misses = words.front() == misses_;
    return CommandEnd{.exit_status = misses ? 1 : 0,
                      .said = {misses ? "attention: too far" : "note: a gap", "wrote " + output}};
  }

  static std::string output_of(const std::vector<std::string>& words) {
    for (const auto& word : words)
      if (word.starts_with("--output=")) return word.substr(9);
    return words[2];  // clean IN OUT
  }

  Result<RunOutcome> run(bool force = false) {
    ran_.clear();
    RunJob job;
    job.file = scratch_ / "study.toml";
    job.force = force;
    job.keep_going = keep_going_;
    job.jobs = jobs_;
    job.only = only_;
    job.check = check_;
    job.start = [this](const auto& words, const auto& folder) { return pretend(words, folder); };
    return run_study(job);
  }

  static std::map<TrialStatus, int> counts(const RunOutcome& outcome) {
    std::map<TrialStatus, int> out;
    for (const auto& step : outcome.steps) ++out[step.status];
    return out;
  }

  testing_support::ScratchFolder scratch_;
  std::mutex mutex_;
  std::vector<std::string> ran_;
  std::string fails_at_, misses_;
  bool keep_going_ = false;
  int jobs_ = 1;
  std::vector<std::string> only_;
  std::function<Status(const std::vector<std::string>&)> check_;
};

using Counts = std::map<TrialStatus, int>;

TEST_F(RunStudy, DoesEverythingOnceAndNothingTwice) {
  const auto first = run().value();
  EXPECT_EQ(counts(first), (Counts{{TrialStatus::good, 11}}));
  EXPECT_THAT(ran_, ElementsAre("scale", "clean", "ik", "report", "clean", "ik", "report", "scale", "clean",
                                "ik", "report"));
  EXPECT_EQ(first.steps[1].said, "a gap");
  EXPECT_EQ(first.exit_status(), 0);
  const auto second = run().value();
  EXPECT_EQ(counts(second), (Counts{{TrialStatus::there, 11}}));
  EXPECT_THAT(ran_, ElementsAre());
  EXPECT_EQ(counts(run(true).value()), (Counts{{TrialStatus::good, 11}})) << "force does all again";
}

TEST_F(RunStudy, SeveralAtATimeMakeTheSame) {
  jobs_ = 4;
  const auto outcome = run().value();
  EXPECT_EQ(counts(outcome), (Counts{{TrialStatus::good, 11}}));
  jobs_ = 1;
  EXPECT_EQ(counts(run().value()), (Counts{{TrialStatus::there, 11}}));
}

TEST_F(RunStudy, AChangedRecordingIsDoneAgainWithAllThatFollows) {
  ASSERT_TRUE(run());
  put("a2.c3d", "corrected");
  ASSERT_TRUE(run());
  EXPECT_THAT(ran_, ElementsAre("clean")) << "what it made is the same here, so nothing follows";
  put("human.osim", "another model");
  ASSERT_TRUE(run());
  EXPECT_THAT(ran_, ElementsAre("scale", "scale"));
  put("study.toml", std::string(kStudy) + "[subject.ik]\nmax-rms = 3\n");
  ASSERT_TRUE(run());
  EXPECT_THAT(ran_, ElementsAre("ik", "report")) << "options of subject B";
}

TEST_F(RunStudy, AFailureStopsWhatHasNotBegun) {
  fails_at_ = "a1/clean";
  const auto outcome = run().value();
  EXPECT_EQ(counts(outcome),
            (Counts{{TrialStatus::good, 1}, {TrialStatus::failed, 1}, {TrialStatus::not_begun, 9}}));
  EXPECT_EQ(outcome.steps[1].said, "it is broken");
  EXPECT_EQ(outcome.exit_status(), 3);
  fails_at_.clear();
  EXPECT_EQ(counts(run().value()), (Counts{{TrialStatus::there, 1}, {TrialStatus::good, 10}}));
}

TEST_F(RunStudy, KeepGoingLosesOnlyWhatNeedsTheFailedStep) {
  keep_going_ = true;
  for (const int jobs : {1, 3}) {
    jobs_ = jobs;
    fails_at_ = "a1/clean";
    EXPECT_EQ(counts(run(true).value()),
              (Counts{{TrialStatus::good, 8}, {TrialStatus::failed, 1}, {TrialStatus::not_begun, 2}}));
    fails_at_ = "A/model";
    EXPECT_EQ(counts(run(true).value()),
              (Counts{{TrialStatus::good, 6}, {TrialStatus::failed, 1}, {TrialStatus::not_begun, 4}}));
  }
}

TEST_F(RunStudy, AMissedGateGoesOnAndIsNotForgotten) {
  misses_ = "ik";
  const auto first = run().value();
  EXPECT_EQ(counts(first), (Counts{{TrialStatus::good, 8}, {TrialStatus::missed_gate, 3}}));
  EXPECT_EQ(first.exit_status(), 1);
  const auto second = run().value();
  EXPECT_THAT(ran_, ElementsAre());
  EXPECT_EQ(second.exit_status(), 1);
  EXPECT_EQ(second.steps[2].said, "too far");
}

TEST_F(RunStudy, FilesOfOthersAreLeftAlone) {
  ASSERT_TRUE(run());
  put("results/B/model.osim", "corrected by hand");
  const auto outcome = run().value();
  EXPECT_EQ(outcome.exit_status(), 4);
  EXPECT_THAT(outcome.steps[7].said, HasSubstr("was changed since the run made it"));
  EXPECT_EQ(io::read_text(scratch_ / "results/B/model.osim").value(), "corrected by hand");
  EXPECT_EQ(run(true).value().exit_status(), 0);
}

TEST_F(RunStudy, NothingIsWrittenThatLeadsToARecording) {
  ASSERT_TRUE(run());
  for (const auto& entry : fs::directory_iterator(scratch_ / "results/A")) {
    if (!entry.is_regular_file()) continue;
    fs::remove(entry.path());
    fs::create_symlink(scratch_ / "A.c3d", entry.path());
    const auto refused = run(true);
    ASSERT_FALSE(refused) << entry.path();
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message, HasSubstr("is the file that is read as"));
    EXPECT_TRUE(ran_.empty());
    EXPECT_EQ(io::read_text(scratch_ / "A.c3d").value(), "A.c3d");
    fs::remove(entry.path());
  }
}

TEST_F(RunStudy, OneSubjectAlone) {
  only_ = {"B"};
  const auto outcome = run().value();
  EXPECT_EQ(outcome.steps.size(), 4U);
  EXPECT_FALSE(fs::exists(scratch_ / "results/A"));
  only_ = {"C"};
  EXPECT_EQ(run().error().code, Code::usage);
}

TEST_F(RunStudy, AllCommandsAreCheckedBeforeOneRuns) {
  put("study.toml", std::string(kStudy) + "[subject.ik]\nmax-rms = 3\nmax-rsm = 4\n");
  check_ = [](const std::vector<std::string>& words) -> Status {
    for (const auto& word : words)
      if (word.starts_with("--max-rsm")) return fail(Code::usage, "unknown option '--max-rsm=4'");
    return {};
  };
  const auto refused = run();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("line 15: ik of subject 'B': unknown option '--max-rsm=4'"));
  EXPECT_THAT(ran_, ElementsAre());
  EXPECT_FALSE(fs::exists(scratch_ / "results"));
}

TEST_F(RunStudy, TwoRunsInOneFolderAreRefused) {
  fs::create_directories(scratch_ / "results");
  const int other = ::open((scratch_ / "results").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  const auto refused = run();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("another run is at work in it"));
  ::close(other);
  EXPECT_TRUE(run());
}

TEST_F(RunStudy, APlanWritesNothing) {
  RunJob job;
  job.file = scratch_ / "study.toml";
  job.plan_only = true;
  const auto outcome = run_study(job).value();
  EXPECT_EQ(counts(outcome), (Counts{{TrialStatus::not_begun, 11}}));
  EXPECT_FALSE(fs::exists(scratch_ / "results"));
}

}  // namespace

}  // namespace kinemark::pipeline
