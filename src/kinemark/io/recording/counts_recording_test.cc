// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/counts_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/recording/encoder.h"
#include "kinemark/io/recording/internal/counts_layout.h"
#include "kinemark/io/recording/recover.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

data::Counts make_counts(std::int64_t frames, bool dark) {
  data::Counts counts = data::Counts::zeros({"hand", "wrist", "elbow"}, {"A", "B"},
                                            {.rate_hz = 100.0, .t0_s = 2.5, .frames = frames}, dark);
  counts.rig_id = "rig \"one\"";
  Random random(5, 0);
  for (auto& c : counts.counts) c = static_cast<std::int16_t>(random.uniform(0.0, 4096.0));
  for (auto& c : counts.dark) c = static_cast<std::int16_t>(random.uniform(0.0, 10.0));
  for (auto& f : counts.flags) f = static_cast<std::uint8_t>(random.uniform(0.0, 4.0));
  for (auto& t : counts.conversion_time_s) t = random.uniform(0.0, 0.01);
  for (auto& t : counts.dark_time_s) t = random.uniform(0.0, 0.01);
  return counts;
}

void expect_same(const data::Counts& a, const data::Counts& b) {
  EXPECT_EQ(a.rig_id, b.rig_id);
  EXPECT_EQ(a.leds, b.leds);
  EXPECT_EQ(a.cameras, b.cameras);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.highest_code, b.highest_code);
  EXPECT_EQ(a.counts, b.counts);
  EXPECT_EQ(a.conversion_time_s, b.conversion_time_s);  // to the last bit, through text
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.dark, b.dark);
  EXPECT_EQ(a.dark_time_s, b.dark_time_s);
}

CountsFrame frame_of(const data::Counts& counts, std::int64_t f) {
  const std::size_t n = counts.leds.size() * counts.cameras.size(), d = counts.dark_time_s.size();
  const auto i = static_cast<std::size_t>(f);
  return {.frame = f,
          .time_s = counts.time.time_s(f),
          .counts = std::span(counts.counts).subspan(4 * i * n, 4 * n),
          .flags = std::span(counts.flags).subspan(i * n, n),
          .dark = std::span(counts.dark).subspan(i * d, d)};
}

class Counts : public testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_ / "counts.mcap";
};

TEST_F(Counts, ComeBackAsTheyWere) {
  const std::vector<RecordingMetadata> metadata{{"rig", {{"toml", "[camera]\nname = \"A\"\n"}}},
                                                {"scenario", {}}};
  for (const bool dark : {false, true}) {
    const data::Counts counts = make_counts(50, dark);
    const auto status = write_counts(path_, counts, metadata, true);
    ASSERT_TRUE(status) << status.error().message;
    const auto read = read_counts(path_);
    ASSERT_TRUE(read) << read.error().message;
    expect_same(read->counts, counts);
    EXPECT_EQ(read->metadata, metadata);
    EXPECT_EQ(read->end, RecordingEnd::closed);
    EXPECT_THAT(read->warnings, ElementsAre());
  }
}

TEST_F(Counts, WithoutFramesKeepTheirLayout) {
  ASSERT_TRUE(write_counts(path_, make_counts(0, true), {}, false));
  const auto read = read_counts(path_);
  ASSERT_TRUE(read) << read.error().message;
  expect_same(read->counts, make_counts(0, true));
}

TEST_F(Counts, ThatBeginBeforeTimeZeroKeepTheirTimes) {
  data::Counts counts = make_counts(20, false);
  counts.time.t0_s = -3.0;
  ASSERT_TRUE(write_counts(path_, counts, {}, false));
  const auto read = read_counts(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->counts.time, counts.time);
  EXPECT_THAT(read->warnings, ElementsAre());
}

TEST_F(Counts, RecordedLiveAreTheSameBytesAsWrittenAtOnce) {
  const data::Counts counts = make_counts(30, true);
  const std::vector<RecordingMetadata> metadata{{"rig", {{"name", "one"}}}};
  ASSERT_TRUE(write_counts(path_, counts, metadata, false));
  auto writer = CountsWriter::create(scratch_ / "live.mcap", counts, metadata);
  ASSERT_TRUE(writer) << writer.error().message;
  for (std::int64_t f = 0; f < counts.frames(); ++f) ASSERT_TRUE(writer->push(frame_of(counts, f)));
  EXPECT_EQ(writer->acknowledged(), 30);
  ASSERT_TRUE(writer->close());
  EXPECT_EQ(read_text(scratch_ / "live.mcap").value(), read_text(path_).value());
}

