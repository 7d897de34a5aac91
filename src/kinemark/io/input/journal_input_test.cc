// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/journal_input.h"

#include <gmock/gmock.h>

#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::EditKind;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class JournalInputTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_text(recording_, "what was recorded", false)); }
  void append(const std::vector<data::Edit>& edits) {
    auto journal = EditJournal::open(journal_, identify_recording(recording_).value());
    ASSERT_TRUE(journal) << journal.error().message;
    for (const auto& edit : edits) ASSERT_TRUE(journal->append(edit));
  }
  Result<Journal> read(const std::filesystem::path& edits, bool force = false) {
    return read_journal({.edits = edits, .recording = recording_, .force = force});
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path recording_ = scratch_ / "walk.c3d", journal_ = scratch_ / "walk_edits.jsonl";
};

TEST_F(JournalInputTest, LiesBesideItsRecording) {
  EXPECT_EQ(edits_of("a/walk.c3d"), "a/walk_edits.jsonl");
  EXPECT_EQ(edits_of("walk"), "walk_edits.jsonl");
  const auto identity = identify_recording(recording_).value();
  EXPECT_EQ(identity.name, "walk.c3d");
  EXPECT_EQ(identity.hash, hash_file(recording_)->hex);
  EXPECT_FALSE(identify_recording(scratch_ / "no.c3d"));
}

TEST_F(JournalInputTest, HoldsWhatIsInForceAndItsOwnRecord) {
  append({{.kind = EditKind::cut, .marker = "RKNE"},
          {.kind = EditKind::cut, .marker = "SACR"},
          {.kind = EditKind::undo}});
  const auto journal = read(journal_).value();
  ASSERT_EQ(journal.in_force.size(), 1U);
  EXPECT_EQ(journal.in_force[0].marker, "RKNE");
  EXPECT_EQ(journal.digest, digest_of(journal.in_force));
  EXPECT_EQ(journal.file->role, "edits");
  EXPECT_EQ(journal.file->hash, hash_file(journal_)->hex);
  EXPECT_THAT(journal.notes, IsEmpty());
}

TEST_F(JournalInputTest, BesideMayBeAbsentANameMayNot) {
  EXPECT_FALSE(read(kEditsBeside)->file);
  EXPECT_FALSE(read(kEditsNone)->file);
  EXPECT_FALSE(read("")->file) << "none asked for";
  EXPECT_EQ(read(journal_).error().code, Code::io);
  append({{.kind = EditKind::cut, .marker = "RKNE"}});
  EXPECT_TRUE(read(kEditsBeside)->file);
  EXPECT_FALSE(read(kEditsNone)->file);
}

TEST_F(JournalInputTest, OfAnotherFileOfThatNameIsLeftToIt) {
  append({{.kind = EditKind::cut, .marker = "RKNE"}});
  const auto other = scratch_ / "walk.trc";
  ASSERT_TRUE(write_text(other, "another", false));
  const auto journal = read_journal({.edits = kEditsBeside, .recording = other}).value();
  EXPECT_FALSE(journal.file);
  EXPECT_THAT(journal.in_force, IsEmpty());
  EXPECT_THAT(journal.notes, ElementsAre(EndsWith("is of 'walk.c3d' and is not applied")));
}

TEST_F(JournalInputTest, OfAnotherRecordingIsRefusedUnlessForced) {
  append({{.kind = EditKind::cut, .marker = "RKNE"}});
  ASSERT_TRUE(write_text(recording_, "recorded once more", true));
  for (const auto& edits : {journal_, std::filesystem::path(kEditsBeside)}) {
    const auto refused = read(edits);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::bad_input);
    EXPECT_THAT(refused.error().message, HasSubstr("these edits are of 'walk.c3d'"));
    const auto forced = read(edits, true);
    ASSERT_TRUE(forced);
    EXPECT_EQ(forced->in_force.size(), 1U);
    EXPECT_THAT(forced->notes, ElementsAre(HasSubstr("were applied to another recording, ")));
  }
}

TEST_F(JournalInputTest, OnlyOneThatNobodyNamedCanBePassedOver) {
  ASSERT_TRUE(write_text(journal_, "nonsense\n", false));
  EXPECT_THAT(read(journal_).error().message, Not(HasSubstr("--edits none passes the journal over")));
  EXPECT_THAT(read(kEditsBeside).error().message, EndsWith("; --edits none passes the journal over"));
}

TEST_F(JournalInputTest, AnEditThatCannotBeAppliedFailsInTheSameWords) {
  append({{.kind = EditKind::cut, .marker = "RKNE"}});
  const Error error{.code = Code::bad_input, .message = "line 2: cut: no marker"};
  EXPECT_EQ(read(journal_)->failure(error).message, journal_.string() + ": line 2: cut: no marker");
  EXPECT_EQ(read(kEditsBeside)->failure(error).message,
            journal_.string() + ": line 2: cut: no marker; --edits none passes the journal over");
}

}  // namespace
}  // namespace kinemark::io
