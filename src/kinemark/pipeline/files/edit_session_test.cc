// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/edit_session.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/stages/trajectory/edits/testing/edited.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using data::Edit;
using data::EditKind;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class EditSessionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_markers(recording_, trajectory::testing::moving_trial(), false));
  }
  [[nodiscard]] EditSession open(const EditSessionOptions& options = {}) const {
    auto session = EditSession::open(recording_, options);
    EXPECT_TRUE(session) << session.error().message;
    return std::move(*session);
  }
  static void good(EditSession& session, const Edit& edit) {
    const auto made = session.append(edit, session.outcome().list.edits.size());
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(*made);
  }
  /// What the edits make of the recording when all is read anew.
  [[nodiscard]] std::size_t anew() const {
    data::Recording read{.trial = io::read_marker_input({.path = recording_}).value().trial};
    EXPECT_TRUE(take_edits({.edits = io::kEditsBeside, .recording = recording_}, read));
    return digest(read.trial);
  }
  /// Of all bytes, as a failure would print them.
  static std::size_t digest(const data::Trial& trial) {
    return std::hash<std::string>{}(trajectory::testing::bytes_of(trial));
  }
  static std::size_t bytes(const EditSession& session) { return digest(session.now()); }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path recording_ = scratch_ / "walk.c3d";
  std::filesystem::path journal_ = scratch_ / "walk_edits.jsonl";
  Edit swap_{.kind = EditKind::swap, .marker = "LKNE", .other = "RKNE", .first_frame = 600};
  Edit cut_{.kind = EditKind::cut, .marker = "RKNE", .first_frame = 511, .last_frame = 530};
};

TEST_F(EditSessionTest, MakesOneOperationAfterTheOther) {
  const auto original = io::read_text(recording_).value();
  auto session = open();
  EXPECT_FALSE(std::filesystem::exists(journal_)) << "nothing is written before the first edit";
  EXPECT_THAT(session.all_changes(), IsEmpty());
  good(session, swap_);
  EXPECT_THAT(session.last_changes(), SizeIs(2));
  good(session, cut_);
  ASSERT_THAT(session.last_changes(), SizeIs(1));
  EXPECT_EQ(session.last_changes()[0].went, 20);
  EXPECT_THAT(session.all_changes(), SizeIs(2));
  EXPECT_EQ(bytes(session), anew());
  EXPECT_EQ(bytes(session), bytes(open()));
  EXPECT_EQ(session.outcome().digest, open().outcome().digest);
  EXPECT_EQ(io::read_text(recording_).value(), original) << "the recording is only read";
}

TEST_F(EditSessionTest, UndoAndRedoComeBackToTheSameBits) {
  auto session = open();
  const auto recorded = bytes(session);
  good(session, swap_);
  const auto swapped = bytes(session);
  good(session, {.kind = EditKind::fill, .marker = "LKNE", .method = "cubic"});
  const auto filled = bytes(session);
  EXPECT_NE(filled, swapped);
  good(session, {.kind = EditKind::undo});
  EXPECT_EQ(bytes(session), swapped);
  EXPECT_EQ(session.last_changes()[0].went, 20) << "an undo has changes too";
  good(session, {.kind = EditKind::undo});
  EXPECT_EQ(bytes(session), recorded);
  EXPECT_THAT(session.all_changes(), IsEmpty());
  good(session, {.kind = EditKind::redo, .count = 2});
  EXPECT_EQ(bytes(session), filled);
  EXPECT_EQ(session.outcome().in_force.size(), 2U);
  EXPECT_EQ(session.outcome().list.edits.size(), 5U);
}

TEST_F(EditSessionTest, KeepsNoMoreStatesThanItMay) {
  auto session = open({.most_kept_bytes = 1});
  for (int i = 0; i < 4; ++i) {
    good(session, swap_);
    EXPECT_EQ(bytes(session), anew());
  }
  const auto& now = session.now().markers;
  const auto positions = (now.x_in_world.size() + now.unfiltered_in_world.size()) * sizeof(double);
  EXPECT_LT(session.bytes(), 2 * 2 * positions) << "as it was read, and as it is";
  good(session, {.kind = EditKind::undo, .count = 3});
  EXPECT_EQ(bytes(session), anew());
}

