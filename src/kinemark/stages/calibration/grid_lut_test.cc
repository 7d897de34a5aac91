// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/grid_lut.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/calibration/testing/recordings.h"

namespace kinemark::calibration {
namespace {

using ::testing::HasSubstr;
namespace ts = testing_support;

/// A grid of 15 x 15 LEDs before camera A, 20 samples; `position` may rotate or mirror it.
template <class Position>
data::Counts record(const data::Rig& rig, const Position& position) {
  data::Rig one = rig;
  one.cameras.resize(1);
  const math::SE3 world_from_cam = one.cameras[0].cam_from_world.inverse();
  const GridObservations grid;
  return ts::count_paths(
      one, 225, 20, 4.0,
      [&](int led, double) {
        const Eigen::Vector2d p = position(grid.position_m(led / 15, led % 15));
        return Eigen::Vector3d(world_from_cam * Eigen::Vector3d(p.x(), p.y(), 3.0));
      },
      3);
}

Eigen::Vector2d upright(const Eigen::Vector2d& p) { return p; }

TEST(GridLut, TableHoldsTheRatiosOfEveryNode) {
  const auto rig = ts::ideal_rig();
  const auto grid = grid_observations(record(rig, upright), rig, 0);
  ASSERT_TRUE(grid) << grid.error().message;
  const auto calibrated = calibrate_grid_lut(rig, {*grid, *grid});
  ASSERT_TRUE(calibrated) << calibrated.error().message;
  EXPECT_TRUE(calibrated->validate());
  const auto& table = calibrated->cameras[0].table;
  EXPECT_EQ(table.nodes, 15);
  EXPECT_NEAR(table.uv[2 * (7 * 15 + 7)], 0.0, 2e-3);  // the middle
  EXPECT_GT(table.uv[2 * (14 * 15 + 7)], 0.8);         // u grows to the right
  EXPECT_GT(table.uv[2 * (7 * 15 + 14) + 1], 0.8);     // v grows downwards
  EXPECT_EQ(calibrated->method, "grid-lut");
}

TEST(GridLut, TellsHowTheGridHungWrong) {
  const auto rig = ts::ideal_rig();
  EXPECT_THAT(
      grid_observations(record(rig, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(-p.x(), p.y()); }),
                        rig, 0)
          .error()
          .message,
      HasSubstr("from behind"));
  EXPECT_THAT(
      grid_observations(record(rig, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(-p); }), rig, 0)
          .error()
          .message,
      HasSubstr("upside down"));
  EXPECT_THAT(
      grid_observations(record(rig, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(-p.y(), p.x()); }),
                        rig, 0)
          .error()
          .message,
      HasSubstr("on its side"));
}

TEST(GridLut, RefusesWhatIsMissing) {
  const auto rig = ts::ideal_rig();
  auto counts = record(rig, upright);
  EXPECT_THAT(grid_observations(counts, rig, 0, {.nodes = 9}).error().message, HasSubstr("225 LEDs; 9 x 9"));
  auto one_dark = counts;
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    one_dark.flags[counts.index(f, 16, 0)] |= data::kCountOccluded;
  const auto grid = grid_observations(one_dark, rig, 0).value();
  EXPECT_THAT(calibrate_grid_lut(rig, {grid, grid}).error().message, HasSubstr("node (1, 1)"));
  EXPECT_THAT(calibrate_grid_lut(rig, {grid}).error().message, HasSubstr("1 grids for 2 cameras"));
  for (std::int64_t f = 0; f < counts.frames(); ++f)
    for (std::int64_t led = 0; led < 30; ++led) counts.flags[counts.index(f, led, 0)] |= data::kCountLost;
  EXPECT_THAT(grid_observations(counts, rig, 0).error().message, HasSubstr("30 of 225"));
}

}  // namespace
}  // namespace kinemark::calibration
