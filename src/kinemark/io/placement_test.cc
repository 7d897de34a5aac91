// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/placement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "kinemark/io/file.h"
#include "kinemark/io/place.h"
#include "kinemark/io/temporary.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A set of three files in two folders.
class PlaceFiles : public ::testing::Test {
 protected:
  PlaceFiles() {
    fs::create_directory(scratch_ / "sub");
    for (const char* name : {"a", "sub/b", "c"}) targets_.push_back(scratch_ / name);
  }

  void write_old() const {
    for (const auto& target : targets_) ASSERT_TRUE(write_text(target, "old", true));
  }
  /// What stands in the three, "-" for one that is not there.
  [[nodiscard]] std::string texts() const {
    std::string out;
    for (const auto& target : targets_) out += (out.empty() ? "" : " ") + read_text(target).value_or("-");
    return out;
  }

  /// New files, in hidden folders that live as long as `hidden`.
  std::vector<FileToPlace> stage(std::vector<Temporary>& hidden) const {
    hidden.push_back(Temporary::folder_for(targets_[0]).value());
    hidden.push_back(Temporary::folder_for(targets_[1]).value());
    std::vector<FileToPlace> files;
    for (std::size_t i = 0; i < 3; ++i) {
      files.push_back({hidden[i == 1 ? 1 : 0].path() / targets_[i].filename(), targets_[i]});
      EXPECT_TRUE(write_text(files.back().staged, "new", false));
    }
    return files;
  }

  /// A program that is killed when so many files of the set have their names.
  void kill_after(std::size_t count, bool force, const std::vector<fs::path>& made = {}) const {
    const pid_t child = ::fork();
    if (child == 0) {
      std::vector<Temporary> hidden;
      const auto files = stage(hidden);
      if (!record_placement(files, made)) ::_exit(98);
      for (std::size_t i = 0; i < count; ++i)
        if (!place_file(files[i].staged, files[i].target, force, true)) ::_exit(99);
      ::raise(SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
  }

  /// Names below the scratch folder that are hidden.
  [[nodiscard]] int count_hidden() const {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(scratch_.path()))
      count += entry.path().filename().string().starts_with(".kinemark-") ? 1 : 0;
    return count;
  }

  testing_support::ScratchFolder scratch_;
  std::vector<fs::path> targets_;
};

TEST_F(PlaceFiles, AllGetTheirNamesAndNothingIsLeft) {
  for (const bool force : {false, true}) {
    {
      std::vector<Temporary> hidden;
      ASSERT_TRUE(place_files(stage(hidden), force));
    }
    EXPECT_EQ(texts(), "new new new");
    EXPECT_EQ(count_hidden(), 0);
  }
}

TEST_F(PlaceFiles, WhatFailsHalfWayIsTakenBack) {
  write_old();
  fs::remove(targets_[2]);
  fs::create_directory(targets_[2]);
  {
    std::vector<Temporary> hidden;
    const auto failed = place_files(stage(hidden), true);
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message, HasSubstr("c: "));
  }
  EXPECT_EQ(texts(), "old old -");
  EXPECT_EQ(count_hidden(), 0);
}

