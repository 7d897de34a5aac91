// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/drawn.h"

#include <gtest/gtest.h>

namespace kinemark::skeleton::internal {
namespace {

TEST(Drawn, FramesAreSpreadEvenly) {
  EXPECT_EQ(draw_evenly(10, 5), (std::vector<std::int64_t>{0, 2, 4, 6, 8}));
  EXPECT_EQ(draw_evenly(3, 5), (std::vector<std::int64_t>{0, 1, 2})) << "no more than there are";
  EXPECT_TRUE(draw_evenly(0, 5).empty());
  const auto many = draw_evenly(1'000'003, 600);
  ASSERT_EQ(many.size(), 600U);
  for (std::size_t i = 1; i < many.size(); ++i) {
    EXPECT_GE(many[i] - many[i - 1], 1666);
    EXPECT_LE(many[i] - many[i - 1], 1667);
  }
}

TEST(Drawn, ACutHasTheSamplesOfItsFrames) {
  auto markers = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 4});
  for (std::int64_t f = 0; f < 4; ++f)
    for (int m = 0; m < 2; ++m) {
      if (f == 2 && m == 1) continue;
      markers.x(f, m) = Eigen::Vector3d(static_cast<double>(f), m, 0.0);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto part = cut(markers, {1, 2});
  EXPECT_EQ(part.frames(), 2);
  EXPECT_EQ(part.names, markers.names);
  EXPECT_EQ(part.x(0, 1), markers.x(1, 1));
  EXPECT_TRUE(part.present(1, 0));
  EXPECT_FALSE(part.present(1, 1)) << "missing in the recording";
  Array<std::uint8_t> mask(8, 1);
  mask[markers.index(1, 0)] = 0;
  EXPECT_FALSE(cut(markers, {1}, mask).present(0, 0));
  EXPECT_TRUE(cut(markers, {1}, mask).present(0, 1));
}

}  // namespace
}  // namespace kinemark::skeleton::internal
