// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/staging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

TEST(Staging, FilesAppearTogetherOnCommit) {
  const testing_support::ScratchFolder scratch;
  {
    auto staging = Staging::create({scratch / "a", scratch / "b"}, {}, {}).value();
    ASSERT_TRUE(io::write_text(staging.path(0), "A", false));
    ASSERT_TRUE(io::write_text(staging.path(1), "B", false));
    EXPECT_FALSE(fs::exists(scratch / "a"));
    ASSERT_TRUE(staging.commit());
  }
  EXPECT_EQ(io::read_text(scratch / "a").value(), "A");
  EXPECT_EQ(io::read_text(scratch / "b").value(), "B");
  EXPECT_EQ(scratch.count_files(), 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path()), fs::directory_iterator()), 2)
      << "no folder stays";
}

TEST(Staging, NothingStaysWithoutCommitAndOldFilesSurvive) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "a", "old", false));
  {
    auto staging = Staging::create({scratch / "a", scratch / "b"}, {.force = true}, {}).value();
    ASSERT_TRUE(io::write_text(staging.path(0), "new", false));
  }
  EXPECT_EQ(io::read_text(scratch / "a").value(), "old");
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(Staging, RefusesWhatExistsAndWhatCannotBe) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "b", "old", false));
  EXPECT_THAT(Staging::create({scratch / "a", scratch / "b"}, {}, {}).error().message,
              HasSubstr("b: exists already"));
  EXPECT_THAT(Staging::create({scratch.path()}, {.force = true}, {}).error().message,
              HasSubstr("is a folder"));
  EXPECT_EQ(Staging::create({scratch / "no" / "a"}, {.force = true}, {}).error().code, Code::io);
  EXPECT_THAT(
      Staging::create({scratch / "a", scratch / "x" / ".." / "a"}, {.force = true}, {}).error().message,
      HasSubstr("would be written twice"));
}

TEST(Staging, AFolderThatCannotBeWrittenIsFoundBeforeTheWork) {
  const testing_support::ScratchFolder scratch;
  const auto staging = Staging::create({scratch / "a", scratch / "no" / "b"}, {}, {});
  ASSERT_FALSE(staging);
  EXPECT_THAT(staging.error().message, HasSubstr("no/b: cannot be written"));
  EXPECT_TRUE(fs::is_empty(scratch.path())) << "the hidden folder beside a is gone again";
}

TEST(Staging, WithoutForceAFileThatCameInTheMeantimeWinsAndNoneOfOursAppears) {
  const testing_support::ScratchFolder scratch;
  auto staging = Staging::create({scratch / "a", scratch / "b", scratch / "c"}, {}, {}).value();
  for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(io::write_text(staging.path(i), "ours", false));
  ASSERT_TRUE(io::write_text(scratch / "b", "theirs", false));
  const auto failed = staging.commit();
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, Code::io);
  EXPECT_THAT(failed.error().message, HasSubstr("b: exists already"));
  EXPECT_FALSE(fs::exists(scratch / "a"));
  EXPECT_FALSE(fs::exists(scratch / "c"));
  EXPECT_EQ(io::read_text(scratch / "b").value(), "theirs");
}

TEST(Staging, WhatCannotAllBeReplacedIsNotReplacedInPart) {
  const testing_support::ScratchFolder scratch;
  for (const char* name : {"a", "b"}) ASSERT_TRUE(io::write_text(scratch / name, "old", false));
  {
    auto staging =
        Staging::create({scratch / "a", scratch / "b", scratch / "c"}, {.force = true}, {}).value();
    for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(io::write_text(staging.path(i), "new", false));
    fs::create_directory(scratch / "c");
    fs::create_directory(scratch / "c" / "not empty");
    ASSERT_FALSE(staging.commit());
    for (const char* name : {"a", "b"}) EXPECT_EQ(io::read_text(scratch / name).value(), "old");
  }
  EXPECT_TRUE(fs::is_directory(scratch / "c" / "not empty"));
}

TEST(Staging, AnInputIsNoTargetEvenWithForce) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "in", "precious", false));
  fs::create_symlink("in", scratch / "link");
  for (const char* name : {"in", "link"}) {
    const auto refused =
        Staging::create({scratch / "out", scratch / name}, {.force = true}, {scratch / "in"});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::usage);
  }
}

TEST(Staging, LinksAreFollowedWithForce) {
  const testing_support::ScratchFolder scratch;
  fs::create_directory(scratch / "sub");
  fs::create_symlink("sub/a", scratch / "a");
  EXPECT_FALSE(Staging::create({scratch / "a"}, {}, {}));
  auto staging = Staging::create({scratch / "a"}, {.force = true}, {}).value();
  ASSERT_TRUE(io::write_text(staging.path(0), "new", false));
  ASSERT_TRUE(staging.commit());
  EXPECT_TRUE(fs::is_symlink(scratch / "a"));
  EXPECT_EQ(io::read_text(scratch / "sub/a").value(), "new");
}

