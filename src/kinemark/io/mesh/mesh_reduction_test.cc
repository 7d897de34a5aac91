// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/mesh/mesh_reduction.h"

#include <gtest/gtest.h>

#include "kinemark/io/mesh/testing/shapes.h"

namespace kinemark::io {
namespace {

using data::TriangleMesh;

TEST(MeshReduction, LeavesWhatIsSmallEnough) {
  std::vector<TriangleMesh> meshes{testing::cube(1.0), testing::cube(0.1)};
  reduce_meshes(meshes, 24);
  EXPECT_EQ(meshes[0].points, testing::cube(1.0).points);
  EXPECT_EQ(meshes[1].triangles, testing::cube(0.1).triangles);
}

TEST(MeshReduction, KeepsTheSurfaceWithinACell) {
  const Eigen::Vector3d half(0.05, 0.08, 0.2);
  std::vector<TriangleMesh> meshes{testing::ellipsoid(half, 160, 120)};
  const double before = testing::volume(meshes[0]);
  reduce_meshes(meshes, 2'000);
  ASSERT_TRUE(meshes[0].validate());
  EXPECT_LE(meshes[0].triangles.size(), 2'000U);
  EXPECT_GE(meshes[0].triangles.size(), 1'400U) << "as fine as fits";
  EXPECT_NEAR(testing::volume(meshes[0]) / before, 1.0, 0.02);
  for (const auto& x : meshes[0].points)
    EXPECT_NEAR(x.cwiseQuotient(half).norm(), 1.0, 0.02) << x.transpose();
}

TEST(MeshReduction, KeepsTheCornersOfABox) {
  // A cube of many small faces: 8 corners stay where they are, as planes meet there.
  TriangleMesh fine;
  const auto put = [&fine](const Eigen::Vector3d& x) {
    fine.points.push_back(x);
    return static_cast<std::uint32_t>(fine.points.size() - 1);
  };
  const auto rough = testing::cube(1.0);
  constexpr int kParts = 24;
  for (const auto& [a, b, c] : rough.triangles)
    for (int i = 0; i < kParts; ++i)
      for (int k = 0; k + i < kParts; ++k) {
        const auto at = [&, &p = rough.points, a = a, b = b, c = c](int u, int v) {
          return put(p[a] + (p[b] - p[a]) * u / kParts + (p[c] - p[a]) * v / kParts);
        };
        fine.triangles.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
        if (k + i + 1 < kParts) fine.triangles.push_back({at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
      }
  std::vector<TriangleMesh> meshes{fine};
  reduce_meshes(meshes, 300);
  EXPECT_LE(meshes[0].triangles.size(), 300U);
  EXPECT_NEAR(testing::volume(meshes[0]), 1.0, 0.02);
  for (const auto& corner : rough.points) {
    double nearest = 1.0;
    for (const auto& x : meshes[0].points) nearest = std::min(nearest, (x - corner).norm());
    EXPECT_LT(nearest, 1e-6) << corner.transpose();
  }
}

TEST(MeshReduction, SharesTheTrianglesSoThatSmallBonesKeepTheirShape) {
  std::vector<TriangleMesh> meshes{testing::ellipsoid({0.2, 0.2, 0.4}, 120, 100),
                                   testing::ellipsoid({0.004, 0.004, 0.02}, 60, 40)};
  reduce_meshes(meshes, 4'000);
  EXPECT_GE(meshes[1].triangles.size(), 60U);
  EXPECT_LE(meshes[0].triangles.size() + meshes[1].triangles.size(), 4'000U);
}

TEST(MeshReduction, MayLeaveNothing) {
  std::vector<TriangleMesh> meshes{testing::cube(1.0), {}};
  reduce_meshes(meshes, 0);
  EXPECT_TRUE(meshes[0].empty() && meshes[1].empty());
}

TEST(MeshReduction, NumbersPointsInTheOrderOfTheirUse) {
  std::vector<TriangleMesh> meshes{testing::ellipsoid({1.0, 1.0, 1.0}, 60, 40)};
  reduce_meshes(meshes, 500);
  std::uint32_t next = 0;
  for (const auto& triangle : meshes[0].triangles)
    for (const auto corner : triangle) {
      EXPECT_LE(corner, next);
      next = std::max(next, corner + 1);
    }
  EXPECT_EQ(next, meshes[0].points.size());
}

}  // namespace
}  // namespace kinemark::io
