// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/edits/edit_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::Edit;
using data::EditKind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const data::EditedRecording kWalk{.name = "walk.c3d", .bytes = 1000, .hash = "0123456789abcdef"};
const data::EditedRecording kRun{.name = "run.c3d", .bytes = 1000, .hash = "0123456789abcdee"};

Edit cut_of(const std::string& marker) { return {.kind = EditKind::cut, .marker = marker}; }

class EditJournalTest : public ::testing::Test {
 protected:
  EditJournal open(const data::EditedRecording& recording = kWalk, bool force = false) {
    auto journal = EditJournal::open(path_, recording, force);
    EXPECT_TRUE(journal) << journal.error().message;
    return std::move(*journal);
  }
  /// A journal with so many edits; its text.
  std::string made_of(int edits) {
    auto journal = open();
    for (int i = 0; i < edits; ++i) EXPECT_TRUE(journal.append(cut_of("M" + std::to_string(i))));
    return text();
  }
  [[nodiscard]] std::string text() const { return read_text(path_).value(); }
  void put(const std::string& bytes) const { ASSERT_TRUE(write_text(path_, bytes, true)); }
  [[nodiscard]] std::string why_not() const {
    const auto read = read_edits(path_);
    EXPECT_FALSE(read);
    return read ? "" : read.error().message;
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_.path() / "walk_edits.jsonl";
};

TEST_F(EditJournalTest, HoldsWhatWasAppended) {
  {
    auto journal = open();
    EXPECT_THAT(journal.list().edits, IsEmpty());
    ASSERT_TRUE(journal.append(cut_of("A")));
    ASSERT_TRUE(journal.append({.kind = EditKind::swap, .marker = "A", .other = "B", .author = "me"}));
    ASSERT_TRUE(journal.undo(1, "2026-11-24T09:30:00Z"));
  }
  const auto journal = open();
  const auto& edits = journal.list().edits;
  ASSERT_EQ(edits.size(), 3U);
  EXPECT_EQ(edits[0].id, "1");
  EXPECT_EQ(edits[1].author, "me");
  EXPECT_EQ(edits[2].made, "2026-11-24T09:30:00Z");
  EXPECT_EQ(edits[2].line, 4);
  EXPECT_THAT(journal.list().in_force().value(), ElementsAre(0));
  EXPECT_TRUE(journal.list().recording.same_bytes(kWalk));
}

TEST_F(EditJournalTest, IsOnlyAppendedTo) {
  auto journal = open();
  EXPECT_FALSE(std::filesystem::exists(path_)) << "who only looks makes no file";
  ASSERT_TRUE(journal.append(cut_of("first")));
  std::string before = text();
  const auto check_grown = [&] {
    const auto now = text();
    EXPECT_TRUE(now.starts_with(before) && now.size() > before.size());
    before = now;
  };
  ASSERT_TRUE(journal.append(cut_of("A")));
  check_grown();
  ASSERT_TRUE(journal.undo());
  check_grown();
  ASSERT_TRUE(journal.redo());
  check_grown();
}

TEST_F(EditJournalTest, RefusesWhatCannotBeAndStaysAsItWas) {
  auto journal = open();
  ASSERT_TRUE(journal.append(cut_of("A")));
  const auto before = text();
  EXPECT_THAT(journal.append(cut_of("")).error().message, HasSubstr("needs a marker"));
  EXPECT_THAT(journal.undo(2).error().message, HasSubstr("line 3: undo of 2 operations, where there is 1"));
  EXPECT_THAT(journal.redo().error().message, HasSubstr("nothing left"));
  auto again = cut_of("B");
  again.id = "1";
  EXPECT_THAT(journal.append(again).error().message, HasSubstr("id '1' is an earlier operation's"));
  EXPECT_EQ(text(), before);
  EXPECT_EQ(journal.list().edits.size(), 1U);
  again.id = "2";
  ASSERT_TRUE(journal.append(again));
  ASSERT_TRUE(journal.append(cut_of("C")));
  EXPECT_EQ(journal.list().edits.back().id, "3") << "the next number that is free";
}

TEST_F(EditJournalTest, OneWriterAtATime) {
  auto journal = open();
  auto meanwhile = open();
  ASSERT_TRUE(journal.append(cut_of("0")));
  EXPECT_THAT(meanwhile.append(cut_of("1")).error().message, HasSubstr("exists already"));
  const auto second = EditJournal::open(path_, kWalk);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Code::io);
  EXPECT_THAT(second.error().message, HasSubstr("is being edited by another program"));
  ASSERT_TRUE(journal.append(cut_of("A"))) << "the first goes on";
  EXPECT_EQ(read_edits(path_)->list.edits.size(), 2U) << "reading needs no lock";
  EditJournal moved = std::move(journal);
  EXPECT_FALSE(EditJournal::open(path_, kWalk)) << "the lock goes with the journal";
  ASSERT_TRUE(moved.append(cut_of("B")));
}