TEST_F(Counts, FramesThatWereLostAreFlaggedAndReported) {
  const data::Counts counts = make_counts(10, true);
  {
    auto writer = CountsWriter::create(path_, counts);
    ASSERT_TRUE(writer);
    for (const std::int64_t f : {0, 1, 4, 5, 5, 3, 9}) ASSERT_TRUE(writer->push(frame_of(counts, f)));
  }
  const auto read = read_counts(path_);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->counts.frames(), 10);
  for (const std::int64_t f : {2, 3, 6, 7, 8})
    for (std::int64_t led = 0; led < 3; ++led)
      for (std::int64_t camera = 0; camera < 2; ++camera) {
        EXPECT_TRUE(read->counts.has_flag(f, led, camera, data::kCountLost));
        EXPECT_EQ(read->counts.at(f, led, camera).sum(), 0.0);
      }
  for (const std::int64_t f : {0, 1, 4, 5, 9}) EXPECT_EQ(read->counts.at(f, 2, 1), counts.at(f, 2, 1));
  EXPECT_THAT(read->warnings, ElementsAre(HasSubstr("was not closed"), "5 frames are missing in between",
                                          "2 frames repeat or go back in number and were left out"));
}

TEST_F(Counts, ClockJumpsAreReported) {
  const data::Counts counts = make_counts(6, false);
  auto writer = CountsWriter::create(path_, counts);
  ASSERT_TRUE(writer);
  for (std::int64_t f = 0; f < 6; ++f) {
    CountsFrame frame = frame_of(counts, f);
    if (f >= 3) frame.time_s -= 1.0;
    ASSERT_TRUE(writer->push(frame));
  }
  ASSERT_TRUE(writer->close());
  const auto read = read_counts(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->counts.frames(), 6);
  EXPECT_THAT(read->warnings,
              ElementsAre("the clock jumps 1 times, first by -1 s before frame 3; frames are taken "
                          "to be evenly spaced"));
}

TEST_F(Counts, AClockThatRunsBackBeyondItsBeginningLosesNoFrame) {
  const data::Counts counts = make_counts(2, false);
  auto writer = CountsWriter::create(path_, counts);
  ASSERT_TRUE(writer && writer->push(frame_of(counts, 0)));
  CountsFrame frame = frame_of(counts, 1);
  frame.time_s = -1e30;
  ASSERT_TRUE(writer->push(frame));
  const auto read = read_counts(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->counts.counts, counts.counts);
}

TEST_F(Counts, DamageLosesTheFrameAndKeepsTheRest) {
  const data::Counts counts = make_counts(100, false);
  ASSERT_TRUE(write_counts(path_, counts, {}, false));
  std::string bytes = read_text(path_).value();
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  ASSERT_TRUE(write_text(path_, bytes, true));
  const auto read = read_counts(path_);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->counts.frames(), 100);
  EXPECT_THAT(read->warnings,
              ElementsAre(HasSubstr("does not match its checksum"), "1 frames are missing in between"));
  // What recover makes of it reads the same.
  ASSERT_TRUE(recover_recording(path_, scratch_ / "recovered.mcap", false));
  const auto recovered = read_counts(scratch_ / "recovered.mcap");
  ASSERT_TRUE(recovered);
  expect_same(recovered->counts, read->counts);
}

TEST_F(Counts, RefusesWhatIsNoCounts) {
  data::Counts counts = make_counts(3, false);
  counts.counts[5] = 5000;
  EXPECT_EQ(write_counts(path_, counts, {}, false).error().code, Code::usage);
  EXPECT_EQ(write_counts(path_, {}, {}, false).error().code, Code::usage);
  EXPECT_EQ(CountsWriter::create(path_, {}).error().code, Code::usage);
  EXPECT_EQ(scratch_.count_files(), 0);
  auto writer = CountsWriter::create(path_, make_counts(1, true));
  ASSERT_TRUE(writer);
  CountsFrame frame = frame_of(make_counts(1, true), 0);
  frame.flags = frame.flags.first(1);
  EXPECT_THROW(static_cast<void>(writer->push(frame)), ContractError);
}

