// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/grid_lookup.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "support/lateral_rig.h"

namespace kinemark::reconstruction {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
namespace ts = testing_support;

/// A table of a smooth map from the plane to ratios.
template <class Map>
data::RatioTable table_of(const Map& map) {
  data::RatioTable table{.nodes = 15, .spacing_m = 1.0 / 14.0, .distance_m = 3.0, .uv = {}};
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 15; ++j) {
      const Vector2d uv = map(Vector2d((i - 7) / 14.0, (j - 7) / 14.0));
      table.uv.insert(table.uv.end(), {uv.x(), uv.y()});
    }
  return table;
}

Vector2d distorted(const Vector2d& p) {
  return {1.5 * p.x() + 0.2 * p.x() * p.y() - 0.1 * p.x() * p.x(), 1.4 * p.y() + 0.15 * p.x() * p.x()};
}

TEST(GridLookup, InvertsAQuadraticMapExactly) {
  const auto table = table_of(distorted);
  for (const Vector2d& p :
       {Vector2d(0, 0), Vector2d(0.31, -0.22), Vector2d(-0.44, 0.47), Vector2d(0.02, 0.49)})
    EXPECT_LT((look_up(table, distorted(p)) - p).norm(), 1e-12);
}

TEST(GridLookup, ExtrapolatesALittleBeyondTheGrid) {
  const auto table = table_of(distorted);
  const Vector2d p(0.56, -0.55);
  EXPECT_LT((look_up(table, distorted(p)) - p).norm(), 1e-10);
}

TEST(GridLookup, DarkCountsGiveNoPosition) {
  EXPECT_TRUE(detector_ratios({0, 0, 10, 20}).hasNaN());
  EXPECT_TRUE(
      look_up(table_of(distorted), Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())).hasNaN());
}

TEST(GridLookup, RatiosAreSignedByElectrode) {
  const Vector2d uv = detector_ratios({30, 10, 5, 15});
  EXPECT_DOUBLE_EQ(uv.x(), 0.5);
  EXPECT_DOUBLE_EQ(uv.y(), -0.5);
}

TEST(GridLookup, RaysMeetAtThePoint) {
  auto rig = ts::ideal_rig();
  const Vector3d truth(0.1, -0.2, 0.15);
  std::array<Vector2d, 2> plane;
  for (std::size_t c = 0; c < 2; ++c) {
    rig.cameras[c].table.distance_m = 3.0;
    const Vector3d in_cam = rig.cameras[c].cam_from_world * truth;
    plane[c] = 3.0 * in_cam.head<2>() / in_cam.z();
  }
  EXPECT_LT((meet_midway(rig.cameras, plane) - truth).norm(), 1e-12);
  rig.cameras[1].cam_from_world = rig.cameras[0].cam_from_world;
  plane[1] = plane[0];
  EXPECT_TRUE(meet_midway(rig.cameras, plane).hasNaN());
}

}  // namespace
}  // namespace kinemark::reconstruction
