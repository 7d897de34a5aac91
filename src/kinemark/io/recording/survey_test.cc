// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kinemark/io/recording/testing/small_recording.h"

namespace kinemark::io {
namespace {

using namespace internal;
using testing::ElementsAre;

RecordingSurvey survey_of(const Bytes& bytes) {
  return survey_recording(
             *RecordingReader::open(std::make_unique<MemorySource>(bytes, "a.mcap"), {.skip_damage = true}))
      .value();
}

/// One channel at 10 Hz with these numbers and times.
Bytes recording_of(const std::vector<std::pair<std::uint32_t, double>>& messages) {
  Bytes bytes;
  RecordingEncoder encoder;
  encoder.begin(bytes);
  EXPECT_TRUE(encoder.add_channel({.topic = "/t", .metadata = {{"rate_hz", "10"}}}, bytes));
  for (const auto& [sequence, time_s] : messages) {
    const auto ns = static_cast<std::uint64_t>(std::llround(1e9 * time_s));
    const RecordingMessage message{0, sequence, ns, ns, {}};
    EXPECT_TRUE(encoder.add_messages({&message, 1}, bytes));
  }
  encoder.finish(bytes);
  return bytes;
}

TEST(Survey, AWholeRecordingHasFactsAndNoWarnings) {
  const SmallRecording small = make_small_recording(9);
  const RecordingSurvey survey = survey_of(small.bytes);
  EXPECT_EQ(survey.messages, 11);
  EXPECT_EQ(survey.bytes, small.bytes.size());
  EXPECT_EQ(survey.end, RecordingEnd::closed);
  ASSERT_EQ(survey.per_channel.size(), 2U);
  EXPECT_EQ(survey.per_channel[0].messages, 9);
  EXPECT_EQ(survey.per_channel[1].messages, 2);
  EXPECT_NEAR(survey.per_channel[0].first_time_s, 1.0, 1e-12);
  EXPECT_NEAR(survey.per_channel[0].last_time_s, 1.8, 1e-12);
  std::int64_t bytes = 0;
  for (std::uint32_t i = 0; i < 9; ++i) bytes += static_cast<std::int64_t>(text_of(i).size());
  EXPECT_EQ(survey.per_channel[0].bytes, bytes);
  EXPECT_THAT(survey.warnings, ElementsAre());
}

TEST(Survey, ChannelsWithoutMessagesAreListed) {
  const RecordingSurvey survey = survey_of(make_small_recording(1).bytes);
  ASSERT_EQ(survey.per_channel.size(), 2U);
  EXPECT_EQ(survey.per_channel[1].messages, 0);
}

TEST(Survey, TellsThatTheRecorderWasStopped) {
  const RecordingSurvey survey = survey_of(make_small_recording(3, false).bytes);
  EXPECT_THAT(
      survey.warnings,
      ElementsAre(
          "was not closed: the recorder was stopped, or is still recording; all that is there was kept"));
}

TEST(Survey, TellsLossAndDamageWithTheirPositions) {
  SmallRecording small = make_small_recording(9);
  small.bytes[small.group_ends[1] + 30] ^= std::byte{4};
  const RecordingSurvey survey = survey_of(small.bytes);
  EXPECT_EQ(survey.per_channel[0].lost, 1);
  EXPECT_THAT(survey.warnings, ElementsAre("byte " + std::to_string(small.group_ends[1]) +
                                               ": does not match its checksum; 59 bytes were left out",
                                           "/a: 1 messages are missing by their numbers"));
}

TEST(Survey, TellsClockJumpsAndWhereTheFirstIs) {
  const RecordingSurvey survey =
      survey_of(recording_of({{0, 10.0}, {1, 10.1}, {2, 6.2}, {3, 6.3}, {4, 9.4}, {5, 9.5}}));
  ASSERT_EQ(survey.clock_jumps.size(), 2U);
  EXPECT_EQ(survey.clock_jumps[0].sequence, 2U);
  EXPECT_NEAR(survey.clock_jumps[0].jump_s, -4.0, 1e-9);
  EXPECT_NEAR(survey.clock_jumps[1].jump_s, 3.0, 1e-9);
  EXPECT_NEAR(survey.per_channel[0].first_time_s, 6.2, 1e-9);
  EXPECT_NEAR(survey.per_channel[0].last_time_s, 10.1, 1e-9);
  EXPECT_THAT(survey.warnings,
              ElementsAre("/t: the clock jumps 2 times; the first by -4 s before message 2"));
}

TEST(Survey, KeepsAHundredJumpsAndCountsAll) {
  std::vector<std::pair<std::uint32_t, double>> messages;
  for (std::uint32_t i = 0; i < 500; ++i) messages.emplace_back(i, 3.0 * i);
  const RecordingSurvey survey = survey_of(recording_of(messages));
  EXPECT_EQ(survey.clock_jumps.size(), 100U);
  EXPECT_EQ(survey.per_channel[0].clock_jumps, 499);
}

TEST(Survey, NumbersThatRepeatOrGoBackAreNoLoss) {
  const RecordingSurvey survey = survey_of(recording_of({{4, 0.0}, {4, 0.0}, {3, 0.0}, {7, 0.4}}));
  EXPECT_EQ(survey.per_channel[0].out_of_order, 2);
  EXPECT_EQ(survey.per_channel[0].lost, 3);
}

TEST(Survey, ManyDamagedStretchesAreSummedUp) {
  SmallRecording small = make_small_recording(40);
  for (std::size_t i = 0; i + 2 < small.group_ends.size(); i += 2)
    small.bytes[small.group_ends[i] + 15] ^= std::byte{1};
  const RecordingSurvey survey = survey_of(small.bytes);
  EXPECT_EQ(survey.damage.size(), 19U);
  EXPECT_THAT(survey.warnings[10], testing::StartsWith("19 damaged places in all, "));
}

}  // namespace
}  // namespace kinemark::io
