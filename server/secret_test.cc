// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/secret.h"

#include <gmock/gmock.h>

#include <bit>
#include <set>

namespace kinemark::server {
namespace {

using ::testing::MatchesRegex;

TEST(Secret, Has128BitsThatAreNeverTheSame) {
  std::set<std::string> seen;
  int ones = 0;
  constexpr int kCount = 500;
  for (int i = 0; i < kCount; ++i) {
    const auto secret = new_secret().value();
    ASSERT_EQ(secret.size(), 32U);
    ASSERT_THAT(secret, MatchesRegex("[0-9a-f]+"));
    EXPECT_TRUE(seen.insert(secret).second);
    for (const char digit : secret)
      ones += std::popcount(static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'a' + 10));
  }
  // Bits of a fair coin: 64,000 of them, whose standard deviation is 126.
  EXPECT_NEAR(ones, kCount * 64, 6 * 126);
}

TEST(Secret, IsTheSameOnlyWithEveryLetter) {
  const std::string secret = "0123456789abcdef0123456789abcdef";
  EXPECT_TRUE(same_secret(secret, secret));
  for (std::size_t i = 0; i < secret.size(); ++i) {
    auto other = secret;
    other[i] = 'x';
    EXPECT_FALSE(same_secret(other, secret)) << i;
  }
}

TEST(Secret, IsNotAPartOrARepetition) {
  const std::string secret = "0123456789abcdef";
  EXPECT_FALSE(same_secret("", secret));
  EXPECT_FALSE(same_secret("0123456789abcde", secret));
  EXPECT_FALSE(same_secret(secret + secret, secret));
  EXPECT_FALSE(same_secret(secret + '\0', secret));
  EXPECT_FALSE(same_secret("0123456789ABCDEF", secret));
}

TEST(Secret, NothingEqualsAnEmptyOne) {
  EXPECT_FALSE(same_secret("", ""));
  EXPECT_FALSE(same_secret("a", ""));
}

}  // namespace
}  // namespace kinemark::server
