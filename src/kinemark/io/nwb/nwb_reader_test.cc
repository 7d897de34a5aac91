// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Reading in a process of its own: whatever that process does, there is one sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// A program that does that, in place of the one that reads.
Result<NwbFile> read_by(const std::string& shell) {
  const testing_support::ScratchFolder scratch;
  EXPECT_TRUE(write_text(scratch / "x.nwb", "anything", false));
  EXPECT_TRUE(write_text(scratch / "program", "#!/bin/sh\n" + shell + "\n", false));
  fs::permissions(scratch / "program", fs::perms::owner_all);
  ::setenv("KINEMARK_NWB_READER", (scratch / "program").c_str(), 1);
  auto file = read_nwb(scratch / "x.nwb");
  ::unsetenv("KINEMARK_NWB_READER");
  return file;
}

void expect_damaged(const std::string& shell, const char* words) {
  const auto file = read_by(shell);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, Code::bad_input);
  EXPECT_THAT(file.error().message, HasSubstr(words));
  EXPECT_THAT(file.error().message, HasSubstr("x.nwb: HDF5"));
  EXPECT_THAT(file.error().message, HasSubstr("the file is damaged. Nothing was read."));
}

TEST(NwbReader, ACrashIsOneSentence) {
  expect_damaged("kill -SEGV $$", "HDF5 crashed on it (signal 11)");
  expect_damaged("kill -ABRT $$", "HDF5 crashed on it (signal 6)");
}

TEST(NwbReader, TimeThatRunsOutIsOneSentence) {
  expect_damaged("kill -XCPU $$", "HDF5 did not come to an end with it in 5 s");
}

TEST(NwbReader, AnAnswerOfAnotherKindIsNotCalledDamage) {
  for (const char* shell : {"exit 0", "echo nonsense", "head -c 100000 /dev/zero", "yes"}) {
    const auto file = read_by(shell);
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, Code::bad_input);
    EXPECT_THAT(file.error().message, HasSubstr("kinemark-nwb does not answer as expected"));
    EXPECT_THAT(file.error().message, Not(HasSubstr("HDF5")));
  }
  expect_damaged("exit 3", "HDF5 could not read it");
}

TEST(NwbReader, WhatItSaysOnStandardErrorIsNotSeen) {
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(read_by("echo noise >&2"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(NwbReader, AProgramThatCannotBeStartedIsOneSentence) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "x.nwb", "anything", false));
  ::setenv("KINEMARK_NWB_READER", "/absent/program", 1);
  const auto file = read_nwb(scratch / "x.nwb");
  ::unsetenv("KINEMARK_NWB_READER");
  EXPECT_EQ(file.error().code, Code::io);
  EXPECT_THAT(file.error().message, HasSubstr("/absent/program cannot be started (No such file"));
}

TEST(NwbReader, LimitsAreThoseOfTheFile) {
  const auto file =
      read_by("test \"$2\" = 5 && test \"$3\" = $((1073741824 + 256 * 8)) && kill -SEGV $$; kill -ABRT $$");
  EXPECT_THAT(file.error().message, HasSubstr("signal 11"));
}

}  // namespace
}  // namespace kinemark::io
