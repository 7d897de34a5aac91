// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/triangle_mesh.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinemark::data {
namespace {

TriangleMesh triangle() {
  return {.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, .triangles = {{0, 1, 2}}};
}

TEST(TriangleMesh, IsEmptyWithoutATriangle) {
  EXPECT_FALSE(triangle().empty());
  EXPECT_TRUE(TriangleMesh{.points = triangle().points}.empty());
}

TEST(TriangleMesh, HasCornersThatArePoints) {
  auto mesh = triangle();
  EXPECT_TRUE(mesh.validate());
  mesh.triangles.push_back({0, 1, 3});
  const auto valid = mesh.validate();
  ASSERT_FALSE(valid);
  EXPECT_NE(valid.error().message.find("triangle 1"), std::string::npos);
}

TEST(TriangleMesh, HasFinitePoints) {
  auto mesh = triangle();
  mesh.points[2].y() = std::numeric_limits<double>::quiet_NaN();
  const auto valid = mesh.validate();
  ASSERT_FALSE(valid);
  EXPECT_NE(valid.error().message.find("point 2"), std::string::npos);
}

}  // namespace
}  // namespace kinemark::data
