// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/encoder.h"

#include <gtest/gtest.h>

#include "kinemark/core/check.h"
#include "kinemark/io/recording/internal/mcap.h"
#include "kinemark/io/recording/testing/small_recording.h"

namespace kinemark::io {
namespace {

using namespace internal;

std::string text(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// (operation code, content) of every record after the magic.
std::vector<std::pair<int, std::span<const std::byte>>> records_of(std::span<const std::byte> bytes) {
  std::vector<std::pair<int, std::span<const std::byte>>> out;
  Cursor cursor(bytes.subspan(kMagic.size()));
  while (cursor.rest().size() > kMagic.size()) {
    const int op = cursor.u8();
    const auto content = cursor.rest().subspan(8, cursor.u64());
    out.emplace_back(op, content);
    cursor = Cursor(cursor.rest().subspan(content.size()));
  }
  return out;
}

TEST(RecordingEncoder, BeginsWithTheMagicAndAHeaderThatNamesTheProfile) {
  Bytes out;
  RecordingEncoder encoder;
  encoder.begin(out);
  const std::string expected =
      std::string("\x89MCAP0\r\n\x01\x18\0\0\0\0\0\0\0\x08\0\0\0kinemark\x08\0\0\0kinemark", 41) +
      std::string("\x90\x08\0\0\0\0\0\0\0", 9);
  ASSERT_EQ(out.size(), expected.size() + 8);
  EXPECT_EQ(text(out).substr(0, expected.size()), expected);
  EXPECT_EQ(Cursor(std::span(out).last(8)).u64(), check_value(std::span(out).first(41), 0));
}

TEST(RecordingEncoder, WritesAMessageAsTheFormatSays) {
  Bytes out;
  RecordingEncoder encoder;
  encoder.begin(out);
  ASSERT_EQ(encoder.add_channel({.topic = "/t"}, out).value(), 0);
  const std::size_t begin = out.size();
  const std::uint64_t before = Cursor(std::span(out).last(8)).u64();
  const std::string data = "hi";
  const RecordingMessage message{0, 7, 0x0102, 0x0304, std::as_bytes(std::span(data))};
  ASSERT_TRUE(encoder.add_messages({&message, 1}, out));
  const auto group = std::span<const std::byte>(out).subspan(begin);
  const std::string expected(
      "\x05\x18\0\0\0\0\0\0\0\x01\0\x07\0\0\0\x02\x01\0\0\0\0\0\0\x04\x03\0\0\0\0\0\0hi\x90\x08\0\0\0\0\0\0"
      "\0",
      42);
  ASSERT_EQ(group.size(), 50U);
  EXPECT_EQ(text(out).substr(begin, 42), expected);
  EXPECT_EQ(Cursor(group.last(8)).u64(), check_value(group.first(33), before));
}

TEST(RecordingEncoder, ASchemaThatTwoChannelsShareIsWrittenOnce) {
  const SmallRecording small = make_small_recording(1, false);
  int schemas = 0;
  for (const auto& [op, content] : records_of(small.bytes)) schemas += op == kSchema;
  EXPECT_EQ(schemas, 1);
}

TEST(RecordingEncoder, TheSummaryCountsAndPointsAsMcapWants) {
  const SmallRecording small = make_small_recording(9);
  const std::size_t summary = small.data_end + kDataEndBytes;
  const auto records = records_of(small.bytes);
  std::vector<int> order;
  bool after_data = false;
  for (const auto& [op, content] : records) {
    if (op == kDataEnd) after_data = true;
    if (after_data) order.push_back(op);
    if (op == kStatistics) {
      Cursor cursor(content);
      EXPECT_EQ(cursor.u64(), 11U);  // messages
      EXPECT_EQ(cursor.u16(), 1);    // schemas
      EXPECT_EQ(cursor.u32(), 2U);   // channels
      EXPECT_EQ(cursor.u32(), 0U);
      EXPECT_EQ(cursor.u32(), 1U);  // metadata
      EXPECT_EQ(cursor.u32(), 0U);
      EXPECT_EQ(cursor.u64(), 1'000'000'000U);
      EXPECT_EQ(cursor.u64(), 1'800'000'000U);
      EXPECT_EQ(cursor.u32(), 20U);  // bytes of the map
      EXPECT_EQ(cursor.u16(), 1);
      EXPECT_EQ(cursor.u64(), 9U);
      EXPECT_EQ(cursor.u16(), 2);
      EXPECT_EQ(cursor.u64(), 2U);
      EXPECT_TRUE(cursor.good() && cursor.rest().empty());
    }
    if (op == kMetadataIndex) {
      Cursor cursor(content);
      const std::uint64_t at = cursor.u64();
      const std::uint64_t length = cursor.u64();
      EXPECT_EQ(cursor.string(), "subject");
      EXPECT_EQ(std::to_integer<int>(small.bytes[at]), kMetadata);
      EXPECT_EQ(Cursor(std::span(small.bytes).subspan(at + 1)).u64() + kRecordHead, length);
    }
    if (op == kSummaryOffset) {
      Cursor cursor(content);
      const int group = cursor.u8();
      const std::uint64_t at = cursor.u64();
      EXPECT_GE(at, summary);
      EXPECT_EQ(std::to_integer<int>(small.bytes[at]), group);
    }
    if (op == kFooter) {
      Cursor cursor(content);
      EXPECT_EQ(cursor.u64(), summary);
      const std::uint64_t index = cursor.u64();
      EXPECT_EQ(std::to_integer<int>(small.bytes[index]), kSummaryOffset);
      const auto covered = std::span(small.bytes).subspan(summary, small.bytes.size() - 12 - summary);
      EXPECT_EQ(cursor.u32(), crc32(covered));
    }
  }
  const std::vector<int> expected{kDataEnd,       kSchema,        kChannel,       kChannel,
                                  kStatistics,    kMetadataIndex, kSummaryOffset, kSummaryOffset,
                                  kSummaryOffset, kSummaryOffset, kFooter};
  EXPECT_EQ(order, expected);
  EXPECT_TRUE(text(small.bytes).ends_with(kMagic));
}

TEST(RecordingEncoder, RefusesWhatCouldNotBeReadBack) {
  Bytes out;
  RecordingEncoder encoder;
  encoder.begin(out);
  EXPECT_EQ(encoder.add_channel({.topic = ""}, out).error().code, Code::usage);
  ASSERT_TRUE(encoder.add_channel({.topic = "/t"}, out));
  const std::size_t before = out.size();
  const Bytes large(kMaxGroupBytes, std::byte{0});
  const RecordingMessage message{0, 0, 0, 0, large};
  const auto refused = encoder.add_messages({&message, 1}, out);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "16777247 bytes in one piece of a recording; at most 16777216 fit");
  EXPECT_EQ(encoder.add_metadata({"large", {{"key", std::string(kMaxGroupBytes, 'x')}}}, out).error().code,
            Code::usage);
  EXPECT_EQ(out.size(), before);
  EXPECT_EQ(encoder.messages(), 0);
  const RecordingMessage nowhere{1, 0, 0, 0, {}};
  EXPECT_THROW(static_cast<void>(encoder.add_messages({&nowhere, 1}, out)), ContractError);
}

TEST(RecordingEncoder, GoesOnAfterARefusal) {
  Bytes out;
  RecordingEncoder encoder;
  encoder.begin(out);
  ASSERT_TRUE(encoder.add_channel({.topic = "/t"}, out));
  ASSERT_FALSE(encoder.add_metadata({"large", {{"key", std::string(kMaxGroupBytes, 'x')}}}, out));
  const std::string data = "kept";
  const RecordingMessage message{0, 0, 0, 0, std::as_bytes(std::span(data))};
  ASSERT_TRUE(encoder.add_messages({&message, 1}, out));
  encoder.finish(out);
  const Found found = read_everything(out);
  EXPECT_EQ(found.end, RecordingEnd::closed);
  EXPECT_EQ(found.texts, std::vector<std::string>{"kept"});
}

}  // namespace
}  // namespace kinemark::io
