// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/pipeline/session/session_text.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class PlanSteps : public ::testing::Test {
 protected:
  PlanSteps() {
    fs::create_directories(scratch_ / "S");
    for (const char* name : {"S/walk2.c3d", "S/walk1.c3d", "S/.walk3.c3d", "S/run.c3d", "S/move.c3d",
                             "human.osim", "weights.xml"})
      (void)io::write_text(scratch_ / name, name, true);
    fs::create_directories(scratch_ / "S/walk9.c3d");
  }

  [[nodiscard]] Result<std::vector<RunStep>> plan(const std::string& text) const {
    const auto file = parse_run_file(text, scratch_ / "s.toml");
    if (!file) return std::unexpected(file.error());
    return plan_steps(*file);
  }

  static std::vector<std::string> names(const std::vector<RunStep>& steps) {
    std::vector<std::string> out;
    for (const auto& step : steps) out.push_back(step.trial + "/" + step.name);
    return out;
  }

  testing_support::ScratchFolder scratch_;
};

class PlanSession : public PlanSteps {
 protected:
  PlanSession() {
    fs::create_directories(scratch_ / "day/raw");
    SessionFile about;
    std::vector<ManifestEntry> manifest;
    for (const char* name : {"raw/b.mcap", "raw/a.mcap"}) {
      (void)io::write_text(scratch_ / "day" / name, name, true);
      about.trials.push_back({.file = name, .source = "sim:rig", .started = "", .rate_hz = 60.0});
      manifest.push_back({name, io::hash_file(scratch_ / "day" / name).value().hex});
    }
    (void)io::write_text(scratch_ / "day/session.toml", session_text(about), true);
    (void)io::write_text(scratch_ / "day/MANIFEST", manifest_text(manifest), true);
  }
  void give_rig() const {
    const auto text = io::read_text(scratch_ / "day/session.toml").value();
    (void)io::write_text(scratch_ / "day/session.toml", "rig = \"rig.toml\"\n" + text, true);
  }
  static constexpr const char* kStudy =
      "steps = [\"reconstruct\", \"clean\"]\n[[subject]]\nname = \"A\"\nsession = \"day\"\n";
};

TEST_F(PlanSession, ItsTrialsAreReconstructedInTheirOrder) {
  EXPECT_THAT(plan(kStudy).error().message, HasSubstr("no rig for reconstruct of subject 'A'"));
  give_rig();
  const auto steps = plan(kStudy).value();
  ASSERT_THAT(names(steps), ElementsAre("b/reconstruct", "b/clean", "a/reconstruct", "a/clean"));
  EXPECT_THAT(steps[0].words, ElementsAre("reconstruct", "day/raw/b.mcap", "--rig=day/rig.toml",
                                          "--output=results/A/b/markers.c3d"));
  EXPECT_THAT(steps[0].inputs, ElementsAre("day/raw/b.mcap", "day/rig.toml"));
  EXPECT_THAT(steps[1].words, ElementsAre("clean", "results/A/b/markers.c3d", "results/A/b/clean.c3d"));
  EXPECT_THAT(steps[1].after, ElementsAre(0U));
}

TEST_F(PlanSession, ARigOfTheOptionsGoesBeforeThatOfTheSession) {
  give_rig();
  const auto steps = plan(std::string(kStudy) + "[subject.reconstruct]\nrig = \"lab.toml\"\n").value();
  EXPECT_THAT(steps[0].words, Contains("--rig=lab.toml"));
  EXPECT_THAT(steps[0].words, Not(Contains("--rig=day/rig.toml")));
}

TEST_F(PlanSession, ATrialThatIsNamedHasOptionsOfItsOwn) {
  give_rig();
  const auto steps = plan(std::string(kStudy) +
                          "[[subject.trial]]\nfile = \"day/raw/a.mcap\"\n[subject.trial.clean]\ngaps = "
                          "\"auto\"\n")
                         .value();
  ASSERT_THAT(names(steps), ElementsAre("a/reconstruct", "a/clean", "b/reconstruct", "b/clean"));
  EXPECT_THAT(steps[0].words, Contains("--rig=day/rig.toml"));
  EXPECT_THAT(steps[1].words, Contains("--gaps=auto"));
  EXPECT_THAT(steps[3].words, Not(Contains("--gaps=auto")));
}

