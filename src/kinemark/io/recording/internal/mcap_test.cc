// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/internal/mcap.h"

#include <gtest/gtest.h>

#include <string>

namespace kinemark::io::internal {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST(Crc32, GivesThePublishedCheckValueInOnePieceAndInTwo) {
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926U);
  EXPECT_EQ(crc32(bytes_of("6789"), crc32(bytes_of("12345"))), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
}

TEST(CheckValue, DependsOnEveryByteAndOnTheCheckBefore) {
  const std::string text = "one group of records";
  const std::uint64_t value = check_value(bytes_of(text), 7);
  EXPECT_NE(value, check_value(bytes_of(text), 8));
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string other = text;
    other[i] = static_cast<char>(other[i] ^ 1);
    EXPECT_NE(value, check_value(bytes_of(other), 7)) << i;
  }
}

TEST(Numbers, AreWrittenLittleEndFirst) {
  Bytes out;
  put_u16(out, 0x0102);
  put_u32(out, 0x03040506);
  put_u64(out, 0x0708090A0B0C0D0EULL);
  put_u8(out, 0x0F);
  const std::string_view expected("\x02\x01\x06\x05\x04\x03\x0E\x0D\x0C\x0B\x0A\x09\x08\x07\x0F", 15);
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(out.data()), out.size()), expected);
  Cursor cursor(out);
  EXPECT_EQ(cursor.u16(), 0x0102);
  EXPECT_EQ(cursor.u32(), 0x03040506U);
  EXPECT_EQ(cursor.u64(), 0x0708090A0B0C0D0EULL);
  EXPECT_EQ(cursor.u8(), 0x0F);
  EXPECT_TRUE(cursor.good() && cursor.rest().empty());
}

TEST(Records, CarryTheLengthOfTheirContent) {
  Bytes out;
  {
    const RecordScope record(out, kMetadata);
    put_string(out, "name");
    put_map(out, {{"a", "1"}, {"bc", ""}});
  }
  Cursor cursor(out);
  EXPECT_EQ(cursor.u8(), kMetadata);
  EXPECT_EQ(cursor.u64(), out.size() - kRecordHead);
  EXPECT_EQ(cursor.string(), "name");
  const std::map<std::string, std::string> expected{{"a", "1"}, {"bc", ""}};
  EXPECT_EQ(cursor.map(), expected);
  EXPECT_TRUE(cursor.good() && cursor.rest().empty());
}

TEST(Cursor, IsNoLongerGoodOnceBytesAreMissing) {
  Bytes three(3, std::byte{1});
  Cursor number(three);
  EXPECT_EQ(number.u32(), 0U);
  EXPECT_FALSE(number.good());
  EXPECT_EQ(number.u8(), 0);  // nothing is taken after the failure

  Bytes lying;
  put_u32(lying, 0xFFFFFFFFU);
  put_u8(lying, 'x');
  Cursor text(lying);
  EXPECT_EQ(text.string(), "");
  EXPECT_FALSE(text.good());

  Bytes map;
  put_u32(map, 9);  // of the entries; the key alone claims more
  put_u32(map, 200);
  put_raw(map, "abcde");
  Cursor entries(map);
  EXPECT_TRUE(entries.map().empty());
  EXPECT_FALSE(entries.good());
}

}  // namespace
}  // namespace kinemark::io::internal
