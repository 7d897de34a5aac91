// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text_input.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

TEST(TextInput, ReadsWhatIsText) {
  const testing_support::ScratchFolder scratch;
  std::string large;
  while (large.size() < (3UL << 20)) large += "a line of text\n";
  for (const std::string& text : {std::string(), std::string("A\tB\n"), std::string(5000, 'x'), large}) {
    ASSERT_TRUE(write_text(scratch / "a.txt", text, true));
    EXPECT_EQ(read_lines_of_text(scratch / "a.txt").value(), text);
  }
  EXPECT_THAT(read_lines_of_text(scratch / "a.txt", 2UL << 20).error().message, HasSubstr("at most 2097152"));
  EXPECT_EQ(read_lines_of_text(scratch / "absent").error().code, Code::io);
}

TEST(TextInput, WhatFillsUpTheEndOfAFileIsNoText) {
  const testing_support::ScratchFolder scratch;
  for (const std::string& end :
       {std::string(512, '\0'), std::string("\x1A"), std::string("\x1A") + std::string(100, '\0')}) {
    ASSERT_TRUE(write_text(scratch / "a.trc", "A\tB\n" + end, true));
    EXPECT_EQ(read_lines_of_text(scratch / "a.trc").value(), "A\tB\n");
  }
  ASSERT_TRUE(write_text(scratch / "a.trc", std::string("A\0B\n", 4), true));
  EXPECT_EQ(read_lines_of_text(scratch / "a.trc").value().size(), 4U)
      << "a zero inside is for the reader to refuse";
  const std::string utf16("A\0\t\0B\0\n\0", 8);
  ASSERT_TRUE(write_text(scratch / "a.trc", "\xFF\xFE" + utf16, true));
  EXPECT_EQ(read_lines_of_text(scratch / "a.trc").value(), "A\tB\n");
}

TEST(TextInput, JudgesHugeFilesByTheirFirstMegabyte) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "zeros.trc", "", false));
  std::filesystem::resize_file(scratch / "zeros.trc", 1ULL << 40);  // a hole: takes no room
  const auto zeros = read_lines_of_text(scratch / "zeros.trc");
  EXPECT_EQ(zeros.error().code, Code::bad_input);
  EXPECT_THAT(zeros.error().message, HasSubstr("byte 1 is zero"));
  ASSERT_TRUE(write_text(scratch / "line.csv", std::string(2UL << 20, 'a'), false));
  EXPECT_THAT(read_lines_of_text(scratch / "line.csv").error().message, HasSubstr("first line has more"));
}

}  // namespace
}  // namespace kinemark::io
