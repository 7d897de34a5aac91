// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_files.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <array>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class FilesOfTrials : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder_); }
  void write(const std::string& name, const std::string& text = "x", bool force = true) {
    ASSERT_TRUE(io::write_text(folder_ / name, text, force));
  }
  static std::vector<std::string> names(const TrialListing& listing) {
    std::vector<std::string> names;
    for (const auto& trial : listing.trials) names.push_back(trial.path.filename().string());
    return names;
  }
  testing_support::ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_ / "study";
};

TEST_F(FilesOfTrials, AFolderIsLookedAtAgainAndNumbersStay) {
  write("b.c3d");
  TrialFiles files({folder_});
  const auto first = files.list();
  ASSERT_THAT(names(first), ElementsAre("b.c3d"));
  EXPECT_EQ(first.trials[0].number, 1U);
  write("a.trc");
  const auto second = files.list();
  ASSERT_THAT(names(second), ElementsAre("a.trc", "b.c3d"));
  EXPECT_EQ(second.trials[0].number, 2U);
  EXPECT_EQ(second.trials[1].number, 1U);
  std::filesystem::remove(folder_ / "b.c3d");
  EXPECT_THAT(names(files.list()), ElementsAre("a.trc"));
  EXPECT_EQ(files.path_of(1), folder_ / "b.c3d") << "its page says that it is gone";
  write("b.c3d");
  EXPECT_EQ(files.list().trials[1].number, 1U);
}

TEST_F(FilesOfTrials, NumbersAreThoseOfTheListAndNoOthers) {
  write("a.trc");
  TrialFiles files({folder_});
  EXPECT_EQ(files.path_of(1), std::nullopt) << "nobody has seen the list";
  (void)files.list();
  EXPECT_EQ(files.path_of(0), std::nullopt);
  EXPECT_EQ(files.path_of(1), folder_ / "a.trc");
  EXPECT_EQ(files.path_of(2), std::nullopt);
  EXPECT_EQ(files.path_of(4294967295U), std::nullopt);
}

TEST_F(FilesOfTrials, WhatBelongsToAnotherFileIsNoTrialOfItsOwn) {
  for (const char* name :
       {"q.mot", "q_sd.sto", "q_marker_errors.sto", "q_report.json", "q_tau.sto", "q_tau_sd.sto",
        "q_bound.sto", "q_rank.sto", "q_marker_locations.sto", "w.c3d", "w_derivatives.sto", "alone_sd.sto",
        "forces.sto", "model.osim", "counts.mcap", ".hidden.trc", "notes.txt"})
    write(name);
  EXPECT_THAT(names(TrialFiles({folder_}).list()),
              ElementsAre("alone_sd.sto", "counts.mcap", "forces.sto", "q.mot", "w.c3d"));
  EXPECT_THAT(names(TrialFiles({folder_ / "q_sd.sto", folder_ / "model.osim"}).list()),
              ElementsAre("q_sd.sto", "model.osim"))
      << "who gives it wants it";
}

TEST_F(FilesOfTrials, ALinkOutOfTheFolderIsANoteAndNoTrial) {
  namespace fs = std::filesystem;
  fs::create_directory(scratch_ / "private");
  ASSERT_TRUE(io::write_text(scratch_ / "private/diary.trc", "dear diary", true));
  write("a.trc");
  write("b.trc");
  fs::create_symlink("../private/diary.trc", folder_ / "out.trc");
  fs::create_symlink(scratch_ / "private/none.trc", folder_ / "lost.trc");
  fs::create_symlink("a.trc", folder_ / "within.trc");
  fs::create_symlink("../private/diary.trc", folder_ / "b_edits.jsonl");
  TrialFiles files({folder_});
  const auto listing = files.list();
  EXPECT_THAT(names(listing), ElementsAre("a.trc", "within.trc"));
  EXPECT_THAT(listing.notes,
              ::testing::Contains(::testing::HasSubstr("out.trc: a link leads out of the folder")));
  EXPECT_THAT(listing.notes,
              ::testing::Contains(::testing::HasSubstr("b.trc: a link leads out of the folder")));
  for (const auto& note : listing.notes) EXPECT_THAT(note, ::testing::Not(::testing::HasSubstr("diary")));
  // One that becomes a link after it was listed.
  fs::remove(folder_ / "a.trc");
  fs::create_symlink("../private/diary.trc", folder_ / "a.trc");
  EXPECT_FALSE(files.path_of(1));
  EXPECT_THAT(names(TrialFiles({folder_ / "out.trc"}).list()), ElementsAre("out.trc"))
      << "it was given itself";
}

TEST_F(FilesOfTrials, AFileGivenTwiceIsOneTrial) {
  write("a.trc");
  write("b.trc");
  const auto listing = TrialFiles({folder_ / "b.trc", folder_, folder_ / "b.trc"}).list();
  EXPECT_THAT(names(listing), ElementsAre("b.trc", "a.trc"));
}

TEST_F(FilesOfTrials, AFolderThatIsEmptyOrGoneIsANote) {
  TrialFiles files({folder_});
  EXPECT_THAT(files.list().notes, ElementsAre(HasSubstr("holds no file")));
  std::filesystem::remove(folder_);
  const auto listing = files.list();
  EXPECT_THAT(listing.notes, SizeIs(listing.trials.empty() ? 1 : 0));
}

TEST_F(FilesOfTrials, CheckGivenNamesWhatIsNotThere) {
  write("a.trc");
  EXPECT_TRUE(check_given({folder_, folder_ / "a.trc"}));
  const auto absent = check_given({folder_, folder_ / "absent.trc"});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Code::io);
  EXPECT_THAT(absent.error().message, HasSubstr("absent.trc: cannot be opened"));
  std::filesystem::create_directory(folder_ / "empty");
  const auto empty = check_given({folder_ / "empty"});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Code::bad_input);
}

TEST_F(FilesOfTrials, AStampIsAnotherForAnotherContent) {
  write("a.mot", "one");
  const auto before = stamps_of(folder_ / "a.mot");
  ASSERT_TRUE(before.front());
  EXPECT_EQ(before.front()->bytes, 3);
  EXPECT_EQ(before, stamps_of(folder_ / "a.mot"));
  write("a.mot", "four");
  const auto after = stamps_of(folder_ / "a.mot");
  EXPECT_NE(before, after);
  write("a_report.json", "{}");
  EXPECT_NE(after, stamps_of(folder_ / "a.mot")) << "a companion came";
  std::filesystem::remove(folder_ / "a.mot");
  EXPECT_FALSE(stamps_of(folder_ / "a.mot").front());
}

TEST_F(FilesOfTrials, AStampSeesAContentWhoseTimeWasPutBack) {
  write("a.trc", "one");
  const auto before = stamps_of(folder_ / "a.trc");
  struct stat found{};
  ASSERT_EQ(::stat((folder_ / "a.trc").c_str(), &found), 0);
  write("a.trc", "two");
  const std::array<timespec, 2> times{found.st_atim, found.st_mtim};
  ASSERT_EQ(::utimensat(AT_FDCWD, (folder_ / "a.trc").c_str(), times.data(), 0), 0);
  EXPECT_EQ(before.front()->changed_ns, stamps_of(folder_ / "a.trc").front()->changed_ns);
  EXPECT_NE(before, stamps_of(folder_ / "a.trc"));
}

}  // namespace
}  // namespace kinemark::server
