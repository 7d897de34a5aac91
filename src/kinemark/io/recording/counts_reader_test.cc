// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/counts_reader.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/io/recording/counts_recording.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ReadCountsOneByOne : public testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_ / "counts.mcap";

  static data::Counts some(std::int64_t frames, bool dark) {
    auto out = data::Counts::zeros({"hand", "wrist"}, {"A", "B"}, {.rate_hz = 100.0, .frames = frames}, dark);
    Random random(7, 0);
    for (auto& c : out.counts) c = static_cast<std::int16_t>(random.uniform(0.0, 4096.0));
    for (auto& c : out.dark) c = static_cast<std::int16_t>(random.uniform(0.0, 20.0));
    for (auto& f : out.flags) f = static_cast<std::uint8_t>(random.uniform(0.0, 4.0));
    return out;
  }
};

TEST_F(ReadCountsOneByOne, GivesWhatTheWholeRecordingHolds) {
  for (const bool dark : {false, true}) {
    const auto counts = some(30, dark);
    ASSERT_TRUE(write_counts(path_, counts, {}, true));
    auto reader = CountsReader::open(path_).value();
    EXPECT_EQ(reader.layout().leds, counts.leds);
    EXPECT_EQ(reader.layout().dark_time_s, counts.dark_time_s);
    EXPECT_EQ(reader.layout().frames(), 0);
    ReadCounts frame;
    std::vector<std::int16_t> all, all_dark;
    std::vector<std::uint8_t> flags;
    for (std::uint32_t f = 0; reader.next(frame).value(); ++f) {
      EXPECT_EQ(frame.number, f);
      all.insert(all.end(), frame.counts.begin(), frame.counts.end());
      all_dark.insert(all_dark.end(), frame.dark.begin(), frame.dark.end());
      flags.insert(flags.end(), frame.flags.begin(), frame.flags.end());
    }
    EXPECT_TRUE(std::ranges::equal(all, counts.counts));
    EXPECT_TRUE(std::ranges::equal(all_dark, counts.dark));
    EXPECT_TRUE(std::ranges::equal(flags, counts.flags));
    EXPECT_FALSE(reader.next(frame).value());
  }
}

TEST_F(ReadCountsOneByOne, KeepsNumbersOfAGapAndLeavesOutWhatGoesBack) {
  const auto counts = some(1, false);
  auto writer = CountsWriter::create(path_, counts).value();
  for (const std::int64_t f : {3, 4, 9, 9, 5, 10})
    ASSERT_TRUE(writer.push({.frame = f,
                             .time_s = 0.01 * static_cast<double>(f),
                             .counts = counts.counts,
                             .flags = counts.flags,
                             .dark = {}}));
  auto reader = CountsReader::open(path_).value();
  ReadCounts frame;
  std::vector<std::uint32_t> numbers;
  while (reader.next(frame).value()) numbers.push_back(frame.number);
  EXPECT_THAT(numbers, ElementsAre(3, 4, 9, 10));
}

TEST_F(ReadCountsOneByOne, FlagsCountsThatNoConverterGives) {
  auto counts = some(1, false);
  std::ranges::fill(counts.flags, std::uint8_t{0});
  counts.highest_code = 100;
  std::ranges::fill(counts.counts, std::int16_t{50});
  counts.counts[5] = 101;
  auto writer = CountsWriter::create(path_, counts).value();
  ASSERT_TRUE(
      writer.push({.frame = 0, .time_s = 0.0, .counts = counts.counts, .flags = counts.flags, .dark = {}}));
  auto reader = CountsReader::open(path_).value();
  ReadCounts frame;
  ASSERT_TRUE(reader.next(frame).value());
  EXPECT_THAT(frame.flags, ElementsAre(0, data::kCountLost, 0, 0));
  EXPECT_EQ(frame.counts[5], 0);
  EXPECT_EQ(frame.counts[8], 50);
}

TEST_F(ReadCountsOneByOne, WithoutAFrameEndAtOnceAndNotesComeBack) {
  auto writer = CountsWriter::create(path_, some(1, false)).value();
  ASSERT_TRUE(writer.add_metadata({"end", {{"frames", "0"}}}));
  ASSERT_TRUE(writer.close());
  auto reader = CountsReader::open(path_).value();
  ReadCounts frame;
  EXPECT_FALSE(reader.next(frame).value());
  EXPECT_EQ(read_counts(path_).value().metadata.front().name, "end");
}

TEST_F(ReadCountsOneByOne, NeedARecordingOfCounts) {
  auto writer = RecordingWriter::create(path_).value();
  ASSERT_TRUE(writer.close());
  EXPECT_THAT(CountsReader::open(path_).error().message, HasSubstr("recording without counts"));
  EXPECT_EQ(CountsReader::open(scratch_ / "absent.mcap").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
