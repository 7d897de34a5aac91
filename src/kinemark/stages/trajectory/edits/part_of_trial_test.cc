// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/edits/part_of_trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kinemark/stages/trajectory/edits/testing/numbered_trial.h"

namespace kinemark::trajectory {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::numbered_trial;

TEST(PartOfTrial, TakesWhatIsKnownOfEverySample) {
  const auto whole = numbered_trial();
  auto part = whole;
  const std::array<std::int64_t, 2> markers{2, 0};
  const std::array<std::int64_t, 1> channels{1};
  keep_part(part, {.first = 3, .count = 4}, markers, channels);
  ASSERT_TRUE(part.validate()) << part.validate().error().message;
  EXPECT_THAT(part.markers.names, ElementsAre("C", "A"));
  EXPECT_THAT(part.channels.names, ElementsAre("moment"));
  EXPECT_EQ(part.channels.kinds[0], data::ChannelKind::moment);
  for (std::int64_t f = 0; f < 4; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      const auto here = part.markers.index(f, m), there = whole.markers.index(f + 3, markers[m]);
      EXPECT_EQ(part.markers.state[here], whole.markers.state[there]);
      EXPECT_EQ(part.markers.method[here], whole.markers.method[there]);
      EXPECT_EQ(part.residual_m[here], whole.residual_m[there]);
      EXPECT_EQ(part.camera_mask[here], whole.camera_mask[there]);
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(part.markers.covariance[6 * here + i], whole.markers.covariance[6 * there + i]);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(part.markers.unfiltered_in_world[3 * here + i],
                  whole.markers.unfiltered_in_world[3 * there + i]);
      if (whole.markers.present(f + 3, markers[m])) {
        EXPECT_EQ(Eigen::Vector3d(part.markers.x(f, m)), Eigen::Vector3d(whole.markers.x(f + 3, markers[m])));
        EXPECT_EQ(part.markers.time_s(f, m), whole.markers.time_s(f + 3, markers[m]));
      }
    }
  EXPECT_EQ(part.channels.values[0], whole.channels.values[3 * (3 * 2 + 1)]);
}

TEST(PartOfTrial, SomeFramesOrSomeMarkersLeaveTheRestWhole) {
  const auto whole = numbered_trial();
  auto frames = whole;
  keep_frames(frames, {.first = 3, .count = 4});
  EXPECT_EQ(frames.markers.names, whole.markers.names);
  EXPECT_EQ(frames.channels.names, whole.channels.names);
  EXPECT_EQ(frames.markers.frames(), 4);
  EXPECT_EQ(frames.first_frame, whole.first_frame + 3);
  auto markers = whole;
  const std::array<std::int64_t, 2> kept{2, 0};
  keep_markers(markers, kept);
  EXPECT_THAT(markers.markers.names, ElementsAre("C", "A"));
  EXPECT_EQ(markers.channels.names, whole.channels.names);
  EXPECT_EQ(markers.channels.values, whole.channels.values);
  EXPECT_EQ(markers.markers.frames(), whole.markers.frames());
}

TEST(PartOfTrial, FramesKeepTheirNumbersAndTimes) {
  const auto whole = numbered_trial();
  auto part = whole;
  const std::array<std::int64_t, 1> markers{1};
  keep_part(part, {.first = 3, .count = 4}, markers, {});
  EXPECT_EQ(part.first_frame, whole.first_frame + 3);
  EXPECT_EQ(part.last_frame(), whole.first_frame + 6);
  EXPECT_DOUBLE_EQ(part.markers.time.t0_s, whole.markers.time.time_s(3));
  EXPECT_THAT(part.channels.names, IsEmpty());
}

TEST(PartOfTrial, AnalogSamplesOfTheLastFrameAreWhole) {
  auto part = numbered_trial();  // 10 frames, 5 samples a frame, 2 channels, values 0, 1, 2 ...
  const std::array<std::int64_t, 1> markers{0};
  keep_part(part, {.first = 3, .count = 4}, markers, {});
  EXPECT_EQ(part.analog.samples, 20);
  ASSERT_EQ(part.analog.values.size(), 40U);
  EXPECT_EQ(part.analog.values.front(), 30.0);
  EXPECT_EQ(part.analog.values.back(), 69.0);
}

TEST(PartOfTrial, FramesOfTheBaselineThatAreCutOffAreSaid) {
  const std::array<std::int64_t, 1> markers{0};
  const auto warnings_of = [&](std::int64_t last, bool plates) {
    auto part = numbered_trial();
    if (plates) part.force_plates = {{.type = 2, .channel_idx = {0}}};
    part.unloaded_s = {part.markers.time.time_s(1), part.markers.time.time_s(last)};
    keep_part(part, {.first = 0, .count = 4}, markers, {});
    return part.warnings;
  };
  EXPECT_THAT(warnings_of(5, true), Contains(HasSubstr("a file of these has no baseline to subtract")));
  EXPECT_THAT(warnings_of(2, true), Not(Contains(HasSubstr("a file of these has no baseline to subtract"))));
  // Without plates there is nothing to subtract from.
  EXPECT_THAT(warnings_of(5, false), Not(Contains(HasSubstr("a file of these has no baseline to subtract"))));
}

TEST(PartOfTrial, EventsOutsideAreLeftOutAndCounted) {
  auto part = numbered_trial();
  const double t3 = part.markers.time.time_s(3), t6 = part.markers.time.time_s(6);
  part.events = {{"Foot Strike", "Left", t3 - 0.02},
                 {"Foot Strike", "Left", t3},
                 {"Foot Off", "Left", t6},
                 {"Foot Off", "Right", t6 + 0.02}};
  const std::array<std::int64_t, 1> markers{0};
  keep_part(part, {.first = 3, .count = 4}, markers, {});
  ASSERT_EQ(part.events.size(), 2U);
  EXPECT_EQ(part.events[0].time_s, t3);
  EXPECT_EQ(part.events[1].time_s, t6);
  EXPECT_THAT(part.warnings, ElementsAre(HasSubstr("2 events outside the chosen frames were left out")));
}

TEST(PartOfTrial, AllFramesSayNothing) {
  auto part = numbered_trial();
  const auto whole = part;
  const std::array<std::int64_t, 3> markers{0, 1, 2};
  const std::array<std::int64_t, 2> channels{0, 1};
  keep_part(part, {.first = 0, .count = 10}, markers, channels);
  EXPECT_EQ(part.markers.time, whole.markers.time);
  EXPECT_EQ(part.analog.values, whole.analog.values);
  EXPECT_EQ(part.markers.state, whole.markers.state);
  EXPECT_EQ(part.channels.values, whole.channels.values);
  EXPECT_THAT(part.warnings, IsEmpty());
}

}  // namespace
}  // namespace kinemark::trajectory
