// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/regular_file.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

void expect_refused(const std::filesystem::path& path, const char* kind) {
  const auto status = check_regular(path);
  ASSERT_FALSE(status) << path;
  EXPECT_EQ(status.error().code, Code::bad_input);
  EXPECT_THAT(status.error().message, HasSubstr(path.string() + ": is " + kind));
  // Nobody waits: every reader comes through this door.
  EXPECT_EQ(InputFile::open(path).error().message, status.error().message);
}

TEST(RegularFile, WhatIsNoneIsRefusedByName) {
  const testing_support::ScratchFolder scratch;
  ASSERT_EQ(::mkfifo((scratch / "fifo.trc").c_str(), 0600), 0);
  expect_refused(scratch / "fifo.trc", "a pipe (FIFO)");
  std::filesystem::create_symlink(scratch / "fifo.trc", scratch / "link.trc");
  expect_refused(scratch / "link.trc", "a pipe (FIFO)");
  expect_refused(scratch.path(), "a folder");
  expect_refused("/dev/zero", "a device");
}

TEST(RegularFile, ASocketIsRefused) {
  const testing_support::ScratchFolder scratch;
  const auto path = scratch / "s";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.string().size(), sizeof(address.sun_path));
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  expect_refused(path, "a socket");
  ::close(fd);
}

TEST(RegularFile, FilesAndWhatIsNotThereAreLeftAlone) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a.txt", "A", false));
  std::filesystem::create_symlink(scratch / "a.txt", scratch / "b.txt");
  EXPECT_TRUE(check_regular(scratch / "a.txt"));
  EXPECT_TRUE(check_regular(scratch / "b.txt"));
  EXPECT_TRUE(check_regular(scratch / "absent"));
  EXPECT_EQ(InputFile::open(scratch / "absent").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
