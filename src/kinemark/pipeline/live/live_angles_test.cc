// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinemark/core/units.h"
#include "kinemark/pipeline/live/live_input.h"

namespace kinemark::pipeline {
namespace {

stream::Frame missing_frame(std::int64_t number, double rate_hz, std::size_t markers) {
  stream::Frame out{.number = number, .time_s = static_cast<double>(number) / rate_hz};
  out.clear(markers);
  return out;
}

TEST(LiveAngles, AreThoseOfTheTrackerInDegreesAndMillimetres) {
  const auto input = open_live_input("sim:reach?rate=100&seconds=1").value();
  const auto& facts = input.source->facts();
  const auto& coordinates = input.model->description().coordinates;
  std::vector<LiveAnglesFrame> shown;
  auto angles =
      LiveAngles::create(input.model, facts, [&](const auto& one) { shown.push_back(one); }).value();
  auto tracker = motion::OnlineTracker::create(*input.model, facts.markers, 100.0).value();
  std::size_t compared = 0;
  const auto compare = [&] {
    while (const auto* pose = tracker.next().value()) {
      ASSERT_LT(compared, shown.size());
      const auto& one = shown[compared++];
      EXPECT_EQ(one.frame, pose->frame);
      for (std::size_t c = 0; c < coordinates.size(); ++c) {
        const double unit = coordinates[c].is_rotation ? kDegPerRad : 1e3;
        const auto i = static_cast<Eigen::Index>(c);
        EXPECT_EQ(one.value[c], static_cast<float>(unit * pose->q[i]));
        if (one.determined[c] == 0) continue;
        EXPECT_EQ(one.sd[c], static_cast<float>(unit * pose->q_sd[i]));
      }
    }
  };
  for (stream::Frame frame; input.source->next(frame).value();) {
    ASSERT_TRUE(angles->push(frame));
    ASSERT_TRUE(tracker.push(
        frame.time_s, Eigen::Map<const Eigen::Matrix3Xd>(frame.x_in_world.data(), 3,
                                                         static_cast<Eigen::Index>(facts.markers.size()))));
    compare();
    EXPECT_EQ(compared, shown.size());
  }
  EXPECT_GT(compared, 10U);
  ASSERT_TRUE(angles->finish());
  EXPECT_EQ(static_cast<std::int64_t>(shown.size()), *facts.frames);
}

TEST(LiveAngles, BeforeMarkersAreSeenNothingIsKnown) {
  const auto input = open_live_input("sim:walk?rate=100&seconds=0.2").value();
  const auto& facts = input.source->facts();
  std::vector<LiveAnglesFrame> shown;
  auto angles =
      LiveAngles::create(input.model, facts, [&](const auto& one) { shown.push_back(one); }).value();
  for (std::int64_t f = 0; f < *facts.frames; ++f)
    ASSERT_TRUE(angles->push(missing_frame(f, 100.0, facts.markers.size())));
  ASSERT_TRUE(angles->finish());
  ASSERT_FALSE(shown.empty());
  EXPECT_TRUE(std::isnan(shown[0].value[0]));
  EXPECT_EQ(shown[0].determined[0], 0);
}

TEST(LiveAngles, AFrameThatDoesNotAdvanceIsRefused) {
  const auto input = open_live_input("sim:walk?rate=100&seconds=0.2").value();
  const auto& facts = input.source->facts();
  auto angles = LiveAngles::create(input.model, facts, [](const auto&) {}).value();
  ASSERT_TRUE(angles->push(missing_frame(3, 100.0, facts.markers.size())));
  EXPECT_FALSE(angles->push(missing_frame(3, 100.0, facts.markers.size())));
}

}  // namespace
}  // namespace kinemark::pipeline
