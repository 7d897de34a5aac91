// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rig/toml_text.h"

#include <gmock/gmock.h>

#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  const auto table = parse_toml(text, "a.toml");
  if (table) return "taken";
  EXPECT_EQ(table.error().code, Code::bad_input);
  EXPECT_TRUE(table.error().message.starts_with("a.toml: ")) << table.error().message;
  EXPECT_EQ(printable(table.error().message), table.error().message) << "one line, valid and safe";
  return table.error().message;
}

std::string repeated(const std::string& part, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += part;
  return out;
}

TEST(TomlText, DottedKeysNestAsBracketsDo) {
  EXPECT_THAT(refusal(repeated("a.", 50'000) + "a = 1"), HasSubstr("line 1: a key has more than 16 parts"));
  EXPECT_THAT(refusal("x = 1\n[" + repeated("a.", 50'000) + "a]"), HasSubstr("line 2: a key"));
  EXPECT_THAT(refusal("x = {" + repeated("a . ", 50'000) + "a = 1}"), HasSubstr("a key"));
  EXPECT_THAT(refusal(repeated("'a'.", 50'000) + "a = 1"), HasSubstr("a key"));
  EXPECT_THAT(refusal("x = " + repeated("[", 50'000)), HasSubstr("nested deeper than 16"));
  EXPECT_THAT(refusal(repeated("x={", 50'000)), HasSubstr("nested deeper than 16"));
}

TEST(TomlText, DotsThatNestNothing) {
  EXPECT_EQ(refusal("x = [" + repeated("1.5, ", 10'000) + "2.5]"), "taken");
  EXPECT_EQ(refusal("x = '''" + repeated("a.\n", 1000) + "[[[[" + repeated("[", 100) + "'''"), "taken");
  EXPECT_EQ(refusal("y = \"" + repeated("a.", 1000) + "\\\"" + repeated("[", 100) + "\""), "taken");
  EXPECT_EQ(
      refusal("# " + repeated("a.", 1000) + repeated("[", 100) + "\na.b.c.d = 1\n[e.f]\ng = [[1], [2]]"),
      "taken");
}

TEST(TomlText, FaultsHaveALine) {
  EXPECT_THAT(refusal("a = 1\nb = \n"), HasSubstr("line 2"));
  EXPECT_THAT(refusal("a = \"not closed\n"), HasSubstr("line 1"));
  EXPECT_THAT(refusal("a = '''" + repeated("x", 1000)), HasSubstr("line 1"));
  EXPECT_NE(refusal(std::string("a\0b\x1B[2J", 7)), "taken");
  EXPECT_NE(refusal("a = \"\xE9\""), "taken") << "TOML is UTF-8";
  EXPECT_EQ(read_toml("absent.toml").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