TEST_F(PlanSession, AChangedRecordingIsNamed) {
  give_rig();
  (void)io::write_text(scratch_ / "day/raw/a.mcap", "changed", true);
  EXPECT_THAT(plan(kStudy).error().message, HasSubstr("a.mcap: was changed since it was recorded"));
  (void)io::write_text(scratch_ / "S/a.mcap", "x", true);
  (void)io::write_text(scratch_ / "day/raw/a.mcap", "raw/a.mcap", true);
  EXPECT_THAT(plan(std::string(kStudy) + "trials = [\"S/a.mcap\"]\n").error().message,
              HasSubstr("would both be called 'a'"));
  EXPECT_THAT(plan("steps = [\"clean\"]\n[[subject]]\nname = \"A\"\nsession = \"S\"\n").error().message,
              HasSubstr("session.toml"));
}

TEST_F(PlanSteps, WhatIsAnalysedIsTheMotionOfTheSolverWithItsModel) {
  const auto of = [&](const std::string& steps, const std::string& tables) {
    return plan("steps = [" + steps + "]\n" + tables +
                "[[subject]]\nname = \"A\"\ntrials = [\"S/walk1.c3d\"]\n");
  };
  const auto steps =
      of("\"analyze\", \"track\", \"ik\", \"report\"",
         "[ik]\nmodel = \"human.osim\"\n[track]\nmodel = \"human.osim\"\n[analyze]\ntorques = true\n")
          .value();
  ASSERT_THAT(names(steps), ElementsAre("walk1/ik", "walk1/analyze", "walk1/report", "walk1/track"));
  EXPECT_THAT(steps[1].words, ElementsAre("analyze", "results/A/walk1/ik.mot", "--model=human.osim",
                                          "--output=results/A/walk1/analysis", "--torques"));
  EXPECT_THAT(steps[1].inputs,
              ElementsAre("human.osim", "results/A/walk1/ik.mot", "results/A/walk1/ik_report.json"));
  EXPECT_THAT(steps[1].outputs, ElementsAre("results/A/walk1/analysis/ik_analysis.json"));
  EXPECT_THAT(steps[1].after, ElementsAre(0U));
  const auto tracked = of("\"track\", \"analyze\"", "[track]\nmodel = \"human.osim\"\n").value();
  EXPECT_EQ(tracked[1].words[1], "results/A/walk1/track.mot");
  const auto own =
      of("\"ik\", \"analyze\"",
         "[ik]\nmodel = \"human.osim\"\n[analyze]\nmodel = \"other.osim\"\nsetup = \"weights.xml\"\n")
          .value();
  EXPECT_THAT(own[1].words, Not(Contains("--model=human.osim")));
  EXPECT_THAT(own[1].outputs, IsEmpty()) << "a setup gives them a name of its own";
  EXPECT_THAT(own[1].inputs, Contains("weights.xml"));
  const auto none = of("\"ik\", \"analyze\"", "[ik]\nsetup = \"weights.xml\"\n");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no model for analyze of subject 'A'"));
  const auto alone = of("\"analyze\"", "");
  ASSERT_FALSE(alone);
  EXPECT_THAT(alone.error().message,
              HasSubstr("has no 'ik' and no 'track' whose motion 'analyze' could take"));
}

TEST_F(PlanSteps, FunctionalJointsGoIntoTheModel) {
  const auto steps = plan(
                         "steps = [\"joints\", \"scale\", \"ik\"]\n[scale]\nmodel = \"human.osim\"\n"
                         "[[subject]]\nname = \"A\"\nstatic = \"S/run.c3d\"\nfunctional = "
                         "\"S/move.c3d\"\ntrials = [\"S/walk1.c3d\"]\n")
                         .value();
  ASSERT_THAT(names(steps), ElementsAre("/joints", "/scale", "walk1/ik"));
  EXPECT_THAT(steps[1].words, Contains("--joints=results/A/joints"));
  EXPECT_THAT(steps[1].words, Contains("--markers=S/move.c3d"));
  EXPECT_THAT(steps[1].inputs, Contains("results/A/joints/skeleton.json"));
  EXPECT_THAT(steps[1].after, ElementsAre(0U));
}

