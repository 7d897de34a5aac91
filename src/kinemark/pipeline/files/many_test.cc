// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/many.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RunMany : public ::testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_ / name; }

  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    EXPECT_TRUE(io::write_text(path(name), text, true));
    return path(name);
  }

  /// Copies inputs; one that says "bad" fails, one that says "poor" misses a gate. Counts what it was asked.
  ManyJob job(const std::vector<std::string>& inputs) {
    ManyJob job;
    for (const auto& name : inputs) job.inputs.push_back(path(name));
    job.folder = path("out");
    job.ending = ".trc";
    job.run_one = [this](const fs::path& input, const fs::path& output, const fs::path& /*page*/,
                         const JobSettings& settings) -> Result<JobOutcome> {
      {
        const std::lock_guard lock(mutex_);
        ++asked_[input.filename().string()];
      }
      const auto text = io::read_text(input, 1000);
      if (!text) return std::unexpected(text.error());
      if (*text == "bad") return fail(Code::bad_input, input.string() + ": is bad");
      if (auto s = io::write_text(output, *text, settings.force); !s) return std::unexpected(s.error());
      JobOutcome out;
      if (*text == "poor") out.gates = {{.name = "g", .passed = false, .sentence = "too poor"}};
      if (*text == "odd") out.warnings = {"first", "second"};
      return out;
    };
    return job;
  }

  static std::vector<TrialStatus> statuses(const Result<ManyOutcome>& outcome) {
    std::vector<TrialStatus> all;
    for (const auto& trial : outcome.value().trials) all.push_back(trial.status);
    return all;
  }

  testing_support::ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  std::mutex mutex_;
  std::map<std::string, int> asked_;
};

TEST_F(RunMany, DoesEachAndSaysHowItFared) {
  write("a.c3d", "good"), write("b.csv", "poor"), write("c.nwb", "odd");
  const auto outcome = run_many(job({"a.c3d", "b.csv", "c.nwb"}));
  EXPECT_THAT(statuses(outcome), ElementsAre(TrialStatus::good, TrialStatus::missed_gate, TrialStatus::good));
  EXPECT_EQ(outcome->trials[1].said, "too poor");
  EXPECT_EQ(outcome->trials[2].said, "first");
  EXPECT_EQ(outcome->trials[2].warnings, 2U);
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_EQ(io::read_text(path("out/a.trc"), 100).value(), "good");
}

TEST_F(RunMany, WhatIsThereIsNotDoneAgain) {
  write("a.c3d", "good"), write("b.c3d", "good");
  ASSERT_TRUE(run_many(job({"a.c3d"})));
  const auto outcome = run_many(job({"a.c3d", "b.c3d"}));
  EXPECT_THAT(statuses(outcome), ElementsAre(TrialStatus::there, TrialStatus::good));
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_EQ(asked_["a.c3d"], 1);
  auto again = job({"a.c3d", "b.c3d"});
  again.force = true;
  EXPECT_THAT(statuses(run_many(again)), ElementsAre(TrialStatus::good, TrialStatus::good));
  EXPECT_EQ(asked_["a.c3d"], 2);
}

TEST_F(RunMany, AnOutputOlderThanItsInputIsSaid) {
  write("a.c3d", "good");
  write("out/a.trc", "old");
  fs::last_write_time(path("out/a.trc"), fs::last_write_time(path("a.c3d")) - std::chrono::hours(1));
  const auto outcome = run_many(job({"a.c3d"}));
  EXPECT_THAT(statuses(outcome), ElementsAre(TrialStatus::outdated));
  EXPECT_EQ(outcome->exit_status(), 1);
  EXPECT_EQ(io::read_text(path("out/a.trc"), 100).value(), "old");
}

TEST_F(RunMany, StopsAtAFailureUnlessAskedToGoOn) {
  write("a.c3d", "good"), write("b.c3d", "bad"), write("c.c3d", "good");
  auto stopping = job({"a.c3d", "b.c3d", "c.c3d"});
  const auto stopped = run_many(stopping);
  EXPECT_THAT(statuses(stopped), ElementsAre(TrialStatus::good, TrialStatus::failed, TrialStatus::not_begun));
  EXPECT_EQ(stopped->exit_status(), 3);
  EXPECT_THAT(stopped->trials[1].said, HasSubstr("b.c3d: is bad"));
  stopping.keep_going = true;
  const auto whole = run_many(stopping);
  EXPECT_THAT(statuses(whole), ElementsAre(TrialStatus::there, TrialStatus::failed, TrialStatus::good));
  EXPECT_EQ(whole->exit_status(), 3);
}

