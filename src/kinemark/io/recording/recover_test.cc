// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/recover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "kinemark/io/file.h"
#include "kinemark/io/recording/testing/small_recording.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using namespace internal;
using testing::HasSubstr;

class Recover : public testing::Test {
 protected:
  void put(std::span<const std::byte> bytes) {
    std::ofstream file(in_, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    ASSERT_TRUE(file.good());
  }
  static std::string bytes_of(const std::filesystem::path& path) { return read_text(path).value(); }
  Found found() const {
    const std::string text = bytes_of(out_);
    return read_everything(std::as_bytes(std::span(text)));
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path in_ = scratch_ / "in.mcap";
  std::filesystem::path out_ = scratch_ / "out.mcap";
};

TEST_F(Recover, AWholeRecordingComesBackByteForByte) {
  put(make_small_recording(9).bytes);
  const auto report = recover_recording(in_, out_, false);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->messages, 11);
  EXPECT_EQ(report->bytes_left_out, 0U);
  EXPECT_TRUE(report->warnings.empty());
  EXPECT_EQ(bytes_of(out_), bytes_of(in_));
}

TEST_F(Recover, EveryCutGivesAClosedRecordingOfWhatWasWhole) {
  const SmallRecording small = make_small_recording(5);
  const auto texts = read_everything(small.bytes).texts;
  for (std::size_t length = 58; length < small.bytes.size(); length += 29) {
    put(std::span(small.bytes).first(length));
    const std::string before = bytes_of(in_);
    const auto report = recover_recording(in_, out_, true);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(bytes_of(in_), before);
    std::size_t whole = 0;
    for (std::size_t i = 0; i < small.group_ends.size(); ++i)
      if (small.group_ends[i] <= length) whole = small.messages_until[i];
    EXPECT_EQ(report->messages, static_cast<std::int64_t>(whole));
    const Found again = found();
    EXPECT_EQ(again.end, RecordingEnd::closed);
    ASSERT_EQ(again.texts.size(), whole);
    EXPECT_TRUE(std::equal(again.texts.begin(), again.texts.end(), texts.begin()));
  }
}

TEST_F(Recover, KeepsWhatLiesBeyondTheDamageAndWritesDownWhatItLeftOut) {
  SmallRecording small = make_small_recording(9, false);
  small.bytes[small.group_ends[3] + 30] ^= std::byte{1};
  put(small.bytes);
  const auto report = recover_recording(in_, out_, false);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->messages, 10);
  EXPECT_EQ(report->bytes_left_out, small.group_ends[4] - small.group_ends[3]);
  const Found again = found();
  EXPECT_EQ(again.end, RecordingEnd::closed);
  EXPECT_EQ(again.texts.size(), 10U);
  EXPECT_EQ(again.texts[5], text_of(5));
  EXPECT_EQ(again.messages[5].sequence, 5U);
  EXPECT_EQ(again.messages[5].log_time_ns, 1'500'000'000U);
  ASSERT_EQ(again.metadata.size(), 2U);
  EXPECT_EQ(again.metadata[0].name, "subject");
  EXPECT_EQ(again.metadata[1].name, "kinemark.recovered");
  EXPECT_EQ(again.metadata[1].values.at("original"), "in.mcap");
  EXPECT_EQ(again.metadata[1].values.at("end"), "open");
  EXPECT_EQ(again.metadata[1].values.at("messages"), "10");
  EXPECT_THAT(again.metadata[1].values.at("warning_2"), HasSubstr("does not match its checksum"));
}

TEST_F(Recover, WhatIsRecoveredNeedsNoRecovering) {
  const SmallRecording small = make_small_recording(9);
  put(std::span(small.bytes).first(small.group_ends[6] + 5));
  ASSERT_TRUE(recover_recording(in_, out_, false));
  const auto again = recover_recording(out_, scratch_ / "again.mcap", false);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->warnings.empty());
  EXPECT_EQ(bytes_of(scratch_ / "again.mcap"), bytes_of(out_));
}

TEST_F(Recover, ADamagedHeaderCostsNoMessage) {
  SmallRecording small = make_small_recording(9);
  small.bytes[2] ^= std::byte{1};
  put(small.bytes);
  const auto report = recover_recording(in_, out_, false);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->messages, 11);
}

TEST_F(Recover, RefusesAndLeavesEverythingAsItWas) {
  put(make_small_recording(2).bytes);
  const auto same = recover_recording(in_, in_, true);
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().code, Code::usage);
  std::ofstream(out_) << "precious";
  EXPECT_EQ(recover_recording(in_, out_, false).error().code, Code::io);
  EXPECT_EQ(bytes_of(out_), "precious");
  std::ofstream(in_) << "not a recording at all, but long enough to be looked at";
  const auto foreign = recover_recording(in_, out_, true);
  ASSERT_FALSE(foreign);
  EXPECT_EQ(foreign.error().code, Code::bad_input);
  EXPECT_EQ(bytes_of(out_), "precious");
  EXPECT_EQ(recover_recording(scratch_ / "absent.mcap", out_, true).error().code, Code::io);
  EXPECT_EQ(scratch_.count_files(), 2);
}

}  // namespace
}  // namespace kinemark::io