TEST(Staging, AFailureNamesTheTargetNotTheHiddenFile) {
  const testing_support::ScratchFolder scratch;
  const auto staging = Staging::create({scratch / "a", scratch / "b"}, {}, {}).value();
  const auto failed = staging.failure({Code::io, staging.path(1).string() + ": cannot be written"});
  EXPECT_EQ(failed.error().message, (scratch / "b").string() + ": cannot be written");
  EXPECT_EQ(failed.error().code, Code::io);
}

TEST(Staging, TargetsInSeveralFoldersAreStagedBesideEach) {
  const testing_support::ScratchFolder scratch;
  fs::create_directory(scratch / "sub");
  auto staging = Staging::create({scratch / "a", scratch / "sub" / "b"}, {}, {}).value();
  EXPECT_EQ(staging.path(0).parent_path().parent_path(), scratch.path());
  EXPECT_EQ(staging.path(1).parent_path().parent_path(), scratch / "sub");
  ASSERT_TRUE(io::write_text(staging.path(1), "B", false));
  ASSERT_TRUE(staging.commit());
  EXPECT_EQ(io::read_text(scratch / "sub" / "b").value(), "B");
}

TEST(StagingInFolder, MakesTheFolderAndItStaysWithTheFiles) {
  const testing_support::ScratchFolder scratch;
  {
    auto staging = Staging::create_in(scratch / "new/deeper", {"a", "b"}, {}, {}).value();
    EXPECT_TRUE(fs::is_directory(scratch / "new/deeper"));
    ASSERT_TRUE(io::write_text(staging.path_of(scratch / "new/deeper/b"), "B", false));
    EXPECT_EQ(staging.written(), std::vector<fs::path>{scratch / "new/deeper/b"});
    ASSERT_TRUE(staging.commit());
  }
  EXPECT_EQ(io::read_text(scratch / "new/deeper/b").value(), "B");
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(StagingInFolder, WithoutFilesTheFolderGoesAgain) {
  const testing_support::ScratchFolder scratch;
  {
    auto staging = Staging::create_in(scratch / "new/deeper", {"a"}, {}, {}).value();
    ASSERT_TRUE(io::write_text(staging.path(0), "A", false));
  }
  EXPECT_FALSE(fs::exists(scratch / "new"));
  fs::create_directory(scratch / "there");
  ASSERT_TRUE(Staging::create_in(scratch / "there", {"a"}, {}, {}));
  EXPECT_TRUE(fs::exists(scratch / "there")) << "it was there before";
}

TEST(StagingInFolder, SaysWhichFolderCannotBeMade) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "file", "mine", false));
  const auto refused = Staging::create_in(scratch / "file/new", {"a"}, {}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("file/new: cannot be made"));
  const auto taken = Staging::create_in(scratch / "file", {"a"}, {}, {});
  ASSERT_FALSE(taken) << "a file is no folder";
  EXPECT_EQ(taken.error().code, Code::io);
  EXPECT_EQ(io::read_text(scratch / "file").value(), "mine");
}

