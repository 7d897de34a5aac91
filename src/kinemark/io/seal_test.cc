// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/seal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSet = "0123456789abcdef";

/// A sealed text as it stands in its file, written in pieces.
std::string sealed(const std::string& head, const std::string& rest) {
  const testing_support::ScratchFolder scratch;
  auto file = OutputFile::create(scratch / "a.txt", false);
  EXPECT_TRUE(file);
  EXPECT_TRUE(file->write_sealed(head));
  for (const char c : rest) EXPECT_TRUE(file->write(std::string_view(&c, 1)));
  EXPECT_TRUE(file->commit());
  return read_text(scratch / "a.txt").value();
}

TEST(Seal, IsWholeAsWritten) {
  const auto text = sealed("# " + sealed_mark(kSet) + "\n", "a = 1\n");
  EXPECT_EQ(check_seal(text), Seal::whole);
  EXPECT_THAT(text, HasSubstr("kinemark_set=0123456789abcdef kinemark_sum="));
  EXPECT_EQ(text, sealed("# " + sealed_mark(kSet) + "\n", "a = 1\n")) << "the same text has the same sum";
}

// Every bit of a file, the sum's own among them: what is left of the key no longer names a sum.
TEST(Seal, AnyFlippedBitBreaksItOrItsKey) {
  const auto text = sealed("x\nkinemark_sum=0000000000000000\n", "0.25\t1\n");
  const auto at = text.find(kSumKey);
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    auto flipped = text;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    const bool in_key = bit / 8 >= at && bit / 8 <= at + kSumKey.size() + kNoSum.size();
    const auto found = check_seal(flipped);
    EXPECT_NE(found, Seal::whole) << bit;
    EXPECT_TRUE(in_key || found == Seal::broken) << bit;
  }
}

TEST(Seal, CutAndLongerTextsBreakIt) {
  const auto text = sealed("kinemark_sum=0000000000000000\n", "1\n2\n3\n");
  EXPECT_EQ(check_seal(text.substr(0, text.size() - 2)), Seal::broken);
  EXPECT_EQ(check_seal(text + "4\n"), Seal::broken);
}

TEST(Seal, TextsWithoutASumHaveNone) {
  for (const char* text :
       {"", "kinemark_sum", "kinemark_sum=", "kinemark_sum=0123", "kinemark_sum=0123456789abcdeg",
        "kinemark_sum=0123456789ABCDEF", "sum=0123456789abcdef"})
    EXPECT_EQ(check_seal(text), Seal::none) << text;
  EXPECT_EQ(check_seal(std::string(1 << 20, ' ') + "kinemark_sum=0123456789abcdef"), Seal::none)
      << "it stands at the beginning";
  EXPECT_EQ(sealed_mark(""), "");
}

TEST(Seal, IsFoundBehindSignsOfAnyFormat) {
  for (const char* text : {"kinemark_sum=0123456789abcdef", "\"kinemark_sum\": \"0123456789abcdef\"",
                           "kinemark_sum kinemark_sum = 0123456789abcdef"})
    EXPECT_EQ(std::string_view(text).substr(find_mark(text, kSumKey), 16), "0123456789abcdef") << text;
}

TEST(Seal, ATextOfOneCallIsSealedToo) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_sealed_text(scratch / "a.json", R"({"kinemark_sum": "0000000000000000"})", false));
  EXPECT_EQ(check_seal(read_text(scratch / "a.json").value()), Seal::whole);
}

}  // namespace
}  // namespace kinemark::io
