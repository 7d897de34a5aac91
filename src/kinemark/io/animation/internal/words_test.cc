// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/internal/words.h"

#include <gtest/gtest.h>

namespace kinemark::io::animation {
namespace {

TEST(TextLines, CountsLinesOfEveryEndAndPassesOverBlankOnes) {
  for (const std::string_view text : {"\xEF\xBB\xBF a \n\n\tb\n", "a\r\n \r\nb", "a\r\rb\r"}) {
    TextLines lines(text);
    std::string_view line;
    EXPECT_EQ(lines.peek(), "a");
    ASSERT_TRUE(lines.next(line));
    EXPECT_EQ(line, "a");
    EXPECT_EQ(lines.number(), 1);
    EXPECT_EQ(lines.peek(), "b");
    ASSERT_TRUE(lines.next(line));
    EXPECT_EQ(line, "b");
    EXPECT_EQ(lines.number(), 3);
    EXPECT_FALSE(lines.next(line));
    EXPECT_EQ(lines.peek(), "");
  }
}

TEST(TakeWord, TakesOneAfterAnother) {
  std::string_view line = " JOINT\tLeft  Hip ";
  EXPECT_EQ(take_word(line), "JOINT");
  EXPECT_EQ(take_word(line), "Left");
  EXPECT_EQ(take_word(line), "Hip");
  EXPECT_EQ(take_word(line), "");
}

TEST(TakeNumber, SaysWhatWasExpectedAndWhere) {
  std::string_view line = "1.5e1 nan";
  EXPECT_EQ(take_number(line, 3, "the length").value(), 15.0);
  EXPECT_EQ(take_number(line, 3, "the length").error().message,
            "line 3: the length is 'nan'; expected a number");
  EXPECT_EQ(take_number(line, 3, "the length").error().message, "line 3: ends before the length");
}

TEST(InQuotes, IsShortAndSafe) {
  EXPECT_EQ(in_lower_case("End SITE"), "end site");
  EXPECT_EQ(in_quotes("a\x1b"), "'a\xEF\xBF\xBD'");
  EXPECT_LE(in_quotes(std::string(1000, 'x')).size(), 42U);
}

}  // namespace
}  // namespace kinemark::io::animation
