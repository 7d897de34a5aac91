// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/recorded_source.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::stream {
namespace {

/// "A" at (f, 0, 1) m and "B" missing in the first frame, at (0, 2, 0) m then; 50 Hz from 3 s on.
data::Trajectories recorded() {
  auto out = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 50.0, .t0_s = 3.0, .frames = 3});
  for (std::int64_t f = 0; f < 3; ++f)
    for (std::int64_t m = 0; m < 2; ++m) {
      if (f == 0 && m == 1) continue;
      out.x(f, m) =
          m == 0 ? Eigen::Vector3d(static_cast<double>(f), 0.0, 1.0) : Eigen::Vector3d(0.0, 2.0, 0.0);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

TEST(RecordedSource, KnowsItsRecordingBeforeTheFirstFrame) {
  const RecordedSource source(
      recorded(), {.name = "replay:a.trc", .up = Eigen::Vector3d::UnitY(), .up_from = "the file"});
  const auto& facts = source.facts();
  EXPECT_EQ(facts.name, "replay:a.trc");
  EXPECT_EQ(facts.markers, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(facts.rate_hz, 50.0);
  EXPECT_EQ(facts.t0_s, 3.0);
  EXPECT_EQ(facts.frames, 3);
  EXPECT_EQ(facts.up, Eigen::Vector3d::UnitY());
  ASSERT_TRUE(facts.extent_m);
  EXPECT_EQ((*facts.extent_m)[0], Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ((*facts.extent_m)[1], Eigen::Vector3d(2.0, 2.0, 1.0));
}

TEST(RecordedSource, GivesEachFrameOnceInOrder) {
  RecordedSource source(recorded(), {});
  Frame frame{.came_ns = 7};
  for (std::int64_t f = 0; f < 3; ++f) {
    ASSERT_EQ(source.next(frame), true);
    EXPECT_EQ(frame.number, f);
    EXPECT_DOUBLE_EQ(frame.time_s, 3.0 + 0.02 * static_cast<double>(f));
    ASSERT_EQ(frame.x_in_world.size(), 6U);
    EXPECT_EQ(frame.x_in_world[0], static_cast<double>(f));
    EXPECT_EQ(std::isnan(frame.x_in_world[4]), f == 0);
    EXPECT_EQ(frame.state[1], f == 0 ? data::SampleState::missing : data::SampleState::measured);
  }
  EXPECT_EQ(frame.came_ns, 7U) << "whoever looks at a clock writes it";
  EXPECT_EQ(source.next(frame), false);
  EXPECT_EQ(source.next(frame), false);
}

TEST(RecordedSource, OfNothingHasNoExtentAndNoFrame) {
  RecordedSource source(data::Trajectories::all_missing({"A"}, {.rate_hz = 50.0, .frames = 0}), {});
  EXPECT_FALSE(source.facts().extent_m);
  Frame frame;
  EXPECT_EQ(source.next(frame), false);
}

TEST(Frame, ClearedHoldsNoMarker) {
  Frame frame{.x_in_world = {1.0, 2.0, 3.0}, .state = {data::SampleState::measured}};
  frame.clear(2);
  ASSERT_EQ(frame.state.size(), 2U);
  EXPECT_EQ(frame.state[0], data::SampleState::missing);
  for (const double x : frame.x_in_world) EXPECT_TRUE(std::isnan(x));
}

}  // namespace
}  // namespace kinemark::stream
