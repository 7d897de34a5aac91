// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/foreign_number.h"

#include <gtest/gtest.h>

#include <bit>

namespace kinemark::data {
namespace {

ForeignParameter stored(std::int8_t type, std::uint32_t bits, std::size_t bytes) {
  ForeignParameter out{.name = "X", .type = type, .dims = {}, .values = {}, .description = {}};
  for (std::size_t k = 0; k < bytes; ++k) out.values.push_back(static_cast<std::byte>(bits >> (8 * k)));
  return out;
}

TEST(ForeignNumber, FloatsAndWholeNumbersOfTwoBytes) {
  EXPECT_EQ(number_of(stored(4, std::bit_cast<std::uint32_t>(81.5F), 4)), 81.5);
  EXPECT_EQ(number_of(stored(2, 59, 2)), 59.0);
  EXPECT_EQ(number_of(stored(2, 0xFFFF, 2)), -1.0);
  auto one = stored(2, 7, 2);
  one.dims = {1};
  EXPECT_EQ(number_of(one), 7.0);
}

TEST(ForeignNumber, NoOtherIsOne) {
  EXPECT_FALSE(number_of(stored(-1, 59, 2)));
  EXPECT_FALSE(number_of(stored(1, 59, 1)));
  EXPECT_FALSE(number_of(stored(4, 59, 2))) << "cut off";
  auto several = stored(2, 7, 2);
  several.dims = {2};
  EXPECT_FALSE(number_of(several));
}

}  // namespace
}  // namespace kinemark::data
