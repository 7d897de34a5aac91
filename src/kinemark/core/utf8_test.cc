// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/utf8.h"

#include <gtest/gtest.h>

#include "kinemark/core/random.h"

namespace kinemark {
namespace {

constexpr const char* kUnknown = "\xEF\xBF\xBD";  // U+FFFD

TEST(Utf8, KnowsWholeCharacters) {
  for (const char* good : {"", "A", "é", "Ω", "€", "𝄞", "épaule_d"}) EXPECT_TRUE(is_utf8(good)) << good;
  EXPECT_EQ(utf8_length("a€", 1), 3U);
  for (const char* bad : {"\xE9", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82",
                          "\x80", "\xFF", "caf\xE9"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(Utf8, OtherBytesAreLatin1) {
  EXPECT_EQ(to_utf8("Fu\xDF"), "Fuß");
  EXPECT_EQ(to_utf8("Fuß"), "Fuß") << "what is UTF-8 stays";
}

TEST(Utf8, NamesHoldNoControlCharacter) {
  EXPECT_EQ(name_of_bytes(" LASI  "), "LASI");
  EXPECT_EQ(name_of_bytes("A\x1B[31mB\x7F"), "A [31mB");
  EXPECT_EQ(name_of_bytes("\xC9paule\x9B"), "Épaule") << "a C1 control";
  EXPECT_EQ(name_of_bytes(std::string_view("\0\1", 2)), "");
  EXPECT_EQ(name_of_bytes("knee angle r"), "knee angle r");
  EXPECT_EQ(name_of_bytes("肩"), "肩");
}

TEST(Utf8, WhatIsPrintedIsValidAndSafe) {
  EXPECT_EQ(printable("A\x1B[2J"), std::string("A") + kUnknown + "[2J");
  EXPECT_EQ(printable("a\nb"), std::string("a") + kUnknown + "b");
  EXPECT_EQ(printable("\xC2\x9B"), kUnknown) << "C1";
  EXPECT_EQ(printable("\xE2\x80\xAE"), kUnknown) << "right-to-left override";
  EXPECT_EQ(printable("\xC2\xAD"), kUnknown) << "soft hyphen";
  EXPECT_EQ(printable("\xE2\x81\xA3"), kUnknown) << "invisible separator";
  EXPECT_EQ(printable("\xF3\xA0\x81\x81"), kUnknown) << "tag";
  EXPECT_EQ(printable("\xD9\x85\xE2\x80\x8C\xD9\x85"), "\xD9\x85\xE2\x80\x8C\xD9\x85")
      << "a joiner in a word";
  EXPECT_EQ(printable("x\xE9.trc"), std::string("x") + kUnknown + ".trc");
  EXPECT_EQ(printable("plain é"), "plain é");
}

TEST(Utf8, LongTextLosesItsMiddle) {
  EXPECT_EQ(printable("0123456789", 10), "0123456789");
  EXPECT_EQ(printable("0123456789A", 10), "0123...89A");
  EXPECT_EQ(printable("ééééééééééé", 10), "éééé...ééé") << "characters, not bytes";
}

TEST(Utf8, SentencesKeepTheirWords) {
  const std::string name(100'000, 'M');
  const auto said = printable_sentence("a.trc: line 4: marker '" + name + "' occurs twice");
  EXPECT_LT(said.size(), 400U);
  EXPECT_TRUE(said.starts_with("a.trc: line 4: marker 'MMM"));
  EXPECT_TRUE(said.ends_with("MM' occurs twice"));
  EXPECT_EQ(printable_sentence("two  blanks, one at the end "), "two  blanks, one at the end ");
  EXPECT_EQ(printable_sentence(""), "");
  std::string words;
  for (int i = 0; i < 10'000; ++i) words += "word ";
  EXPECT_LE(printable_sentence(words).size(), 4000U);
}

TEST(Utf8, AnyBytesBecomeValid) {
  Random random(7, 0);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes;
    for (int k = 0; k < 24; ++k) bytes += static_cast<char>(static_cast<int>(random.uniform(0.0, 256.0)));
    EXPECT_TRUE(is_utf8(to_utf8(bytes)));
    EXPECT_TRUE(is_utf8(name_of_bytes(bytes)));
    EXPECT_TRUE(is_utf8(printable(bytes, 9)));
    EXPECT_TRUE(is_utf8(printable_sentence(bytes)));
  }
}

}  // namespace
}  // namespace kinemark
