// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/glyphs.h"

#include <gtest/gtest.h>

namespace kinemark::screens {
namespace {

TEST(Glyphs, ThereAndBackForEveryLengthOfUtf8) {
  const std::u32string given = U"aé€😀⣿";
  std::string text;
  for (const char32_t code : given) append_utf8(code, text);
  EXPECT_EQ(text, "aé€😀⣿");
  EXPECT_EQ(glyphs_of(text), given);
}

TEST(Glyphs, BytesThatAreNoUtf8BecomeTheReplacementCharacter) { EXPECT_EQ(glyphs_of("a\xff"), U"a\uFFFD"); }

}  // namespace
}  // namespace kinemark::screens
