// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/markers_recording.h"

#include <gmock/gmock.h>

#include <array>
#include <limits>
#include <utility>

#include "kinemark/io/recording/mcap_markers.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class MarkersRecording : public ::testing::Test {
 protected:
  [[nodiscard]] MarkersWriter writer(const MarkersLayout& layout) const {
    return MarkersWriter::create(path_, layout).value();
  }
  [[nodiscard]] MarkersLayout two() const {
    return {.names = {"A", "B"}, .rate_hz = 100.0, .t0_s = 2.0, .source = "test"};
  }
  static void push(MarkersWriter& writer, std::int64_t frame, double x,
                   SampleState second = SampleState::measured) {
    const bool there = second != SampleState::missing && second != SampleState::rejected;
    const std::array<double, 6> positions{
        x, 0.1, 0.2, there ? 1.0 : kNaN, there ? 2.0 : kNaN, there ? 3.0 : kNaN};
    const std::array<SampleState, 2> states{SampleState::measured, second};
    ASSERT_TRUE(writer.push({.frame = frame,
                             .log_time_ns = static_cast<std::uint64_t>(frame) * 10'000'000,
                             .x_in_world = positions,
                             .state = states}));
  }
  [[nodiscard]] data::Trial read() const { return read_mcap_markers(path_).value(); }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_ = scratch_ / "a.mcap";
};

TEST_F(MarkersRecording, ComesBackToTheLastBit) {
  auto out = writer(two());
  push(out, 0, 1.0 / 3.0);
  push(out, 1, -1e-300, SampleState::rejected);
  push(out, 2, 5e-324, SampleState::interpolated);
  EXPECT_EQ(out.acknowledged(), 3);
  ASSERT_TRUE(out.close());
  const auto trial = read();
  EXPECT_THAT(trial.warnings, IsEmpty());
  EXPECT_EQ(trial.format, "recording");
  EXPECT_THAT(trial.markers.names, ElementsAre("A", "B"));
  EXPECT_EQ(trial.markers.time.rate_hz, 100.0);
  EXPECT_EQ(trial.markers.time.t0_s, 2.0);
  ASSERT_EQ(trial.markers.frames(), 3);
  EXPECT_EQ(trial.markers.x(0, 0).x(), 1.0 / 3.0);
  EXPECT_EQ(trial.markers.x(1, 0).x(), -1e-300);
  EXPECT_EQ(trial.markers.x(2, 0).x(), 5e-324);
  EXPECT_EQ(trial.markers.state[trial.markers.index(1, 1)], SampleState::rejected);
  EXPECT_EQ(trial.markers.state[trial.markers.index(2, 1)], SampleState::interpolated);
}

TEST_F(MarkersRecording, WithoutCloseAllFramesAreThere) {
  {
    auto out = writer(two());
    for (int f = 0; f < 50; ++f) push(out, f, f);
  }
  const auto trial = read();
  EXPECT_EQ(trial.markers.frames(), 50);
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("not closed")));
}

TEST_F(MarkersRecording, FramesThatWereLeftOutAreMissing) {
  auto out = writer(two());
  push(out, 0, 1.0);
  push(out, 3, 2.0);
  push(out, 3, 9.0);
  ASSERT_TRUE(out.close());
  const auto trial = read();
  ASSERT_EQ(trial.markers.frames(), 4);
  EXPECT_FALSE(trial.markers.present(1, 0));
  EXPECT_EQ(trial.markers.x(3, 0).x(), 2.0);
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("2 frames are missing in between"),
                                          HasSubstr("1 frame left out that repeat")));
}

TEST_F(MarkersRecording, ARecordingMayHaveNoFrameYet) {
  auto out = writer(two());
  ASSERT_TRUE(out.close());
  EXPECT_EQ(read().markers.frames(), 0);
}

TEST_F(MarkersRecording, ALayoutMustMakeSense) {
  const auto refused = [this](MarkersLayout layout) {
    const auto made = MarkersWriter::create(path_, layout);
    EXPECT_FALSE(made);
    return made ? std::string() : made.error().message;
  };
  auto layout = two();
  layout.names = {"A", "A"};
  EXPECT_THAT(refused(layout), HasSubstr("A"));
  layout = two();
  layout.rate_hz = 0.0;
  EXPECT_THAT(refused(layout), HasSubstr("rate_hz"));
  layout = two();
  layout.t0_s = kNaN;
  EXPECT_THAT(refused(layout), HasSubstr("t0_s"));
}

/// A recording with this channel and one message of these bytes.
Result<data::Trial> with_channel(const std::filesystem::path& path, RecordingChannel channel,
                                 std::size_t bytes, std::uint32_t sequence = 0) {
  auto out = RecordingWriter::create(path, {.force = true}).value();
  (void)out.add_channel(channel).value();
  const Bytes data(bytes, std::byte{0x7F});
  EXPECT_TRUE(out.append(RecordingMessage{.sequence = sequence, .data = data}));
  EXPECT_TRUE(out.close());
  return read_mcap_markers(path);
}

RecordingChannel channel_with(const std::string& layout) {
  return {.topic = "/markers",
          .message_encoding = "x",
          .schema_name = "kinemark.Markers",
          .schema_encoding = "x-text",
          .schema_text = "x",
          .metadata = {{"layout", layout}}};
}

TEST_F(MarkersRecording, WhatMakesNoSenseIsASentence) {
  for (const std::string layout :
       {"", "[]", "{}", R"({"names":"A"})", R"({"names":[1],"rate_hz":1,"t0_s":0})",
        R"({"names":["A"],"rate_hz":"x","t0_s":0})", R"({"names":["A"],"rate_hz":1})",
        R"({"names":["A","A"],"rate_hz":1,"t0_s":0})", R"({"names":["A"],"rate_hz":-1,"t0_s":0})"}) {
    const auto trial = with_channel(path_, channel_with(layout), 25);
    ASSERT_FALSE(trial) << layout;
    EXPECT_THAT(trial.error().message, HasSubstr("a.mcap: ")) << layout;
  }
  const std::string good = R"({"names":["A"],"rate_hz":100,"t0_s":0})";
  const auto state = with_channel(path_, channel_with(good), 25).value();
  EXPECT_FALSE(state.markers.present(0, 0));
  EXPECT_THAT(state.warnings, ElementsAre(HasSubstr("1 sample left out whose state")));
  const auto size = with_channel(path_, channel_with(good), 24).value();
  EXPECT_EQ(size.markers.frames(), 0);
  EXPECT_THAT(size.warnings, ElementsAre(HasSubstr("1 message left out that are not 25 bytes long")));
  const auto far = with_channel(path_, channel_with(good), 25, 2'000'000'000).value();
  EXPECT_THAT(far.warnings, ElementsAre(HasSubstr("an implausible step")));
}

TEST_F(MarkersRecording, ARecordingOfSomethingElseHasNoMarkers) {
  auto channel = channel_with("{}");
  channel.topic = "/other";
  const auto trial = with_channel(path_, channel, 25);
  ASSERT_FALSE(trial);
  EXPECT_EQ(trial.error().code, Code::not_supported);
  EXPECT_THAT(trial.error().message, HasSubstr("kinemark reconstruct makes them"));
}

}  // namespace
}  // namespace kinemark::io