TEST_F(PlanSteps, EachStepComesBehindThoseThatItNeeds) {
  const auto steps = plan(R"(
steps = ["joints", "scale", "clean", "ik", "track", "report"]
[scale]
model = "human.osim"
[[subject]]
name = "A"
functional = "S/move.c3d"
mass = 71.5
trials = ["S/walk1.c3d"]
)")
                         .value();
  ASSERT_THAT(names(steps),
              ElementsAre("/joints", "/scale", "walk1/clean", "walk1/ik", "walk1/report", "walk1/track"));
  EXPECT_THAT(steps[0].words, ElementsAre("joints", "S/move.c3d", "--output=results/A/joints"));
  EXPECT_THAT(steps[1].words,
              ElementsAre("scale", "--markers=S/move.c3d", "--joints=results/A/joints", "--mass=71.5",
                          "--output=results/A/model.osim", "--model=human.osim"));
  EXPECT_THAT(steps[1].inputs, ElementsAre("S/move.c3d", "results/A/joints/skeleton.json", "human.osim"));
  EXPECT_THAT(steps[2].words, ElementsAre("clean", "S/walk1.c3d", "results/A/walk1/clean.c3d"));
  EXPECT_THAT(steps[3].words,
              ElementsAre("ik", "--model=results/A/model.osim", "--markers=results/A/walk1/clean.c3d",
                          "--output=results/A/walk1/ik.mot"));
  EXPECT_THAT(steps[3].after, ElementsAre(1U, 2U));
  EXPECT_THAT(steps[4].after, ElementsAre(3U));
  EXPECT_THAT(steps[4].inputs, ElementsAre("results/A/walk1/ik.mot", "results/A/walk1/ik_report.json"));
  EXPECT_THAT(steps[5].after, ElementsAre(1U, 2U));
  EXPECT_EQ(steps[3].record, "results/A/walk1/ik.step.json");
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (const std::size_t before : steps[i].after) EXPECT_LT(before, i);
}

TEST_F(PlanSteps, WithoutScaleAndCleanTheGivenFilesAreTaken) {
  const auto steps = plan(R"(
steps = ["ik"]
output = "o"
[ik]
model = "human.osim"
[[subject]]
name = "A"
trials = ["S/run.c3d"]
)")
                         .value();
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_THAT(steps[0].words,
              ElementsAre("ik", "--markers=S/run.c3d", "--output=o/A/run/ik.mot", "--model=human.osim"));
  EXPECT_THAT(steps[0].inputs, ElementsAre("S/run.c3d", "human.osim"));
  EXPECT_THAT(steps[0].after, IsEmpty());
}

TEST_F(PlanSteps, TheNarrowerOptionTakesThePlaceOfTheWider) {
  const auto steps = plan(R"(
steps = ["ik"]
[ik]
model = "human.osim"
max-rms = 30
weight = ["A=1", "B=1"]
no-limits = true
[[subject]]
name = "A"
trials = ["S/walk*.c3d"]
[subject.ik]
max-rms = 20
no-limits = false
[[subject.trial]]
file = "S/walk2.c3d"
[subject.trial.ik]
max-rms = 10
weight = "C=3"
tasks = "weights.xml"
)")
                         .value();
  ASSERT_THAT(names(steps), ElementsAre("walk1/ik", "walk2/ik")) << "hidden files and folders fit no pattern";
  EXPECT_THAT(steps[0].words, Contains("--max-rms=20"));
  EXPECT_THAT(steps[0].words, Contains("--weight=B=1"));
  EXPECT_THAT(steps[0].words, Not(Contains("--no-limits"))) << "false takes a switch back";
  EXPECT_THAT(steps[0].lines.size(), 4U) << "model, two weights, max-rms";
  EXPECT_THAT(steps[1].words, Contains("--max-rms=10"));
  EXPECT_THAT(steps[1].words, Not(Contains("--weight=A=1")));
  EXPECT_THAT(steps[1].inputs, Contains(fs::path("weights.xml"))) << "a value that names a file is an input";
}

TEST_F(PlanSteps, PlaceholdersAndFilesBehindAnEqualsSign) {
  const auto steps = plan(R"(
steps = ["clean", "ik"]
[ik]
model = "human.osim"
forces = "{trial}"
images = "left=weights.xml"
[clean]
report = "pages-{subject}-{subject}.html"
[[subject]]
name = "A"
trials = ["S/run.c3d"]
)")
                         .value();
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_THAT(steps[0].words, Contains("--report=pages-A-A.html"));
  EXPECT_THAT(steps[1].words, Contains("--forces=S/run.c3d"))
      << "the recording itself, not what clean made of it";
  EXPECT_THAT(steps[1].inputs, Contains(fs::path("S/run.c3d")));
  EXPECT_THAT(steps[1].inputs, Contains(fs::path("weights.xml")));
}

