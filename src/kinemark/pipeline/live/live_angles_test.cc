// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_angles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/units.h"

namespace kinemark::pipeline {
namespace {

std::span<const double> frame_of(const data::Trajectories& markers, std::int64_t f) {
  return std::span(markers.x_in_world).subspan(3 * markers.index(f, 0), 3 * markers.names.size());
}

TEST(LiveAngles, AreThoseOfTheTrackerInDegreesAndMillimetres) {
  const auto source = open_live_source("sim:reach?rate=100&seconds=1").value();
  auto angles = LiveAngles::create(source).value();
  auto tracker = motion::OnlineTracker::create(*source.model, source.markers.names, 100.0).value();
  const auto& coordinates = source.model->description().coordinates;
  std::int64_t compared = 0;
  for (std::int64_t f = 0; f < source.markers.frames(); ++f) {
    const double time_s = source.markers.time.time_s(f);
    Eigen::Matrix3Xd x(3, source.markers.markers());
    for (std::int64_t m = 0; m < x.cols(); ++m) x.col(m) = source.markers.x(f, m);
    ASSERT_TRUE(angles.push(time_s, frame_of(source.markers, f)));
    ASSERT_TRUE(tracker.push(time_s, x));
    while (const auto* pose = tracker.next().value()) {
      const auto* shown = angles.next().value();
      ASSERT_NE(shown, nullptr);
      EXPECT_EQ(shown->frame, pose->frame);
      for (std::size_t c = 0; c < coordinates.size(); ++c) {
        const double unit = coordinates[c].is_rotation ? kDegPerRad : 1e3;
        const auto i = static_cast<Eigen::Index>(c);
        EXPECT_EQ(shown->value[c], static_cast<float>(unit * pose->q[i]));
        if (shown->determined[c] == 0) continue;
        EXPECT_EQ(shown->sd[c], static_cast<float>(unit * pose->q_sd[i]));
      }
      ++compared;
    }
    EXPECT_EQ(angles.next().value(), nullptr);
  }
  EXPECT_GT(compared, 10);
  angles.finish();
  while (angles.next().value() != nullptr) ++compared;
  EXPECT_EQ(compared, source.markers.frames());
}

TEST(LiveAngles, BeforeMarkersAreSeenNothingIsKnown) {
  auto source = open_live_source("sim:walk?rate=100&seconds=0.2").value();
  for (std::int64_t f = 0; f < source.markers.frames(); ++f)
    for (std::int64_t m = 0; m < source.markers.markers(); ++m) source.markers.set_missing(f, m);
  auto angles = LiveAngles::create(source).value();
  for (std::int64_t f = 0; f < source.markers.frames(); ++f)
    ASSERT_TRUE(angles.push(source.markers.time.time_s(f), frame_of(source.markers, f)));
  angles.finish();
  const auto* shown = angles.next().value();
  ASSERT_NE(shown, nullptr);
  EXPECT_TRUE(std::isnan(shown->value[0]));
  EXPECT_EQ(shown->determined[0], 0);
}

}  // namespace
}  // namespace kinemark::pipeline
