// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <vector>

#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

TEST(OutputFile, AppearsWholeAndOnlyAfterCommit) {
  const testing_support::ScratchFolder scratch;
  const fs::path path = scratch / "a.txt";
  {
    auto file = OutputFile::create(path, false).value();
    ASSERT_TRUE(file.write("half"));
    EXPECT_FALSE(fs::exists(path));
    ASSERT_TRUE(file.write(" done"));
    ASSERT_TRUE(file.commit());
  }
  EXPECT_EQ(read_text(path).value(), "half done");
  EXPECT_EQ(scratch.count_files(), 1) << "no temporary file stays";
}

TEST(OutputFile, LeavesNothingWithoutCommitAndKeepsTheOldFile) {
  const testing_support::ScratchFolder scratch;
  const fs::path path = scratch / "a.txt";
  ASSERT_TRUE(write_text(path, "old", false));
  {
    auto file = OutputFile::create(path, true).value();
    ASSERT_TRUE(file.write("new"));
  }
  EXPECT_EQ(read_text(path).value(), "old");
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(OutputFile, RefusesToOverwriteUnlessForced) {
  const testing_support::ScratchFolder scratch;
  const fs::path path = scratch / "a.txt";
  ASSERT_TRUE(write_text(path, "old", false));
  const auto refused = write_text(path, "new", false);
  EXPECT_EQ(refused.error().code, Code::io);
  EXPECT_THAT(refused.error().message, HasSubstr("--force"));
  ASSERT_TRUE(write_text(path, "new", true));
  EXPECT_EQ(read_text(path).value(), "new");
}

TEST(OutputFile, AFullDiskIsOneSentenceAndLeavesNothing) {
  const testing_support::ScratchFolder scratch;
  // A file-size limit makes write() fail as a full disk does, without filling one.
  struct rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = old;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto status = write_text(scratch / "big.txt", std::string(100000, 'x'), false);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::io);
  EXPECT_THAT(status.error().message, HasSubstr("big.txt: cannot be written"));
  EXPECT_EQ(scratch.count_files(), 0);
}

TEST(InputFile, SaysWhyItCannotOpen) {
  const testing_support::ScratchFolder scratch;
  const auto missing = InputFile::open(scratch / "no.c3d");
  EXPECT_EQ(missing.error().code, Code::io);
  EXPECT_THAT(missing.error().message, HasSubstr("no.c3d: cannot be opened (No such file"));
  EXPECT_THAT(InputFile::open(scratch.path()).error().message, HasSubstr("not a regular file"));
  EXPECT_THAT(write_text(scratch / "no" / "x.txt", "", false).error().message,
              HasSubstr("cannot be written"));
}

TEST(InputFile, ReadsAnywhereAndStopsAtTheEnd) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "n", "0123456789", false));
  const auto file = InputFile::open(scratch / "n").value();
  EXPECT_EQ(file.size(), 10U);
  std::vector<std::byte> buffer(6);
  EXPECT_EQ(file.read_at(2, buffer).value(), 6U);
  EXPECT_EQ(static_cast<char>(buffer[0]), '2');
  EXPECT_EQ(file.read_at(7, buffer).value(), 3U);
  EXPECT_EQ(file.read_at(99, buffer).value(), 0U);
  EXPECT_THAT(read_text(scratch / "n", 5).error().message, HasSubstr("10 bytes; at most 5"));
  EXPECT_EQ(read_begin(scratch / "n").value(), read_text(scratch / "n").value());
  EXPECT_EQ(read_begin(scratch / "none").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