TEST_F(EditSessionTest, WhatCannotBeAppliedChangesNothing) {
  auto session = open();
  good(session, swap_);
  const auto journal = io::read_text(journal_).value();
  const auto before = bytes(session);
  for (const auto& [edit, why] : std::vector<std::pair<Edit, std::string>>{
           {{.kind = EditKind::cut, .marker = "NOSE"}, "NOSE"},
           {{.kind = EditKind::cut}, "marker"},
           {{.kind = EditKind::unfill, .marker = "LKNE"}, "new edit: unfill"},
           {{.kind = EditKind::redo}, "redo"},
           {{.kind = EditKind::undo, .count = 2}, "undo"}}) {
    const auto made = session.append(edit, 1);
    ASSERT_FALSE(made);
    EXPECT_NE(made.error().code, Code::io);
    EXPECT_THAT(made.error().message, HasSubstr(why));
  }
  EXPECT_EQ(io::read_text(journal_).value(), journal);
  EXPECT_EQ(bytes(session), before);
}

TEST_F(EditSessionTest, SeesWhatOthersAppendAndWritesNothingOnTopOfIt) {
  auto one = open(), other = open();
  good(one, swap_);
  auto made = other.append(cut_, 0);
  ASSERT_TRUE(made);
  EXPECT_FALSE(*made) << "it believed that there was none";
  EXPECT_EQ(bytes(other), bytes(one)) << "and has seen it since";
  good(other, cut_);
  ASSERT_TRUE(one.refresh());
  EXPECT_EQ(bytes(one), bytes(other));
  EXPECT_EQ(one.outcome().list.edits.size(), 2U);
}

TEST_F(EditSessionTest, AJournalThatIsWrongLeavesWhatThereWas) {
  auto session = open();
  good(session, swap_);
  const auto before = bytes(session);
  const auto whole = io::read_text(journal_).value();
  ASSERT_TRUE(io::write_text(journal_, whole + "nonsense\n", true));
  const auto refreshed = session.refresh();
  ASSERT_FALSE(refreshed);
  EXPECT_THAT(refreshed.error().message, HasSubstr("walk_edits.jsonl: line 3"));
  EXPECT_EQ(bytes(session), before);
  EXPECT_FALSE(session.append(cut_, 1));
  EXPECT_FALSE(EditSession::open(recording_));
  ASSERT_TRUE(io::write_text(journal_, whole, true));
  good(session, cut_);
}

TEST_F(EditSessionTest, AJournalOfAnotherRecordingIsRefused) {
  auto session = open();
  good(session, swap_);
  auto trial = trajectory::testing::moving_trial();
  trial.markers.x(0, 0).x() += 1.0;
  ASSERT_TRUE(io::write_markers(recording_, trial, true));
  const auto opened = EditSession::open(recording_);
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("these edits are of"));
}

TEST_F(EditSessionTest, ARecordingWithoutARateIsRefused) {
  ASSERT_TRUE(
      io::write_text(scratch_ / "a.amc", "#c\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n", false));
  EXPECT_FALSE(EditSession::open(scratch_ / "a.amc"));
}

TEST_F(EditSessionTest, AnyOrderOfOperationsIsAsReadAnew) {
  Random random(11, 0);
  auto session = open({.most_kept_bytes = 100'000});
  const std::vector<Edit> edits{swap_,
                                cut_,
                                {.kind = EditKind::fill, .marker = "RKNE", .method = "linear"},
                                {.kind = EditKind::undo},
                                {.kind = EditKind::redo},
                                {.kind = EditKind::unfill, .marker = "RKNE"},
                                {.kind = EditKind::crop, .first_frame = 505},
                                {.kind = EditKind::undo, .count = 2}};
  int made = 0;
  for (int i = 0; i < 60; ++i) {
    const auto& edit = edits[static_cast<std::size_t>(random.uniform() * static_cast<double>(edits.size()))];
    const auto done = session.append(edit, session.outcome().list.edits.size());
    if (!done) continue;
    ++made;
    ASSERT_EQ(bytes(session), anew()) << i << ": " << describe(edit);
  }
  EXPECT_GT(made, 20);
}

}  // namespace
}  // namespace kinemark::pipeline
