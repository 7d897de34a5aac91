// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_recorder.h"

#include <gtest/gtest.h>

#include "kinemark/io/recording/mcap_markers.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

TEST(LiveRecorder, KeepsEachFrameWithItsNumber) {
  const testing_support::ScratchFolder scratch;
  const stream::SourceFacts facts{.name = "device", .markers = {"A"}, .rate_hz = 100.0, .t0_s = 2.0};
  auto recorder = LiveRecorder::create(scratch / "live.mcap", facts, false).value();
  stream::Frame frame{.came_ns = 1'000'000'000};
  for (const std::int64_t number : {0, 1, 4}) {  // 2 and 3 were lost on the way
    frame.clear(1);
    frame.number = number;
    frame.x_in_world = {1e-3 * static_cast<double>(number), 2.0, 3.0};
    frame.state = {data::SampleState::measured};
    ASSERT_TRUE(recorder->push(frame));
  }
  EXPECT_EQ(recorder->kept(), 3);
  ASSERT_TRUE(recorder->finish());
  const auto trial = io::read_mcap_markers(scratch / "live.mcap").value();
  ASSERT_EQ(trial.markers.frames(), 5);
  EXPECT_EQ(trial.markers.time.t0_s, 2.0);
  EXPECT_EQ(trial.markers.x(4, 0), Eigen::Vector3d(0.004, 2.0, 3.0));
  EXPECT_EQ(trial.markers.count_missing(), 2);
}

TEST(LiveRecorder, AFileThatIsThereIsReplacedWhereThatIsAsked) {
  const testing_support::ScratchFolder scratch;
  const stream::SourceFacts facts{.name = "device", .markers = {"A"}, .rate_hz = 100.0};
  ASSERT_TRUE(LiveRecorder::create(scratch / "live.mcap", facts, false));
  EXPECT_EQ(LiveRecorder::create(scratch / "live.mcap", facts, false).error().code, Code::io);
  EXPECT_TRUE(LiveRecorder::create(scratch / "live.mcap", facts, true));
  EXPECT_EQ(
      LiveRecorder::create(scratch / "b.mcap", {.markers = {"A", "A"}, .rate_hz = 1.0}, false).error().code,
      Code::usage);
}

}  // namespace
}  // namespace kinemark::pipeline
