// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kWhole = R"(
output = "out"
steps = ["ik", "scale", "clean", "ik"]

[scale]
model = "human.osim"
symmetric = true

[[subject]]
name = "S01"
static = "S01/static.c3d"
mass = 71.5
trials = ["S01/walk*.c3d", "S01/run.c3d"]
[subject.ik]
max-rms = 20

[[subject]]
name = "S02"
functional = "S02/move.trc"
[[subject.trial]]
file = "S02/jump.c3d"
[subject.trial.ik]
start = 0.5
weight = ["LASI=2", "RASI=2"]
)";

/// A file with what is under test after lines that are good.
std::string with(const std::string& text) { return "steps = [\"clean\"]\n" + text; }

std::string error_of(const std::string& text) {
  const auto file = parse_run_file(text, "s.toml");
  return file ? "" : file.error().message;
}

constexpr const char* kSubject = "[[subject]]\nname = \"A\"\ntrials = [\"a.c3d\"]\n";

TEST(RunFile, HoldsWhatItSays) {
  const auto file = parse_run_file(kWhole, "study/s.toml").value();
  EXPECT_EQ(file.path, "study/s.toml");
  EXPECT_EQ(file.output, "out");
  EXPECT_THAT(file.steps, ElementsAre("scale", "clean", "ik")) << "in the order in which they are done, once";
  EXPECT_TRUE(file.does("ik"));
  EXPECT_FALSE(file.does("track"));
  ASSERT_EQ(file.options.size(), 1U);
  EXPECT_EQ(file.options[0].step, "scale");
  ASSERT_EQ(file.options[0].list.size(), 2U);
  EXPECT_EQ(file.options[0].list[0].name, "model");
  EXPECT_EQ(file.options[0].list[0].line, 6);
  EXPECT_TRUE(file.options[0].list[1].is_switch);
  ASSERT_EQ(file.subjects.size(), 2U);
  const auto &a = file.subjects[0], &b = file.subjects[1];
  EXPECT_EQ(a.name, "S01");
  EXPECT_EQ(a.static_trial, "S01/static.c3d");
  EXPECT_EQ(a.mass_kg, 71.5);
  ASSERT_EQ(a.trials.size(), 2U);
  EXPECT_EQ(a.trials[1].file, "S01/run.c3d");
  ASSERT_EQ(a.options.size(), 1U);
  EXPECT_EQ(a.options[0].step, "ik");
  EXPECT_EQ(b.functional, "S02/move.trc");
  EXPECT_EQ(b.mass_kg, 0.0);
  ASSERT_EQ(b.trials.size(), 1U);
  ASSERT_EQ(b.trials[0].options.size(), 1U);
  EXPECT_THAT(b.trials[0].options[0].list[1].values, ElementsAre("LASI=2", "RASI=2"));
}

TEST(RunFile, IsReadFromTheDiskAsFromText) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "s.toml", kWhole, false));
  EXPECT_EQ(read_run_file(scratch / "s.toml").value().subjects.size(), 2U);
  EXPECT_EQ(read_run_file(scratch / "absent.toml").error().code, Code::io);
}

TEST(RunFile, StepsThatAreNone) {
  EXPECT_THAT(error_of(kSubject), HasSubstr("s.toml: steps is missing"));
  EXPECT_THAT(error_of("steps = []\n" + std::string(kSubject)), HasSubstr("steps is empty"));
  EXPECT_THAT(
      error_of("steps = [\"cleen\"]\n" + std::string(kSubject)),
      HasSubstr("'cleen' is none; need some of joints, scale, reconstruct, clean, ik, track, analyze, "
                "report; did you mean clean"));
  EXPECT_THAT(error_of("steps = \"clean\"\n" + std::string(kSubject)), HasSubstr("a list of texts"));
}

TEST(RunFile, SubjectsThatAreNone) {
  EXPECT_THAT(error_of(with("")), HasSubstr("no [[subject]]"));
  EXPECT_THAT(error_of(with("[[subject]]\ntrials = [\"a.c3d\"]\n")),
              HasSubstr("line 2: subject: name is missing"));
  for (const char* name : {"", ".", "..", ".x", "a/b", "a\\\\b", "a\\u0000b", "a\\nb"})
    EXPECT_THAT(error_of(with(std::string("[[subject]]\nname = \"") + name + "\"\ntrials = [\"a.c3d\"]\n")),
                HasSubstr("name must be a name that can be a folder's"))
        << name;
  EXPECT_THAT(error_of(with(std::string(kSubject) + "[[subject]]\nname = \"a\"\ntrials = [\"b.c3d\"]\n")),
              HasSubstr("line 5: subject: name must be"))
      << "folders of one name where case does not count";
  for (const char* mass : {"0", "-3", "nan", "\"70\""})
    EXPECT_THAT(error_of(with(std::string(kSubject) + "mass = " + mass + "\n")), HasSubstr("mass must be"))
        << mass;
  EXPECT_THAT(error_of(with(std::string(kSubject) + "hight = 1.8\n")), HasSubstr("hight"));
}

TEST(RunFile, AStepNeedsItsFiles) {
  const auto of = [](const std::string& steps, const std::string& more) {
    return error_of("steps = [" + steps + "]\n[[subject]]\nname = \"A\"\n" + more);
  };
  EXPECT_THAT(of("\"clean\"", ""), HasSubstr("line 2: subject 'A' has no trials"));
  EXPECT_THAT(of("\"joints\"", "trials = [\"a.c3d\"]"), HasSubstr("no functional motion for 'joints'"));
  EXPECT_THAT(of("\"scale\"", "trials = [\"a.c3d\"]"), HasSubstr("nothing to scale by"));
  EXPECT_THAT(of("\"report\"", "trials = [\"a.c3d\"]"), HasSubstr("has no 'ik' that 'report' could show"));
  EXPECT_EQ(of("\"joints\"", "functional = \"f.c3d\""), "") << "joints alone need no trials";
  EXPECT_EQ(of("\"scale\"", "static = \"f.c3d\""), "");
}

TEST(RunFile, OptionsInTheWrongPlace) {
  EXPECT_THAT(error_of(with("[ik]\nmax-rms = 3\n" + std::string(kSubject))),
              StartsWith("s.toml: line 2: options of 'ik', which is not among the steps"));
  EXPECT_THAT(error_of("steps = [\"ik\"]\n[ik]\noutput = \"x.mot\"\n" + std::string(kSubject)),
              HasSubstr("line 3: 'output' of ik is given by the run itself"));
  EXPECT_THAT(error_of("steps = [\"ik\"]\n[ik]\nquiet = true\n" + std::string(kSubject)),
              HasSubstr("line 3: 'quiet' is an option of the run, not of a step"));
  EXPECT_THAT(error_of(with("[clean.deep]\nx = 1\n" + std::string(kSubject))),
              HasSubstr("line 2: 'deep' is a table"));
  EXPECT_THAT(error_of(with("clean = 3\n" + std::string(kSubject))), HasSubstr("clean must be a table"));
  EXPECT_THAT(error_of(with("colour = 3\n" + std::string(kSubject))), HasSubstr("colour"));
  EXPECT_THAT(error_of("steps = [\n"), StartsWith("s.toml: "));
}

}  // namespace
}  // namespace kinemark::pipeline