TEST_F(PlaceFiles, ADiskThatHasNoRoomForTheRecordKeepsEveryName) {
  write_old();
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<Temporary> hidden;
    const auto files = stage(hidden);
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit few{.rlim_cur = 10, .rlim_max = 10};
    ::setrlimit(RLIMIT_FSIZE, &few);
    const auto failed = place_files(files, true);
    const bool names_a_target =
        !failed && failed.error().message.starts_with(targets_[0].string() + ": cannot be written (");
    hidden.clear();
    ::_exit(names_a_target ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(texts(), "old old old");
  EXPECT_EQ(count_hidden(), 0);
}

TEST_F(PlaceFiles, AKillBetweenTwoNamesIsTakenBackByTheNextWriterInAnyOfTheFolders) {
  for (const fs::path& writes : {scratch_ / "other", scratch_ / "sub/other"})
    for (std::size_t count = 0; count < 3; ++count) {
      for (const auto& target : targets_) fs::remove(target);
      ASSERT_NO_FATAL_FAILURE(kill_after(count, false));
      ASSERT_TRUE(write_text(writes, "other", true));
      EXPECT_EQ(texts(), "- - -") << count;
      write_old();
      ASSERT_NO_FATAL_FAILURE(kill_after(count, true));
      ASSERT_TRUE(write_text(writes, "other", true));
      EXPECT_EQ(texts(), "old old old") << count;
      // The other folder loses its hidden one with the set, or when its turn comes.
      remove_leftovers(scratch_.path());
      remove_leftovers(scratch_ / "sub");
      EXPECT_EQ(count_hidden(), 0);
    }
}

TEST_F(PlaceFiles, AKillAfterTheLastNameLeavesAll) {
  write_old();
  ASSERT_NO_FATAL_FAILURE(kill_after(3, true));
  remove_leftovers(scratch_ / "sub");
  remove_leftovers(scratch_.path());
  EXPECT_EQ(texts(), "new new new");
  EXPECT_EQ(count_hidden(), 0);
}

TEST_F(PlaceFiles, WhatWasChangedSinceStays) {
  ASSERT_NO_FATAL_FAILURE(kill_after(2, false));
  std::ofstream(targets_[0]) << "edited by hand";
  remove_leftovers(scratch_.path());
  EXPECT_EQ(texts(), "edited by hand - -");
}

TEST_F(PlaceFiles, ASetThatWasMovedIsLeftAlone) {
  write_old();
  ASSERT_NO_FATAL_FAILURE(kill_after(2, true));
  fs::rename(scratch_ / "sub", scratch_ / "moved");
  remove_leftovers(scratch_.path());
  remove_leftovers(scratch_ / "moved");
  EXPECT_EQ(read_text(targets_[0]).value(), "new");
  EXPECT_EQ(read_text(scratch_ / "moved/b").value(), "new");
  EXPECT_EQ(count_hidden(), 0);
}

TEST_F(PlaceFiles, FoldersThatWereMadeForTheSetGoWithIt) {
  const auto made = scratch_ / "sub";
  ASSERT_NO_FATAL_FAILURE(kill_after(2, false, {made}));
  remove_leftovers(made);
  EXPECT_TRUE(fs::exists(made)) << "somebody writes there";
  EXPECT_EQ(texts(), "- - -");
  ASSERT_NO_FATAL_FAILURE(kill_after(2, false, {made}));
  remove_leftovers(scratch_.path());
  EXPECT_FALSE(fs::exists(made));
  EXPECT_EQ(texts(), "- - -");
}

TEST_F(PlaceFiles, ALivingWritersSetStays) {
  write_old();
  std::vector<Temporary> hidden;
  const auto files = stage(hidden);
  ASSERT_TRUE(record_placement(files, {}));
  ASSERT_TRUE(place_file(files[0].staged, files[0].target, true, true));
  const pid_t child = ::fork();
  if (child == 0) {
    remove_leftovers(scratch_.path());
    remove_leftovers(scratch_ / "sub");
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(texts(), "new old old");
  EXPECT_TRUE(fs::exists(files[1].staged));
}

TEST_F(PlaceFiles, ADamagedOrForeignRecordTakesNothingBack) {
  write_old();
  const std::string whole = [&] {
    kill_after(1, true);
    for (const auto& entry : fs::directory_iterator(scratch_.path()))
      if (fs::exists(entry.path() / kPlacementRecord))
        return read_text(entry.path() / kPlacementRecord).value();
    return std::string();
  }();
  ASSERT_FALSE(whole.empty());
  remove_leftovers(scratch_.path());
  remove_leftovers(scratch_ / "sub");
  EXPECT_EQ(texts(), "old old old");
  // Cut anywhere, and whole in a folder that is not its own.
  for (std::size_t size = 0; size <= whole.size(); size += 7) {
    const auto hidden = scratch_ / ".kinemark-1-1";
    fs::create_directory(hidden);
    ASSERT_TRUE(write_text(hidden / kPlacementRecord, whole.substr(0, size), true));
    ASSERT_TRUE(write_text(hidden / "a", "foreign", true));
    remove_leftovers(scratch_.path());
    EXPECT_EQ(texts(), "old old old");
    EXPECT_FALSE(fs::exists(hidden));
  }
}

}  // namespace
}  // namespace kinemark::io
