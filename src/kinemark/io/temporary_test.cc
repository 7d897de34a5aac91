// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/temporary.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>

#include "support/scratch.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

/// What a process of its own leaves; how it ended.
int in_child(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(99);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST(Temporary, IsHiddenBesideItsTargetAndGoesWithItsObject) {
  const testing_support::ScratchFolder scratch;
  {
    const auto file = Temporary::file_for(scratch / "a.txt").value();
    const auto folder = Temporary::folder_for(scratch / "a.txt").value();
    EXPECT_EQ(file.path().parent_path(), scratch.path());
    EXPECT_TRUE(file.path().filename().string().starts_with(".kinemark-"));
    EXPECT_TRUE(is_temporary(file.path()));
    EXPECT_TRUE(fs::is_regular_file(file.path()));
    EXPECT_TRUE(fs::is_directory(folder.path()));
    std::ofstream(folder.path() / "inside") << "x";
    EXPECT_EQ(scratch.count_files(), 2);
  }
  EXPECT_EQ(scratch.count_files(), 0);
}

TEST(Temporary, NewFilesHaveTheRightsThatTheUserWants) {
  const testing_support::ScratchFolder scratch;
  const mode_t before = ::umask(027);
  const auto file = Temporary::file_for(scratch / "a").value();
  const auto folder = Temporary::folder_for(scratch / "a").value();
  ::umask(before);
  EXPECT_EQ(fs::status(file.path()).permissions(), static_cast<fs::perms>(0640));
  EXPECT_EQ(fs::status(folder.path()).permissions(), static_cast<fs::perms>(0700));
}

TEST(Temporary, WhatIsReleasedStays) {
  const testing_support::ScratchFolder scratch;
  {
    auto file = Temporary::file_for(scratch / "a").value();
    fs::rename(file.path(), scratch / "a");
    const auto held = hold_end();
    file.release();
  }
  EXPECT_TRUE(fs::exists(scratch / "a"));
}

TEST(Temporary, AssignedOverGoes) {
  const testing_support::ScratchFolder scratch;
  auto first = Temporary::file_for(scratch / "a").value();
  first = Temporary::file_for(scratch / "a").value();
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(Temporary, ASignalThatEndsTheProcessLeavesNothing) {
  const testing_support::ScratchFolder scratch;
  const int status = in_child([&] {
    const auto made = Temporary::watch_folder(scratch / "new");
    fs::create_directory(scratch / "new");
    const auto file = Temporary::file_for(scratch / "new" / "a").value();
    const auto folder = Temporary::folder_for(scratch / "b").value();
    std::ofstream(folder.path() / "inside") << "x";
    end_process(130);
  });
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(scratch.count_files(), 0);
}

TEST(Temporary, AFolderWithResultsStaysWhenTheProcessEnds) {
  const testing_support::ScratchFolder scratch;
  in_child([&] {
    const auto made = Temporary::watch_folder(scratch / "new");
    fs::create_directory(scratch / "new");
    std::ofstream(scratch / "new" / "result") << "x";
    end_process(130);
  });
  EXPECT_TRUE(fs::exists(scratch / "new" / "result"));
}

TEST(Temporary, TheNextWriterRemovesWhatAKilledOneLeft) {
  const testing_support::ScratchFolder scratch;
  const int status = in_child([&] {
    const auto file = Temporary::file_for(scratch / "a").value();
    const auto folder = Temporary::folder_for(scratch / "a").value();
    std::ofstream(folder.path() / "inside") << "x";
    ::raise(SIGKILL);
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(scratch.count_files(), 2);
  const auto file = Temporary::file_for(scratch / "b").value();
  EXPECT_EQ(scratch.count_files(), 1);
}

TEST(Temporary, WhatALivingWriterNeedsStays) {
  const testing_support::ScratchFolder scratch;
  const auto file = Temporary::file_for(scratch / "a").value();
  const auto folder = Temporary::folder_for(scratch / "a").value();
  in_child([&] {
    remove_leftovers(scratch.path());
    ::_exit(0);
  });
  remove_leftovers(scratch.path());
  EXPECT_TRUE(fs::exists(file.path()));
  EXPECT_TRUE(fs::exists(folder.path()));
}

TEST(Temporary, FilesOfOthersStay) {
  const testing_support::ScratchFolder scratch;
  std::ofstream(scratch / "precious") << "x";
  fs::create_symlink(scratch / "precious", scratch / ".kinemark-1-1");
  for (const char* name : {".kinemark-notes", ".kinemark-1", ".kinemark-1-x", "kinemark-1-2"})
    std::ofstream(scratch / name) << "x";
  ASSERT_EQ(::mkfifo((scratch / ".kinemark-1-3").c_str(), 0600), 0);
  const int before = scratch.count_files();
  remove_leftovers(scratch.path());
  EXPECT_EQ(scratch.count_files(), before);
}

}  // namespace
}  // namespace kinemark::io
