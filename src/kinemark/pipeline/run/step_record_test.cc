// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/step_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/version.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

TEST(StepFiles, WhatWasWrittenIsInItsLines) {
  EXPECT_THAT(written_files({"note: wrote nothing", "wrote a b/ik.mot", "rewrote x", "wrote ik_sd.sto"}),
              ElementsAre("a b/ik.mot", "ik_sd.sto"));
  EXPECT_THAT(written_files({}), IsEmpty());
}

TEST(StepFiles, ResultsNameWhatTheyWereMadeFrom) {
  const testing_support::ScratchFolder scratch;
  const auto put = [&](const char* name, const char* text) {
    ASSERT_TRUE(io::write_text(scratch / name, text, true));
  };
  put("r.json", R"({"inputs": [{"path": "tasks.xml", "hash": "12", "hash_kind": "XXH3-64"},
                               {"path": "other", "hash": "12", "hash_kind": "MD5"}, 7, {"hash_kind": "XXH3-64", "path": 5}]})");
  put("list.json", "[1, 2]");
  put("broken.json", "{");
  put("no.txt", R"({"inputs": [{"path": "x", "hash": "1", "hash_kind": "XXH3-64"}]})");
  EXPECT_THAT(named_inputs({"list.json", "r.json", "broken.json", "no.txt", "absent.json"}, scratch.path()),
              ElementsAre(Pair("tasks.xml", "12")));
}

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Step : public ::testing::Test {
 protected:
  Step() { put("in.c3d", "recording"); }

  void put(const char* name, const std::string& text) const {
    ASSERT_TRUE(io::write_text(scratch_ / name, text, true));
  }
  [[nodiscard]] StepState state() const { return find_state(step_, scratch_.path()).value().state; }
  void run_it() {
    auto record = mark_begun(step_, scratch_.path()).value();
    put("out.c3d", "result");
    record.said = {"wrote out.c3d"};
    ASSERT_TRUE(mark_done(step_, scratch_.path(), record));
  }

  testing_support::ScratchFolder scratch_;
  RunStep step_{.subject = "A",
                .name = "clean",
                .words = {"clean", "in.c3d", "out.c3d"},
                .inputs = {"in.c3d"},
                .outputs = {"out.c3d"},
                .record = "clean.step.json"};
};

TEST_F(Step, IsDueUntilItIsDone) {
  EXPECT_EQ(state(), StepState::due);
  run_it();
  const auto found = find_state(step_, scratch_.path()).value();
  EXPECT_EQ(found.state, StepState::current);
  EXPECT_THAT(found.record.said, testing::ElementsAre("wrote out.c3d"));
}

TEST_F(Step, IsDueAgainWhenInputsOrOptionsOrTheProgramChange) {
  run_it();
  put("in.c3d", "another recording");
  EXPECT_EQ(state(), StepState::due);
  put("in.c3d", "recording");
  EXPECT_EQ(state(), StepState::current) << "content counts, not the time";
  step_.words.emplace_back("--filter=none");
  EXPECT_EQ(state(), StepState::due);
  step_.words.pop_back();
  auto record = parse_record(io::read_text(scratch_ / "clean.step.json").value(), "x").value();
  EXPECT_EQ(record.version, kVersion);
  record.version = "0.0.1";
  put("clean.step.json", record_text(record));
  EXPECT_EQ(state(), StepState::due);
}

TEST_F(Step, IsDueAgainWhenAResultIsGone) {
  run_it();
  fs::remove(scratch_ / "out.c3d");
  EXPECT_EQ(state(), StepState::due);
}

TEST_F(Step, EveryFileThatTheCommandWroteCounts) {
  auto record = mark_begun(step_, scratch_.path()).value();
  put("out.c3d", "result");
  put("out_sd.sto", "deviations");
  record.said = {"note: x", "wrote out.c3d", "wrote out_sd.sto", "wrote gone.sto"};
  ASSERT_TRUE(mark_done(step_, scratch_.path(), record));
  EXPECT_EQ(state(), StepState::current);
  put("out_sd.sto", "changed");
  EXPECT_EQ(state(), StepState::occupied);
  fs::remove(scratch_ / "out_sd.sto");
  EXPECT_EQ(state(), StepState::due);
}

TEST_F(Step, WhatItsResultsWereMadeFromCountsToo) {
  put("tasks.xml", "weights");
  auto record = mark_begun(step_, scratch_.path()).value();
  const auto hash = io::hash_file(scratch_ / "tasks.xml").value().hex;
  put("out.c3d", "result");
  put("out_report.json",
      R"({"inputs": [{"path": "tasks.xml", "hash_kind": "XXH3-64", "hash": ")" + hash + "\"}]}");
  record.said = {"wrote out.c3d", "wrote out_report.json"};
  ASSERT_TRUE(mark_done(step_, scratch_.path(), record));
  EXPECT_EQ(state(), StepState::current);
  put("tasks.xml", "other weights");
  EXPECT_EQ(state(), StepState::due);
  put("tasks.xml", "weights");
  EXPECT_EQ(state(), StepState::current);
  fs::remove(scratch_ / "tasks.xml");
  EXPECT_EQ(state(), StepState::due);
}