/// A recording with one channel /counts whose layout is this text, and messages.
Result<CountsRecording> read_layout(const std::string& layout,
                                    const std::vector<std::pair<std::uint32_t, Bytes>>& messages = {}) {
  Bytes bytes;
  RecordingEncoder encoder;
  encoder.begin(bytes);
  RecordingChannel channel = internal::channel_of(make_counts(0, false));
  if (!layout.empty()) channel.metadata["layout"] = layout;
  EXPECT_TRUE(encoder.add_channel(channel, bytes));
  for (const auto& [sequence, data] : messages) {
    const RecordingMessage message{0, sequence, 10'000'000ULL * sequence, 0, data};
    EXPECT_TRUE(encoder.add_messages({&message, 1}, bytes));
  }
  encoder.finish(bytes);
  return read_counts(*RecordingReader::open(std::make_unique<MemorySource>(bytes, "a.mcap")));
}

TEST(CountsLayout, EveryWrongOneIsOneSentence) {
  const std::string names = R"("leds":["a"],"cameras":["A"],)";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"nonsense", "a.mcap: the layout of the counts is not a JSON object"},
      {"[1,2]", "a.mcap: the layout of the counts is not a JSON object"},
      {"{}", "a.mcap: the layout of the counts: 'leds' is not a list of names"},
      {R"({"leds":["a"],"cameras":[1]})",
       "a.mcap: the layout of the counts: 'cameras' is not a list of names"},
      {"{" + names + R"("rate_hz":"fast"})", "a.mcap: the layout of the counts: 'rate_hz' is not a number"},
      {"{" + names + R"("rate_hz":100,"t0_s":0,"highest_code":1e9})",
       "a.mcap: the layout of the counts: highest_code is 1000000000; need 1 to 32767"},
      {"{" + names + R"("rate_hz":100,"t0_s":0,"highest_code":4095,"conversion_time_s":[0,"x"]})",
       "a.mcap: the layout of the counts: 'conversion_time_s' is not a list of numbers"},
      {"{" + names + R"("rate_hz":100,"t0_s":0,"highest_code":4095,"conversion_time_s":[0]})",
       "a.mcap: counts: 1 numbers of conversion times; need 4"},
      {"{" + names + R"("rate_hz":-1,"t0_s":0,"highest_code":4095,"conversion_time_s":[0,0,0,0]})",
       "a.mcap: the layout of the counts: rate_hz is -1; expected a frame rate of 0.001 to 1000000 Hz"},
  };
  for (const auto& [layout, sentence] : cases) {
    const auto read = read_layout(layout);
    ASSERT_FALSE(read) << layout;
    EXPECT_EQ(read.error().message, sentence);
    EXPECT_EQ(read.error().code, Code::bad_input);
  }
}

TEST(CountsLayout, MessagesOfAnotherLengthOrWithImpossibleCountsAreLeftOut) {
  const std::size_t n = internal::frame_bytes(make_counts(0, false));
  Bytes impossible(n, std::byte{0});
  impossible[1] = std::byte{0x7F};
  const auto read =
      read_layout("", {{0, Bytes(n, std::byte{0})}, {1, Bytes(3, std::byte{0})}, {2, impossible}});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->counts.frames(), 3);
  EXPECT_TRUE(read->counts.has_flag(2, 0, 0, data::kCountLost));
  EXPECT_FALSE(read->counts.has_flag(2, 0, 1, data::kCountLost));
  EXPECT_THAT(read->warnings, ElementsAre("1 frames are missing in between",
                                          "1 messages are not 54 bytes long and were left out",
                                          "1 observations have counts outside 0 to 4095 and were left out"));
}

TEST(CountsLayout, AFrameNumberThatLiesCostsNoMemory) {
  const std::size_t n = internal::frame_bytes(make_counts(0, false));
  const Bytes frame(n, std::byte{0});
  const auto read = read_layout("", {{0, frame}, {2'000'000'000, frame}, {2'000'000'001, frame}});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->counts.frames(), 1);
  EXPECT_THAT(read->warnings,
              ElementsAre("frame 2000000000 follows frame 0: an implausible step; the rest was left out"));
}

TEST(CountsLayout, ARecordingOfSomethingElseIsSaidToBe) {
  Bytes bytes;
  RecordingEncoder encoder;
  encoder.begin(bytes);
  encoder.finish(bytes);
  const auto read = read_counts(*RecordingReader::open(std::make_unique<MemorySource>(bytes, "a.mcap")));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "a.mcap: is a recording without counts");
}

}  // namespace
}  // namespace kinemark::io
