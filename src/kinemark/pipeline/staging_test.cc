// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/staging.h"

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
    auto staging = Staging::create({scratch / "a", scratch / "b"}, false).value();
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
    auto staging = Staging::create({scratch / "a", scratch / "b"}, true).value();
    ASSERT_TRUE(io::write_text(staging.path(0), "new", false));
  }
  EXPECT_EQ(io::read_text(scratch / "a").value(), "old");
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(Staging, RefusesWhatExistsAndWhatCannotBe) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "b", "old", false));
  EXPECT_THAT(Staging::create({scratch / "a", scratch / "b"}, false).error().message,
              HasSubstr("b: exists already"));
  EXPECT_THAT(Staging::create({scratch.path()}, true).error().message, HasSubstr("is a folder"));
  EXPECT_EQ(Staging::create({scratch / "no" / "a"}, true).error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::pipeline