TEST_F(RunMany, SeveralAtATimeGiveTheSame) {
  std::vector<std::string> names;
  for (int i = 0; i < 40; ++i) {
    names.push_back("r" + std::to_string(i) + ".c3d");
    write(names.back(), i % 7 == 3 ? "poor" : "good");
  }
  auto many = job(names);
  many.jobs = 4;
  std::int64_t last = 0;
  many.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(done, last + 1);
    EXPECT_EQ(total, 40);
    last = done;
    return true;
  };
  const auto outcome = run_many(many);
  EXPECT_EQ(last, 40);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(outcome->trials[i].status, i % 7 == 3 ? TrialStatus::missed_gate : TrialStatus::good);
    EXPECT_EQ(asked_[names[i]], 1);
  }
}

TEST_F(RunMany, RefusesBeforeAnythingIsWritten) {
  write("x/a.c3d", "good"), write("y/A.csv", "good");
  const auto twice = run_many(job({"x/a.c3d", "y/A.csv"}));
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, Code::usage);
  EXPECT_THAT(twice.error().message, HasSubstr("would both become"));
  EXPECT_FALSE(fs::exists(path("out")));
  auto onto_itself = job({"x/a.c3d"});
  onto_itself.folder = path("x");
  onto_itself.ending = "";
  EXPECT_EQ(run_many(onto_itself).error().code, Code::usage);
  auto no_folder = job({"x/a.c3d"});
  no_folder.folder = path("y/A.csv");
  EXPECT_EQ(run_many(no_folder).error().code, Code::io);
}

TEST_F(RunMany, AKilledRunsPartOfASetIsReplacedAndNothingElse) {
  const std::string set = R"({"kinemark_set": "0123456789abcdef"})",
                    other = R"({"kinemark_set": "ffffffffffffffff"})";
  write("a.c3d", set);
  auto many = job({"a.c3d"});
  many.ending = ".json";
  many.belongs = "_report.json";
  write("out/a_report.json", set);  // the output itself is missing
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::good));
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::there));
  write("out/a_report.json", other);  // two runs
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::good));
  write("out/a.json", "{}");  // somebody's own file
  const auto refused = run_many(many);
  EXPECT_THAT(statuses(refused), ElementsAre(TrialStatus::there)) << "it names no set, and a report is there";
  fs::remove(path("out/a_report.json"));
  const auto kept = run_many(many);
  EXPECT_THAT(statuses(kept), ElementsAre(TrialStatus::failed));
  EXPECT_EQ(io::read_text(path("out/a.json"), 100).value(), "{}");
}

TEST_F(RunMany, APageThatIsMissingIsMade) {
  const std::string set = R"({"kinemark_set": "0123456789abcdef"})";
  write("a.c3d", set);
  auto many = job({"a.c3d"});
  many.ending = ".json";
  many.pages = path("pages");
  const auto copy = many.run_one;
  many.run_one = [&](const fs::path& input, const fs::path& output, const fs::path& page,
                     const JobSettings& settings) {
    EXPECT_EQ(page, path("pages/a.html"));
    EXPECT_TRUE(io::write_text(page, set, settings.force));
    return copy(input, output, page, settings);
  };
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::good));
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::there));
  fs::remove(path("pages/a.html"));
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::good)) << "what is there names its set";
  EXPECT_TRUE(fs::exists(path("pages/a.html")));
}

TEST_F(RunMany, ATableOfSomebodyIsNotReplacedForAMissingPage) {
  const std::string set = R"({"kinemark_set": "0123456789abcdef"})";
  write("a.c3d", set);
  auto many = job({"a.c3d"});
  many.ending = ".csv";
  many.belongs = "_report.json";
  many.pages = path("pages");
  write("out/a.csv", "edited by hand");
  write("out/a_report.json", set);
  EXPECT_THAT(statuses(run_many(many)), ElementsAre(TrialStatus::failed));
  EXPECT_EQ(io::read_text(path("out/a.csv"), 100).value(), "edited by hand");
}

TEST_F(RunMany, AnExceptionIsAFailureOfThatRecordingAlone) {
  write("a.c3d", "good"), write("b.c3d", "good"), write("c.c3d", "good");
  for (const int jobs : {1, 3}) {
    auto many = job({"a.c3d", "b.c3d", "c.c3d"});
    many.keep_going = true;
    many.jobs = jobs;
    many.force = true;
    const auto copy = many.run_one;
    many.run_one = [&](const fs::path& input, const fs::path& output, const fs::path& page,
                       const JobSettings& settings) -> Result<JobOutcome> {
      if (input.stem() == "a") throw std::bad_alloc();
      if (input.stem() == "b") throw std::runtime_error("a check");
      return copy(input, output, page, settings);
    };
    const auto outcome = run_many(many);
    EXPECT_THAT(statuses(outcome), ElementsAre(TrialStatus::failed, TrialStatus::failed, TrialStatus::good));
    EXPECT_THAT(outcome->trials[0].said, HasSubstr("a.c3d: out of memory"));
    EXPECT_EQ(outcome->trials[0].exit_status, 4);
    EXPECT_THAT(outcome->trials[1].said, HasSubstr("b.c3d: a check"));
  }
}

}  // namespace
}  // namespace kinemark::pipeline