TEST_F(PlanSteps, TheJournalBesideARecordingIsAnInput) {
  const std::string study =
      "steps = [\"clean\"]\n[clean]\nedits = \"beside\"\n[[subject]]\nname = \"A\"\ntrials = "
      "[\"S/run.c3d\"]\n";
  EXPECT_THAT(plan(study).value().at(0).inputs, ElementsAre("S/run.c3d"));
  ASSERT_TRUE(io::write_text(scratch_ / "S/run_edits.jsonl", "{}", false));
  const auto steps = plan(study).value();
  EXPECT_THAT(steps.at(0).words, Contains("--edits=beside"));
  EXPECT_THAT(steps.at(0).inputs, ElementsAre("S/run.c3d", "S/run_edits.jsonl"));
}

TEST_F(PlanSteps, TheJournalIsAnInputOfASolverThatReadsTheRecordingItself) {
  ASSERT_TRUE(io::write_text(scratch_ / "S/run_edits.jsonl", "{}", false));
  const auto steps = plan(
      "steps = [\"ik\"]\n[ik]\nmodel = \"human.osim\"\nedits = \"beside\"\n[[subject]]\nname = \"A\"\n"
      "trials = [\"S/run.c3d\"]\n");
  EXPECT_THAT(steps.value().at(0).inputs, Contains(fs::path("S/run_edits.jsonl")).Times(1));
}

TEST_F(PlanSteps, FramesOfOpenPoseAreInputsEachAndOneStandsForAll) {
  fs::create_directories(scratch_ / "frames");
  for (const char* name : {"frames/v_0_keypoints.json", "frames/v_1_keypoints.json"})
    ASSERT_TRUE(io::write_text(scratch_ / name, R"({"version":1.3,"people":[]})", true));
  for (const char* points : {"frames", "frames/v_1_keypoints.json"}) {
    const auto steps = plan(std::string(R"(
steps = ["ik"]
[ik]
model = "human.osim"
images = "left=)") + points +
                            R"("
[[subject]]
name = "A"
trials = ["S/run.c3d"]
)")
                           .value();
    ASSERT_EQ(steps.size(), 1U);
    EXPECT_THAT(steps[0].inputs, Contains(fs::path("frames/v_0_keypoints.json")).Times(1)) << points;
    EXPECT_THAT(steps[0].inputs, Contains(fs::path("frames/v_1_keypoints.json")).Times(1)) << points;
  }
}

TEST_F(PlanSteps, AFileWhoseNameBeginsLikeAnOptionIsNone) {
  const auto steps =
      plan("steps = [\"clean\"]\noutput = \"-o\"\n[[subject]]\nname = \"A\"\ntrials = [\"-x.c3d\"]\n")
          .value();
  EXPECT_THAT(steps.at(0).words, ElementsAre("clean", "./-x.c3d", "./-o/A/-x/clean.c3d"));
}

TEST_F(PlanSteps, WhatCannotBePlanned) {
  const auto error = [&](const std::string& more) {
    const auto steps = plan("steps = [\"clean\"]\n[[subject]]\nname = \"A\"\n" + more);
    return steps ? "" : steps.error().message;
  };
  EXPECT_THAT(error("trials = [\"S/jump*.c3d\"]"), HasSubstr("line 2: no file fits 'S/jump*.c3d'"));
  EXPECT_THAT(error("trials = [\"*/walk1.c3d\"]"), HasSubstr("not of its folder"));
  EXPECT_THAT(error("trials = [\"none/*.c3d\"]"), HasSubstr("the folder cannot be read"));
  EXPECT_THAT(error("trials = [\"S/walk1.c3d\", \"T/walk1.trc\"]"),
              HasSubstr("S/walk1.c3d and T/walk1.trc of subject 'A' would both be called 'walk1'"));
  EXPECT_EQ(error("trials = [\"S/walk1.c3d\", \"S/walk*.c3d\"]"), "") << "one file, named twice";
  EXPECT_EQ(error("trials = [\"S/walk1.c3d\", \"./S/../S/walk1.c3d\"]"), "")
      << "one file, written in two ways";
  const auto none = plan("steps = [\"ik\"]\n[[subject]]\nname = \"A\"\ntrials = [\"S/run.c3d\"]\n");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no model for ik of subject 'A'"));
}

}  // namespace
}  // namespace kinemark::pipeline
