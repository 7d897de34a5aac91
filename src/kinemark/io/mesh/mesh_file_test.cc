// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <numbers>

#include "kinemark/io/file.h"

#include "kinemark/io/mesh/testing/shapes.h"

namespace kinemark::io {
namespace {

using data::TriangleMesh;

/// The same surface: points may stand in another order.
void expect_same(const TriangleMesh& read, const TriangleMesh& made, double within) {
  ASSERT_EQ(read.triangles.size(), made.triangles.size());
  EXPECT_EQ(read.points.size(), made.points.size());
  for (std::size_t i = 0; i < made.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LE((read.points[read.triangles[i][k]] - made.points[made.triangles[i][k]]).norm(), within);
  EXPECT_TRUE(read.validate());
}

class Formats : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string file_of(const TriangleMesh& mesh) {
    const std::string_view kind = GetParam();
    return kind == "part.vtp"   ? testing::vtp_of(mesh)
           : kind == "part.stl" ? testing::stl_text_of(mesh)
           : kind == "PART.STL" ? testing::stl_bytes_of(mesh)
                                : testing::obj_of(mesh);
  }
};

TEST_P(Formats, AnEllipsoidComesBack) {
  const auto made = testing::ellipsoid({0.05, 0.08, 0.2}, 24, 15);
  const auto read = parse_mesh(file_of(made), GetParam());
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, made, 1e-7);
  EXPECT_NEAR(testing::volume(*read), 4.0 / 3.0 * std::numbers::pi * 0.05 * 0.08 * 0.2, 8e-5)
      << "seen from outside";
}

TEST_P(Formats, ACubeOfSharedCornersHasEight) {
  const auto read = parse_mesh(file_of(testing::cube(0.25)), GetParam());
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, testing::cube(0.25), 0.0);
}

TEST_P(Formats, NothingIsNoMesh) {
  const auto read = parse_mesh("", GetParam());
  ASSERT_FALSE(read);
  EXPECT_TRUE(read.error().message.starts_with(GetParam())) << read.error().message;
}

INSTANTIATE_TEST_SUITE_P(All, Formats, ::testing::Values("part.vtp", "part.stl", "PART.STL", "part.obj"));

TEST(Meshes, ABinaryStlMayBeginWithSolid) {
  const auto read = parse_mesh(testing::stl_bytes_of(testing::cube(1.0), "solid by a program"), "a.stl");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->triangles.size(), 12U);
}

TEST(Meshes, PolygonsBecomeFans) {
  const auto read = parse_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 2 0\nv 0 1 0\nf 1 2 3 4 5\n", "a.obj");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->triangles, (std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Meshes, CornersOfAnObjMayCountFromTheEnd) {
  const auto read = parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\r\n", "a.obj");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->triangles.front(), (TriangleMesh::Triangle{0, 1, 2}));
}

TEST(Meshes, StripsTurnEverySecondTriangle) {
  const std::string positions =
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0  1 0 0  0 1 0  1 1 0</DataArray>";
  const std::string strips =
      "<Strips><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\">4</DataArray></Strips>";
  const auto read = parse_mesh(testing::vtp_around(4, 0, positions, strips), "a.vtp");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->triangles.size(), 2U);
  for (const auto& [a, b, c] : read->triangles)
    EXPECT_GT((read->points[b] - read->points[a]).cross(read->points[c] - read->points[a]).z(), 0.0);
}

TEST(Meshes, FlatTrianglesAreLeftOut) {
  const auto read = parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 4\nf 1 2 3\n", "a.obj");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->triangles.size(), 1U);
  EXPECT_EQ(read->points.size(), 3U);
}

TEST(Meshes, AreKnownByTheirEnding) {
  EXPECT_TRUE(is_mesh_file("r_pelvis.vtp") && is_mesh_file("A.STL") && is_mesh_file("b/c.Obj"));
  EXPECT_FALSE(is_mesh_file("pelvis.asc") || is_mesh_file("vtp"));
}

TEST(Meshes, AreReadFromFiles) {
  const auto folder = std::filesystem::temp_directory_path() / "kinemark_mesh_file_test";
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(write_text(folder / "cube.stl", testing::stl_bytes_of(testing::cube(0.1)), true));
  EXPECT_EQ(read_mesh(folder / "cube.stl")->triangles.size(), 12U);
  EXPECT_EQ(read_mesh(folder / "none.stl").error().code, Code::io);
  EXPECT_EQ(read_mesh(folder / "cube.ply").error().code, Code::not_supported);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kinemark::io
