// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/file_table.h"

#include <gmock/gmock.h>

#include "kinemark/core/utf8.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

ValidateOutcome three_files() {
  ValidateOutcome outcome;
  outcome.files.push_back(
      {.file = "walk.c3d",
       .facts = MarkerFileFacts{.format = "C3D", .points = 39, .frames = 450, .rate_hz = 100.0},
       .warnings = {},
       .error = {}});
  outcome.files.push_back(
      {.file = "q.mot",
       .facts = TableFacts{.rows = 101, .first_time_s = 2.0, .last_time_s = 3.0, .labels = {"a"}},
       .warnings = {"a column is odd", "two", "three"},
       .error = {}});
  outcome.files.push_back({.file = "b\x1b.trc",
                           .facts = {},
                           .warnings = {},
                           .error = Error{Code::bad_input, "b.trc: no number"}});
  return outcome;
}

TEST(Aligned, ColumnsBeginBelowEachOtherWhateverTheLetters) {
  EXPECT_EQ(aligned({{"Gänge", "1", "x"}, {"b", "200", "long text"}}),
            "Gänge  1    x\nb      200  long text\n");
  EXPECT_EQ(aligned({}), "");
}

TEST(FileTable, HasALineForEachFileAndTheTotals) {
  EXPECT_EQ(file_table(three_files()),
            "file      format  holds       frames  Hz   s     findings\n"
            "walk.c3d  C3D     39 markers  450     100  4.50  good\n"
            "q.mot     MOT     1 column    101     100  1.01  a column is odd (and 2 more)\n"
            "b\uFFFD.trc                                           b.trc: no number\n"
            "3 files: 1 good, 1 with findings, 1 not readable; 551 frames, 5.51 s\n");
}

TEST(FileTable, LeavesEmptyWhatAFileDoesNotHave) {
  ValidateOutcome outcome;
  outcome.files.push_back(
      {.file = "m.osim", .facts = ModelFacts{.labels = {"knee", "hip"}}, .warnings = {}, .error = {}});
  outcome.files.push_back(
      {.file = "r.mcap", .facts = RecordingFacts{.messages = 7}, .warnings = {}, .error = {}});
  outcome.files.push_back({.file = "x.v3d",
                           .facts = MarkerFileFacts{.format = "V", .points = 1, .frames = 9},
                           .warnings = {},
                           .error = {}});
  outcome.files.push_back({.file = "o.sto",
                           .facts = TableFacts{.rows = 1, .first_time_s = 0.0, .last_time_s = 0.0},
                           .warnings = {},
                           .error = {}});
  const auto text = file_table(outcome);
  EXPECT_THAT(text, HasSubstr("m.osim  OSIM    2 coordinates                 good\n"));
  EXPECT_THAT(text, HasSubstr("r.mcap  MCAP    7 messages                    good\n"));
  EXPECT_THAT(text, HasSubstr("x.v3d   V       1 marker       9              good\n"));
  EXPECT_THAT(text, HasSubstr("o.sto   STO     0 columns      1              good\n"));
  EXPECT_THAT(text, HasSubstr("4 files: 4 good, 0 with findings, 0 not readable; 10 frames, 0.00 s\n"));
}

TEST(FilesJson, IsTheFactsOfEachOrItsError) {
  const auto json = files_json(three_files());
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0]["kind"], "markers");
  EXPECT_EQ(json[0]["frames"], 450);
  EXPECT_EQ(json[1]["warnings"].size(), 3U);
  EXPECT_EQ(json[2]["exit_status"], 3);
  EXPECT_EQ(json[2]["error"], "b.trc: no number");
  EXPECT_FALSE(json[2].contains("kind"));
}

ManyOutcome three_trials() {
  ManyOutcome outcome;
  outcome.trials = {{.input = "in/a.c3d",
                     .output = "out/a.trc",
                     .status = TrialStatus::good,
                     .said = "odd",
                     .warnings = 3,
                     .seconds = 1.234},
                    {.input = "in/b.c3d", .output = "out/b.trc", .status = TrialStatus::there},
                    {.input = "in/c.c3d",
                     .output = "out/c.trc",
                     .status = TrialStatus::failed,
                     .said = "c: is\nbad",
                     .seconds = 0.5,
                     .exit_status = 3}};
  return outcome;
}

TEST(TrialTable, HasALineForEachRecordingAndTheTotals) {
  EXPECT_EQ(trial_table(three_trials()),
            "recording  status         s     output     findings\n"
            "in/a.c3d   good           1.23  out/a.trc  odd (and 2 more)\n"
            "in/b.c3d   there already        out/b.trc  \n"
            "in/c.c3d   failed         0.50             " +
                printable_sentence("c: is\nbad") +
                "\n3 recordings: 1 good, 1 there already, 1 failed; what was there already "
                "is as it was, whatever the options now (--force makes it anew)\n");
}

TEST(TrialsJson, HasTheSame) {
  const auto json = trials_json(three_trials());
  EXPECT_EQ(json["exit_status"], 3);
  ASSERT_EQ(json["trials"].size(), 3U);
  EXPECT_EQ(json["trials"][1]["status"], "there already");
  EXPECT_EQ(json["trials"][2]["said"], "c: is\nbad");
  EXPECT_EQ(json["trials"][0]["warnings"], 3);
}

}  // namespace
}  // namespace kinemark::pipeline
