// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/output_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(CheckApart, AnOutputIsNoInputUnderAnyName) {
  const testing_support::ScratchFolder scratch;
  const fs::path input = scratch / "in";
  ASSERT_TRUE(io::write_text(input, "x", false));
  fs::create_symlink("in", scratch / "link");
  fs::create_hard_link(input, scratch / "second");
  fs::create_directory(scratch / "folder");
  for (const char* name : {"in", "link", "second", "folder/../in"}) {
    const auto refused = check_apart({scratch / "other", scratch / name}, {scratch / "absent", input});
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, Code::usage);
    EXPECT_THAT(refused.error().message,
                HasSubstr((scratch / name).string() + ": is the file that is read as"));
  }
  EXPECT_TRUE(check_apart({scratch / "out", ""}, {input, "", scratch / "absent"}));
}

TEST(CheckApart, AJobKeepsWhatItsCallerGives) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "in", "x", false));
  const JobSettings job{.force = true, .kept = {scratch / "in"}};
  EXPECT_FALSE(check_apart(job, {scratch / "in"}, {}));
  EXPECT_TRUE(check_apart(job, {scratch / "out"}, {}));
  EXPECT_FALSE(check_apart(JobSettings{}, {scratch / "in"}, {scratch / "in"}));
}

TEST(CheckEnding, NamesWhatIsWritten) {
  EXPECT_TRUE(check_ending("a/q.MOT", {".mot", ".sto"}, "joint angles are"));
  EXPECT_TRUE(check_ending("a/q", {".mot"}, "joint angles are"));
  EXPECT_TRUE(check_ending("", {".mot"}, "joint angles are"));
  const auto refused = check_ending("a/q.nwb", {".mot", ".sto"}, "joint angles are");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::usage);
  EXPECT_EQ(refused.error().message,
            "a/q.nwb: joint angles are written as .mot or .sto; '.nwb' is another ending");
}

TEST(CheckFolder, RefusesTheNameOfAFileUnlessAFolderHasIt) {
  EXPECT_TRUE(check_folder("", "tables are"));
  EXPECT_TRUE(check_folder("day 1.2", "tables are")) << "no ending of a file";
  EXPECT_EQ(check_folder("a.c3d", "tables are").error().message,
            "a.c3d: tables are written into a folder; '.c3d' is the ending of a file");
  const testing_support::ScratchFolder scratch;
  std::filesystem::create_directory(scratch / "b.csv");
  EXPECT_TRUE(check_folder(scratch / "b.csv", "tables are"));
  EXPECT_FALSE(check_folder(scratch / "c.csv", "tables are"));
}

}  // namespace
}  // namespace kinemark::pipeline