TEST_F(EditJournalTest, IsOfOneRecording) {
  made_of(1);
  const auto other = EditJournal::open(path_, kRun);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Code::bad_input);
  EXPECT_THAT(other.error().message, HasSubstr("'walk.c3d' of 1000 bytes, 0123456789abcdef"));
  EXPECT_THAT(other.error().message, HasSubstr("'run.c3d'"));
  auto renamed = kWalk;
  renamed.name = "other.c3d";
  EXPECT_TRUE(EditJournal::open(path_, renamed)) << "the same bytes";
  auto forced = open(kRun, true);
  ASSERT_TRUE(forced.append(cut_of("B")));
  EXPECT_TRUE(forced.list().recording.same_bytes(kWalk));
}

// Cut anywhere behind the first line, what is whole counts and the rest is said.
TEST_F(EditJournalTest, ATornLastLineIsLeftOut) {
  const auto whole = made_of(3);
  const auto first = whole.find('\n') + 1;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const auto part = whole.substr(0, size);
    const auto read = parse_edits(part, "x");
    ASSERT_EQ(read.has_value(), size >= first) << size;
    if (!read) {
      EXPECT_THAT(read.error().message, HasSubstr("x: line 1: needs"));
      continue;
    }
    const bool torn = !part.ends_with('\n');
    EXPECT_EQ(static_cast<std::int64_t>(read->list.edits.size()), std::ranges::count(part, '\n') - 1);
    EXPECT_EQ(read->notes.size(), torn ? 1U : 0U);
    EXPECT_EQ(read->whole_bytes, part.rfind('\n') + 1);
  }
}

TEST_F(EditJournalTest, GoesOnBehindATornLine) {
  const auto whole = made_of(3);
  put(whole.substr(0, whole.size() - 5));
  {
    auto journal = open();
    EXPECT_THAT(journal.notes(), ElementsAre(HasSubstr("line 4 was not written to its end and is left out")));
    EXPECT_EQ(journal.list().edits.size(), 2U);
    ASSERT_TRUE(journal.append(cut_of("new")));
  }
  const auto journal = open();
  EXPECT_THAT(journal.notes(), IsEmpty());
  EXPECT_EQ(journal.list().edits.back().marker, "new");
  // Zeros of a file system that grew the file before its bytes came are such a line too.
  put(text() + std::string(4096, '\0'));
  EXPECT_EQ(read_edits(path_)->notes.size(), 1U);
}

TEST_F(EditJournalTest, DamageInTheMiddleIsRefusedWithItsLine) {
  const auto whole = made_of(3);
  auto damaged = whole;
  damaged[damaged.find("M1")] = 'N';
  put(damaged);
  EXPECT_THAT(why_not(), HasSubstr("walk_edits.jsonl: line 3: its checksum is"));
  EXPECT_FALSE(EditJournal::open(path_, kWalk));
  EXPECT_EQ(text(), damaged) << "what is damaged stays as it is";
  damaged = whole;
  damaged.erase(damaged.find("M1") - 20, 30);
  put(damaged);
  EXPECT_THAT(why_not(), HasSubstr("line 3"));
  put(whole + "{\"do\":\"cut\",\"marker\":\"typed\"}\n\n");
  EXPECT_EQ(read_edits(path_)->list.edits.back().marker, "typed") << "by hand, without a checksum";
  put(whole + with_sum(R"({"id":"2","do":"cut","marker":"A"})") + "\n");
  EXPECT_THAT(why_not(), HasSubstr("line 5: id '2' is an earlier operation's"));
  put(whole + R"({"do":"undo","count":9})" + "\n");
  EXPECT_THAT(why_not(), HasSubstr("line 5: undo of 9 operations, where there are 3"));
  put(whole + "{" + std::string(70'000, ' ') + "}\n");
  EXPECT_THAT(why_not(), HasSubstr("line 5: 70002 bytes"));
  put("");
  EXPECT_THAT(why_not(), HasSubstr("line 1: needs"));
  put("walk.c3d\n");
  EXPECT_THAT(why_not(), HasSubstr("line 1: is no JSON object"));
}

TEST_F(EditJournalTest, NoFileNoFolderNoRight) {
  auto absent = EditJournal::open(scratch_.path() / "no" / "x_edits.jsonl", kWalk);
  ASSERT_TRUE(absent) << absent.error().message;
  EXPECT_EQ(absent->append(cut_of("A")).error().code, Code::io);
  EXPECT_THAT(absent->list().edits, IsEmpty());
  const auto folder = EditJournal::open(scratch_.path(), kWalk);
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().message, HasSubstr(scratch_.path().string()));
  EXPECT_EQ(read_edits(scratch_.path() / "no_edits.jsonl").error().code, Code::io);
}

// A file that may not grow: the edit is refused, nothing of it stays, and what fits goes on.
TEST_F(EditJournalTest, AFullDiskLosesNothing) {
  auto journal = open();
  ASSERT_TRUE(journal.append(cut_of("A")));
  const auto before = text();
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto on_excess = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = before.size() + 20, .rlim_max = old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto full = journal.append(cut_of("B"));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  (void)std::signal(SIGXFSZ, on_excess);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, Code::io);
  EXPECT_THAT(full.error().message, HasSubstr("the edit cannot be written"));
  EXPECT_EQ(text(), before);
  ASSERT_TRUE(journal.append(cut_of("C")));
  EXPECT_EQ(read_edits(path_)->list.edits.back().marker, "C");
}

}  // namespace
}  // namespace kinemark::io