TEST_F(Step, ResultsOfTheLastTimeThatAreNotMadeAgainGo) {
  const auto run = [&](const std::vector<std::string>& said) {
    auto record = mark_begun(step_, scratch_.path()).value();
    put("out.c3d", "result");
    record.said = said;
    ASSERT_TRUE(mark_done(step_, scratch_.path(), record));
  };
  put("out_sd.sto", "deviations");
  put("out_bound.sto", "bounds");
  run({"wrote out.c3d", "wrote out_sd.sto", "wrote out_bound.sto"});
  put("out_bound.sto", "mine now");
  put("out_mine.sto", "mine");
  ASSERT_TRUE(mark_begun(step_, scratch_.path())) << "a run that was killed forgets nothing";
  run({"wrote out.c3d"});
  EXPECT_FALSE(fs::exists(scratch_ / "out_sd.sto"));
  EXPECT_TRUE(fs::exists(scratch_ / "out_bound.sto")) << "somebody changed it";
  EXPECT_TRUE(fs::exists(scratch_ / "out_mine.sto"));
  put("out_sd.sto", "deviations");
  run({"wrote out.c3d", "wrote out_sd.sto"});
  run({});
  EXPECT_TRUE(fs::exists(scratch_ / "out_sd.sto")) << "a quiet command does not say what it wrote";
}

TEST_F(Step, WhatWasBegunIsDueWhateverIsThere) {
  ASSERT_TRUE(mark_begun(step_, scratch_.path()));
  put("out.c3d", "the result of a run that was killed");
  EXPECT_EQ(state(), StepState::due);
}

TEST_F(Step, AFileOfSomebodyElseIsInTheWay) {
  put("out.c3d", "mine");
  const auto strange = find_state(step_, scratch_.path()).value();
  EXPECT_EQ(strange.state, StepState::occupied);
  EXPECT_THAT(strange.sentence, HasSubstr("out.c3d: is there, and no run made it"));
  fs::remove(scratch_ / "out.c3d");
  run_it();
  put("out.c3d", "corrected by hand");
  const auto changed = find_state(step_, scratch_.path()).value();
  EXPECT_EQ(changed.state, StepState::occupied);
  EXPECT_THAT(changed.sentence, HasSubstr("out.c3d: was changed since the run made it"));
}

TEST_F(Step, AMissingInputOrOutputIsSaid) {
  step_.inputs = {"absent.c3d"};
  EXPECT_EQ(mark_begun(step_, scratch_.path()).error().code, Code::io);
  EXPECT_FALSE(fs::exists(scratch_ / "clean.step.json"));
  step_.inputs = {"in.c3d"};
  const auto record = mark_begun(step_, scratch_.path()).value();
  const auto s = mark_done(step_, scratch_.path(), record);
  ASSERT_FALSE(s);
  EXPECT_THAT(s.error().message, HasSubstr("out.c3d: was not written by 'clean'"));
  EXPECT_EQ(state(), StepState::due) << "still only begun";
}

TEST_F(Step, RecordsReadBackAsTheyAreWritten) {
  const StepRecord record{.done = true,
                          .version = "1.2",
                          .words = {"ik", "--model=ü.osim"},
                          .inputs = {{"a", "00ff"}},
                          .outputs = {{"b", "11"}, {"c", "22"}},
                          .exit_status = 1,
                          .said = {"attention: \"x\""}};
  const auto back = parse_record(record_text(record), "r").value();
  EXPECT_EQ(back.done, record.done);
  EXPECT_EQ(back.words, record.words);
  EXPECT_EQ(back.inputs, record.inputs);
  EXPECT_EQ(back.outputs, record.outputs);
  EXPECT_EQ(back.exit_status, 1);
  EXPECT_EQ(back.said, record.said);
  constexpr const char* kOddStatus =
      R"({"step": "done", "version": "1", "words": [], "inputs": [], "outputs": [], "exit_status": 1e99, "said": []})";
  for (const char* bad : {"", "{}", "[1]", "{\"step\": 3}", "not json", kOddStatus}) {
    const auto none = parse_record(bad, "r.json");
    ASSERT_FALSE(none) << bad;
    EXPECT_THAT(none.error().message, HasSubstr("r.json: is no record of a step"));
  }
  put("clean.step.json", "{");
  EXPECT_EQ(find_state(step_, scratch_.path()).error().code, Code::bad_input);
}

}  // namespace

}  // namespace kinemark::pipeline