TEST(StagingErrors, AFolderOrAFileInTheWayIsNamed) {
  const testing_support::ScratchFolder scratch;
  fs::create_directory(scratch / "folder");
  EXPECT_THAT(Staging::create({scratch / "folder"}, {.force = true}, {}).error().message,
              HasSubstr("is a folder; need a file"));
  EXPECT_THAT(Staging::create({scratch / "none/a"}, {}, {}).error().message,
              HasSubstr("none/a: cannot be written"));
  ASSERT_TRUE(io::write_text(scratch / "old", "old", false));
  const auto exists = Staging::create({scratch / "new", scratch / "old"}, {}, {});
  EXPECT_EQ(exists.error().code, Code::io);
  EXPECT_THAT(exists.error().message, HasSubstr("old: exists already; use --force"));
  const auto twice = Staging::create({scratch / "a", scratch / "x/../a"}, {}, {});
  EXPECT_EQ(twice.error().code, Code::usage);
  EXPECT_THAT(twice.error().message, HasSubstr("would be written twice"));
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(StagingErrors, AFailureNamesTheTarget) {
  const testing_support::ScratchFolder scratch;
  const auto staging = Staging::create({scratch / "a", scratch / "b"}, {}, {}).value();
  const Error error{Code::io, staging.path(1).string() + ": no space left"};
  EXPECT_EQ(staging.failure(error).error().message, (scratch / "b").string() + ": no space left");
  EXPECT_EQ(staging.failure({Code::io, "elsewhere: odd"}).error().message, "elsewhere: odd");
}

TEST(StagingMore, FilesThatAreAddedAppearWithTheOthers) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "in", "recorded", false));
  {
    auto staging = Staging::create({scratch / "a"}, {}, {scratch / "in"}).value();
    ASSERT_TRUE(staging.add_in(scratch / "new/figures", {"one.svg", "two.svg"}));
    ASSERT_TRUE(staging.add_page(scratch / "page.html"));
    ASSERT_TRUE(staging.add_page(""));
    EXPECT_EQ(staging.add({scratch / "x/../a"}).error().code, Code::usage) << "twice";
    EXPECT_EQ(staging.add({scratch / "in"}).error().code, Code::usage) << "it is read";
    EXPECT_THAT(staging.add_page(scratch / "page.pdf").error().message, HasSubstr("a page ends in .html"));
    ASSERT_EQ(staging.targets().size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) ASSERT_TRUE(io::write_text(staging.path(i), "new", false));
    EXPECT_EQ(scratch.count_files(), 5);
    EXPECT_FALSE(fs::exists(scratch / "a"));
    ASSERT_TRUE(staging.commit());
  }
  for (const char* name : {"a", "new/figures/one.svg", "new/figures/two.svg", "page.html"})
    EXPECT_EQ(io::read_text(scratch / name).value(), "new");
  EXPECT_EQ(scratch.count_files(), 5);
}

TEST(StagingMore, OneThatCannotAppearKeepsAllFromIt) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "a", "old", false));
  {
    auto staging = Staging::create({scratch / "a"}, {.force = true}, {}).value();
    ASSERT_TRUE(staging.add_in(scratch / "new/figures", {"one.svg"}));
    ASSERT_TRUE(staging.add_page(scratch / "page.html"));
    for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(io::write_text(staging.path(i), "new", false));
    fs::create_directories(scratch / "new/figures/one.svg/not empty");
    ASSERT_FALSE(staging.commit());
    fs::remove_all(scratch / "new/figures/one.svg");
  }
  EXPECT_EQ(io::read_text(scratch / "a").value(), "old");
  EXPECT_FALSE(fs::exists(scratch / "page.html"));
  EXPECT_FALSE(fs::exists(scratch / "new"));
}

TEST(StagingMore, AStagedFileHasTheNameOfItsTarget) {
  const testing_support::ScratchFolder scratch;
  fs::create_directory(scratch / "sub");
  for (const char* name : {"x", "y"}) {
    ASSERT_TRUE(io::write_text(scratch / "sub" / name, "old", false));
    fs::create_directory(scratch / (std::string("from_") + name));
    fs::create_symlink(std::string("../sub/") + name, scratch / (std::string("from_") + name) / "a.trc");
  }
  const auto staging =
      Staging::create({scratch / "from_x/a.trc", scratch / "from_y/a.trc"}, {.force = true}, {}).value();
  EXPECT_EQ(staging.path(0).filename(), "a.trc") << "some formats name themselves";
  EXPECT_NE(staging.path(1), staging.path(0));
  EXPECT_EQ(staging.path(1).extension(), ".trc");
}

TEST(Staging, WhatTheCallerKeepsIsNoTargetUnderAnyName) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "in", "recorded", false));
  fs::create_symlink("in", scratch / "link");
  fs::create_hard_link(scratch / "in", scratch / "second");
  for (const char* name : {"in", "link", "second"}) {
    const auto refused =
        Staging::create({scratch / name}, {.force = true, .kept = {"", "NAME=x", scratch / "in"}}, {});
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message, HasSubstr("is the file that is read as"));
  }
}

TEST(Staging, AnInputThatIsKnownLaterIsNotReplaced) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "in", "recorded", false));
  fs::create_symlink("in", scratch / "link");
  auto staging = Staging::create({scratch / "new", scratch / "link"}, {.force = true}, {}).value();
  ASSERT_TRUE(io::write_text(staging.path(0), "made", false));
  ASSERT_TRUE(io::write_text(staging.path(1), "made", false));
  staging.add_inputs(std::vector<data::InputFile>{{.role = "forces", .path = (scratch / "in").string()}});
  const auto refused = staging.commit();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::usage);
  EXPECT_EQ(io::read_text(scratch / "in").value(), "recorded");
  EXPECT_FALSE(fs::exists(scratch / "new")) << "all of the set or none";
}

}  // namespace
}  // namespace kinemark::pipeline
