// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/convert_job.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::Edit;
using data::EditKind;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class RecordingEditsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_markers(recording_, trajectory::testing::moving_trial(), false));
    loaded_.trial = io::read_markers(recording_).value();
  }
  void append(const std::vector<Edit>& edits) {
    auto journal = io::EditJournal::open(journal_, io::identify_recording(recording_).value());
    ASSERT_TRUE(journal) << journal.error().message;
    for (const auto& edit : edits) ASSERT_TRUE(journal->append(edit));
  }
  Result<io::Journal> take(const std::filesystem::path& edits, bool force = false) {
    return take_edits({.edits = edits, .recording = recording_, .force = force}, loaded_);
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path recording_ = scratch_ / "walk.c3d", journal_ = scratch_ / "walk_edits.jsonl";
  data::Recording loaded_;
  data::Trial& trial_ = loaded_.trial;
};

TEST_F(RecordingEditsTest, TakesWhatIsInForce) {
  append({{.kind = EditKind::cut, .marker = "RKNE", .first_frame = 510, .last_frame = 519},
          {.kind = EditKind::cut, .marker = "SACR"},
          {.kind = EditKind::undo},
          {.kind = EditKind::region, .first_frame = 520, .last_frame = 530, .name = "gait"}});
  const auto before = trial_.markers.count_missing();
  const auto taken = take(journal_);
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(trial_.markers.count_missing(), before + 10);
  EXPECT_EQ(loaded_.edits.in_force, 2U);
  EXPECT_EQ(taken->file->role, "edits");
  EXPECT_EQ(taken->file->hash, io::hash_file(journal_)->hex);
  EXPECT_THAT(loaded_.notes, ElementsAre(HasSubstr("2 edits of")));
  EXPECT_THAT(
      edit_options(loaded_.edits, *taken),
      ElementsAre(std::pair<std::string, std::string>("edits in force", "2, XXH3-64 " + taken->digest),
                  std::pair<std::string, std::string>("region 'gait'", "frames 520 to 530")));
}

TEST_F(RecordingEditsTest, BesideMayBeAbsentANameMayNot) {
  const auto none = take(io::kEditsBeside);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->file);
  EXPECT_THAT(loaded_.notes, IsEmpty());
  EXPECT_THAT(edit_options(loaded_.edits, *none), IsEmpty());
  EXPECT_TRUE(take("")) << "none asked for";
  const auto absent = take(journal_);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Code::io);
  append({{.kind = EditKind::cut, .marker = "RKNE"}});
  ASSERT_TRUE(take(io::kEditsBeside));
  EXPECT_EQ(loaded_.edits.in_force, 1U);
}

TEST_F(RecordingEditsTest, AnotherRecordingIsRefused) {
  append({{.kind = EditKind::cut, .marker = "RKNE"}});
  auto own = loaded_;
  ASSERT_TRUE(take_edits({.edits = journal_, .recording = recording_, .force = true}, own));
  EXPECT_THAT(own.notes, Not(Contains(HasSubstr("' and were applied to another recording,"))));
  ASSERT_TRUE(io::write_text(recording_, *io::read_text(recording_) + "x", true));
  const auto before = trajectory::testing::bytes_of(trial_);
  const auto other = take(journal_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Code::bad_input);
  EXPECT_THAT(other.error().message, HasSubstr("these edits are of 'walk.c3d'"));
  EXPECT_EQ(trajectory::testing::bytes_of(trial_), before);
  ASSERT_TRUE(take(journal_, true));
  EXPECT_THAT(loaded_.notes,
              Contains(HasSubstr("these edits are of 'walk.c3d' and were applied to another recording,")));
}

TEST_F(RecordingEditsTest, WhatCannotBeAppliedIsNamedWithItsLine) {
  append({{.kind = EditKind::cut, .marker = "RKNE"}, {.kind = EditKind::cut, .marker = "RKNN"}});
  const auto before = trajectory::testing::bytes_of(trial_);
  const auto wrong = take(journal_);
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message,
              HasSubstr("walk_edits.jsonl: line 3: cut: no marker is named 'RKNN'; nearest: RKNE"));
  EXPECT_EQ(trajectory::testing::bytes_of(trial_), before) << "all or nothing";
}

TEST_F(RecordingEditsTest, ConvertAppliesThemBeforeItsSelection) {
  append({{.kind = EditKind::relabel, .marker = "*12", .other = "LHEE"}});
  ConvertJob job;
  job.in = recording_;
  job.out = scratch_ / "out.c3d";
  job.selection.select = {"LHEE"};
  const auto out = run_convert(job);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_THAT(out->warnings, Contains(HasSubstr("1 edit of")));
  EXPECT_THAT(io::read_markers(job.out)->markers.names, ElementsAre("LHEE"));
  job.merged = {scratch_ / "other.c3d"};
  job.edits = journal_;
  EXPECT_THAT(run_convert(job).error().message, HasSubstr("is of one recording"));
}

}  // namespace
}  // namespace kinemark::pipeline
