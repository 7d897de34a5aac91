// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/base64.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace kinemark::report::internal {
namespace {

std::string of_text(std::string_view text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return base64(std::span<const std::uint8_t>(bytes));
}

TEST(Base64, EncodesTheVectorsOfRfc4648) {
  EXPECT_EQ(of_text(""), "");
  EXPECT_EQ(of_text("f"), "Zg==");
  EXPECT_EQ(of_text("fo"), "Zm8=");
  EXPECT_EQ(of_text("foo"), "Zm9v");
  EXPECT_EQ(of_text("foob"), "Zm9vYg==");
  EXPECT_EQ(of_text("fooba"), "Zm9vYmE=");
  EXPECT_EQ(of_text("foobar"), "Zm9vYmFy");
}

TEST(Base64, UsesEveryDigit) {
  std::vector<std::uint8_t> bytes;
  for (int word = 0; word < 64; word += 4) {
    const unsigned bits = static_cast<unsigned>(word << 18 | (word + 1) << 12 | (word + 2) << 6 | (word + 3));
    for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(bits >> shift & 0xFFU));
  }
  EXPECT_EQ(base64(std::span<const std::uint8_t>(bytes)),
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/");
}

}  // namespace
}  // namespace kinemark::report::internal
