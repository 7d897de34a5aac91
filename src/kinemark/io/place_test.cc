// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>
#include <vector>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

void put(const fs::path& path, std::string_view text) { ASSERT_TRUE(write_text(path, text, true)); }

TEST(PlaceFile, NeverReplacesWithoutForce) {
  const testing_support::ScratchFolder scratch;
  put(scratch / "new", "new");
  put(scratch / "old", "old");
  const auto refused = place_file(scratch / "new", scratch / "old", false);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("old: exists already; use --force"));
  EXPECT_EQ(read_text(scratch / "old").value(), "old");
  EXPECT_EQ(place_file(scratch / "new", scratch / "free", false).value(), Replaced::nothing);
  EXPECT_EQ(read_text(scratch / "free").value(), "new");
}

TEST(PlaceFile, WhatIsExchangedComesBack) {
  const testing_support::ScratchFolder scratch;
  put(scratch / "new", "new");
  put(scratch / "old", "old");
  const auto replaced = place_file(scratch / "new", scratch / "old", true, true);
  ASSERT_TRUE(replaced);
  EXPECT_EQ(read_text(scratch / "old").value(), "new");
  if (*replaced == Replaced::gone) return;  // a file system that cannot exchange
  unplace_file(scratch / "new", scratch / "old", *replaced);
  EXPECT_EQ(read_text(scratch / "old").value(), "old");
  EXPECT_EQ(read_text(scratch / "new").value(), "new");
}

TEST(PlaceFile, WhatReplacedNothingGoesBack) {
  const testing_support::ScratchFolder scratch;
  put(scratch / "new", "new");
  const auto replaced = place_file(scratch / "new", scratch / "free", true, true);
  ASSERT_EQ(replaced.value(), Replaced::nothing);
  unplace_file(scratch / "new", scratch / "free", *replaced);
  EXPECT_FALSE(fs::exists(scratch / "free"));
  EXPECT_EQ(read_text(scratch / "new").value(), "new");
}

TEST(PlaceFile, OfManyThreadsThatWriteOneFileExactlyOneWins) {
  const testing_support::ScratchFolder scratch;
  for (int round = 0; round < 50; ++round) {
    const fs::path path = scratch / std::to_string(round);
    std::vector<int> won(4);
    {
      std::vector<std::jthread> writers;
      for (int& mine : won)
        writers.emplace_back([&path, &mine] { mine = write_text(path, "text", false).has_value(); });
    }
    EXPECT_EQ(won[0] + won[1] + won[2] + won[3], 1);
  }
}

TEST(FindTarget, FollowsLinksWithForceAndRefusesThemWithout) {
  const testing_support::ScratchFolder scratch;
  fs::create_directory(scratch / "folder");
  fs::create_symlink("folder/file", scratch / "dangling");
  fs::create_symlink("dangling", scratch / "twice");
  fs::create_symlink("folder", scratch / "to_folder");
  fs::create_symlink("round", scratch / "round");
  for (const char* link : {"dangling", "twice"}) {
    EXPECT_THAT(find_target(scratch / link, false).error().message, HasSubstr("exists already"));
    EXPECT_EQ(find_target(scratch / link, true).value(), scratch / "folder/file");
  }
  EXPECT_THAT(find_target(scratch / "to_folder", true).error().message, HasSubstr("to_folder: is a folder"));
  EXPECT_THAT(find_target(scratch / "to_folder", false).error().message, HasSubstr("to_folder: is a folder"));
  EXPECT_THAT(find_target(scratch / "round", true).error().message, HasSubstr("leads to itself"));
  EXPECT_EQ(find_target(scratch / "free", false).value(), scratch / "free");
}

TEST(FindTarget, AWrittenLinkStaysALink) {
  const testing_support::ScratchFolder scratch;
  put(scratch / "old", "old");
  fs::create_symlink("old", scratch / "link");
  put(scratch / "link", "new");
  EXPECT_TRUE(fs::is_symlink(scratch / "link"));
  EXPECT_EQ(read_text(scratch / "old").value(), "new");
}

TEST(FindTarget, DevicesAndPipesAreNotReplaced) {
  const testing_support::ScratchFolder scratch;
  ASSERT_EQ(::mkfifo((scratch / "pipe").c_str(), 0600), 0);
  for (const fs::path& path : {scratch / "pipe", fs::path("/dev/null")})
    EXPECT_THAT(find_target(path, true).error().message, HasSubstr("is not a regular file"));
}

TEST(SyncFolder, AFolderIsSyncedAndOneThatIsNotThereIsNoFailure) {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(sync_folder(scratch.path()));
  EXPECT_TRUE(sync_folder({}));
  EXPECT_TRUE(sync_folder(scratch / "absent"));
}

TEST(CheckBelow, ASetupWritesInItsOwnFolderAndBelow) {
  const testing_support::ScratchFolder scratch;
  fs::create_directories(scratch / "setups/sub");
  fs::create_directories(scratch / "elsewhere");
  fs::create_directory_symlink("../elsewhere", scratch / "setups/leads_out");
  fs::create_symlink("../elsewhere/q.mot", scratch / "setups/dangling.mot");
  const fs::path setup = scratch / "setups/setup.xml";
  for (const char* good : {"q.mot", "sub/q.mot", "new/deeper/q.mot", "sub/../q.mot"})
    EXPECT_TRUE(check_below(setup, scratch / "setups" / good, "output_motion_file")) << good;
  for (const char* bad :
       {"../q.mot", "/tmp/q.mot", "leads_out/q.mot", "dangling.mot", "sub/../../q.mot", "../setups2/q"}) {
    const auto refused = check_below(setup, scratch / "setups" / bad, "output_motion_file");
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message, HasSubstr("outside the setup's own folder; give --output"));
  }
}

}  // namespace
}  // namespace kinemark::io
