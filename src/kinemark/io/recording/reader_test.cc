// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/io/recording/internal/mcap.h"
#include "kinemark/io/recording/testing/small_recording.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using namespace internal;

std::string error_of(std::string_view bytes) {
  return read_everything(std::as_bytes(std::span(bytes))).error;
}

/// Ends a group with the check that belongs there, for records that the encoder would never make.
Bytes with_group(Bytes bytes, const std::function<void(Bytes&)>& put_records) {
  const std::uint64_t before = Cursor(std::span(bytes).last(8)).u64();
  const std::size_t begin = bytes.size();
  put_records(bytes);
  const std::uint64_t check = check_value(std::span(bytes).subspan(begin), before);
  put_u8(bytes, kCheck);
  put_u64(bytes, 8);
  put_u64(bytes, check);
  return bytes;
}

TEST(RecordingReader, GivesBackWhatWasWritten) {
  const SmallRecording small = make_small_recording(9);
  const Found found = read_everything(small.bytes);
  EXPECT_EQ(found.end, RecordingEnd::closed);
  EXPECT_TRUE(found.damage.empty());
  EXPECT_EQ(found.kept_until, small.bytes.size());
  ASSERT_EQ(found.channels.size(), 2U);
  EXPECT_EQ(found.channels[0],
            (RecordingChannel{"/a", "text", "Text", "x-text", "any text", {{"rate_hz", "10"}}}));
  EXPECT_EQ(found.channels[1].topic, "/b");
  EXPECT_EQ(found.channels[1].schema_text, "any text");
  ASSERT_EQ(found.metadata.size(), 1U);
  EXPECT_EQ(found.metadata[0], (RecordingMetadata{"subject", {{"name", "Ada"}, {"side", "left"}}}));
  ASSERT_EQ(found.messages.size(), 11U);
  EXPECT_EQ(found.texts[3], text_of(3));
  EXPECT_EQ(found.messages[3].channel, 0);
  EXPECT_EQ(found.messages[3].sequence, 3U);
  EXPECT_EQ(found.messages[3].log_time_ns, 1'300'000'000U);
  EXPECT_EQ(found.messages[3].publish_time_ns, 1'300'000'005U);
  EXPECT_EQ(found.texts[4], text_of(3));  // appended together with it
  EXPECT_EQ(found.messages[4].channel, 1);
  EXPECT_EQ(found.messages[4].sequence, 0U);
}

TEST(RecordingReader, TellsWhichMessagesWereAppendedTogether) {
  const SmallRecording small = make_small_recording(4);
  auto reader = RecordingReader::open(std::make_unique<MemorySource>(small.bytes, "small.mcap"));
  ASSERT_TRUE(reader);
  std::vector<bool> ends;
  RecordingMessage message;
  while (*reader->next(message)) ends.push_back(reader->group_ends());
  EXPECT_EQ(ends, (std::vector<bool>{true, true, true, false, true}));
}

TEST(RecordingReader, ARecordingThatIsNotClosedIsWholeAndOpen) {
  const SmallRecording small = make_small_recording(5, false);
  const Found found = read_everything(small.bytes);
  EXPECT_EQ(found.end, RecordingEnd::open);
  EXPECT_EQ(found.messages.size(), 6U);
  EXPECT_TRUE(found.damage.empty());
}

TEST(RecordingReader, ReadsGroupsLargerThanItsWindow) {
  Bytes bytes;
  RecordingEncoder encoder;
  encoder.begin(bytes);
  ASSERT_TRUE(encoder.add_channel({.topic = "/t"}, bytes));
  const Bytes large(6U << 20, std::byte{0x90});  // looks like a check record all the way
  std::vector<RecordingMessage> group(2, {0, 0, 0, 0, large});
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(encoder.add_messages(group, bytes));
  encoder.finish(bytes);
  const Found found = read_everything(bytes);
  EXPECT_EQ(found.end, RecordingEnd::closed);
  ASSERT_EQ(found.texts.size(), 6U);
  for (const std::string& text : found.texts) EXPECT_EQ(text, std::string(large.size(), '\x90'));
}

TEST(RecordingReader, SaysInOneSentenceWhyItReadsNothing) {
  EXPECT_EQ(error_of(""), "small.mcap: is empty; need a recording");
  EXPECT_EQ(error_of("\x89MC"), "small.mcap: the header of the recording is damaged; nothing was read");
  EXPECT_EQ(error_of("time,x,y\n0,1,2\n"),
            "small.mcap: does not begin as a recording does (MCAP); nothing was read");
  const SmallRecording small = make_small_recording(1);
  const auto text = std::string(reinterpret_cast<const char*>(small.bytes.data()), small.bytes.size());
  EXPECT_EQ(error_of(text.substr(0, 30)), "small.mcap: the header of the recording is cut; nothing was read");
  std::string foreign = text;
  foreign.replace(foreign.find("kinemark"), 8, "ros2-x.y");
  EXPECT_EQ(error_of(foreign),
            "small.mcap: is an MCAP file of profile 'ros2-x.y'; only recordings of kinemark are read");
  const auto missing = RecordingReader::open("/nowhere/at/all.mcap");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::io);
}

TEST(RecordingReader, ReadsTheSameFromAFileOnTheDisk) {
  const testing_support::ScratchFolder scratch;
  const SmallRecording small = make_small_recording(20);
  auto file = OutputFile::create(scratch / "a.mcap", false);
  ASSERT_TRUE(file && file->write(small.bytes) && file->commit());
  auto reader = RecordingReader::open(scratch / "a.mcap");
  ASSERT_TRUE(reader);
  RecordingMessage message;
  std::uint32_t next = 0;
  while (*reader->next(message)) {
    if (message.channel != 0) continue;
    const std::string text(reinterpret_cast<const char*>(message.data.data()), message.data.size());
    EXPECT_EQ(text, text_of(next++));
  }
  EXPECT_EQ(next, 20U);
  EXPECT_EQ(reader->size(), small.bytes.size());
}

// Groups with a valid checksum and invalid content: never written by kinemark, and never accepted.
TEST(RecordingReader, StopsAtRecordsThatMakeNoSense) {
  const Bytes good = make_small_recording(2, false).bytes;
  const auto what = [&](const std::function<void(Bytes&)>& put) {
    const Found found = read_everything(with_group(good, put));
    EXPECT_EQ(found.end, RecordingEnd::damaged);
    EXPECT_EQ(found.messages.size(), 2U);
    return found.damage.size() == 1 && found.damage[0].offset == good.size() ? found.damage[0].what : "";
  };
  EXPECT_EQ(what([](Bytes& b) {
              const RecordScope record(b, kMessage);
              put_u16(b, 9);
              for (int i = 0; i < 5; ++i) put_u32(b, 0);
            }),
            "a message on channel 9, which is not declared");
  EXPECT_EQ(what([](Bytes& b) {
              const RecordScope record(b, kMessage);
              put_u16(b, 1);
            }),
            "a message is too short");
  EXPECT_EQ(what([](Bytes& b) {
              const RecordScope record(b, kChannel);
              put_u16(b, 1);
              put_u16(b, 1);
              put_string(b, "/other");
              put_string(b, "text");
              put_map(b, {});
            }),
            "channel 1 is declared twice");
  EXPECT_EQ(what([](Bytes& b) {
              const RecordScope record(b, kChannel);
              put_u16(b, 8);
              put_u16(b, 77);
              put_string(b, "/other");
              put_string(b, "text");
              put_map(b, {});
            }),
            "channel 8 has the schema 77, which is not declared");
  EXPECT_EQ(what([](Bytes& b) {
              const RecordScope record(b, kSchema);
              put_u16(b, 1);
              for (int i = 0; i < 3; ++i) put_string(b, "other");
            }),
            "schema 1 is declared twice");
  EXPECT_EQ(what([](Bytes& b) {
              const RecordScope record(b, kMetadata);
              put_string(b, "m");
              put_u32(b, 1000);
            }),
            "metadata are too short");
  EXPECT_EQ(what([](Bytes& b) { const RecordScope record(b, kChunk); }),
            "a chunk, which recordings do not have");
  EXPECT_EQ(what([](Bytes& b) { const RecordScope record(b, kHeader); }), "a header in the middle");
}

TEST(RecordingReader, RecordsOfLaterVersionsAreReadOver) {
  const Bytes good = make_small_recording(2, false).bytes;
  const Bytes later = with_group(good, [](Bytes& b) {
    const RecordScope record(b, 0x91);
    put_string(b, "whatever comes");
  });
  const Found found = read_everything(later);
  EXPECT_EQ(found.end, RecordingEnd::open);
  EXPECT_TRUE(found.damage.empty());
}

}  // namespace
}  // namespace kinemark::io
