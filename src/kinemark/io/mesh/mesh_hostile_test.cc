// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What lies about its size, ends early or is something else: one sentence each, and little memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/mesh/mesh_file.h"

#include "kinemark/io/mesh/testing/shapes.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

struct Bad {
  const char* name;
  std::string bytes;
  const char* says;
};

std::string triangle_vtp(const std::string& corners, const std::string& ends,
                         const std::string& positions = "0 0 0 1 0 0 0 1 0", const std::string& file = "") {
  const auto array = [](const char* name, const std::string& values) {
    return fmt::format("<DataArray type=\"Int32\" Name=\"{}\" format=\"ascii\">{}</DataArray>", name, values);
  };
  return testing::vtp_around(3, 1, array("Points", positions),
                             "<Polys>" + array("connectivity", corners) + array("offsets", ends) + "</Polys>",
                             file);
}

std::string lying_stl() {
  auto bytes = testing::stl_bytes_of(testing::cube(1.0));
  bytes[83] = '\x7f';
  return bytes;
}

TEST(HostileMeshes, AreOneSentence) {
  const std::vector<Bad> all{
      {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", "a.obj: line 3: a face has point 2 (from 0), and there are 2"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", "line 4: a corner of a face is no number of a point"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "line 4: a corner"},
      {"a.obj", "v 0 0 0\nf -9223372036854775808 1 1\n", "line 2: a face has point"},
      {"a.obj", "v 0 0 nan\n", "line 1: a point is not finite"},
      {"a.obj", "v 0 0\n", "line 1: a point is not finite"},
      {"a.obj", "v 1e300 0 0\n", "farther than"},
      {"a.obj", "<html>", "holds no triangle"},
      {"a.stl", lying_stl(), "cannot hold the"},
      {"a.stl", "solid\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\n", "more than three corners"},
      {"a.stl", "solid\nouter loop\nvertex 0 0\n", "line 3: a point is not finite"},
      {"a.vtp", triangle_vtp("0 1 3", "3"), "<Polys>: a face has point 3"},
      {"a.vtp", triangle_vtp("0 1 -1", "3"), "<Polys>: a face has point -1"},
      {"a.vtp", triangle_vtp("0 1 1e30", "3"), "<Polys>: a face has point -1"},
      {"a.vtp", triangle_vtp("0 1 2", "4"), "an offset is 4; need one from 0 to 3"},
      {"a.vtp", triangle_vtp("0 1 2", "3 1"), "an offset is 1; need one from 3 to 3"},
      {"a.vtp", triangle_vtp("0 1 2", "nan"), "an offset is nan"},
      {"a.vtp", triangle_vtp("0 1 2", "3", "0 0 0 1 0 0 0 1"), "<Points> has 8 numbers"},
      {"a.vtp", triangle_vtp("0 one 2", "3"), "number 2 of an array is \"one\""},
      {"a.vtp", triangle_vtp("0 1 2", "3", "0 0 0 1 0 0 0 1 0", " compressor=\"vtkLZ4DataCompressor\""),
       "packed by vtkLZ4DataCompressor"},
      {"a.vtp", "<VTKFile type=\"ImageData\"><ImageData/></VTKFile>", "is no VTK PolyData"},
      {"a.vtp", "<VTKFile><PolyData>", "is not XML"},
      {"a.vtp", "# vtk DataFile Version 3.0\n", "is not XML"},
  };
  for (const auto& [name, bytes, says] : all) {
    const auto read = parse_mesh(bytes, name);
    ASSERT_FALSE(read) << says;
    EXPECT_THAT(read.error().message, HasSubstr(says));
    EXPECT_THAT(read.error().message, ::testing::Not(HasSubstr("\n")));
  }
}

TEST(HostileMeshes, BigEndianBytesAreNotGuessedAt) {
  auto text = triangle_vtp("0 1 2", "3");
  text.replace(text.find("LittleEndian"), 12, "BigEndian");
  EXPECT_THAT(parse_mesh(text, "a.vtp").error().message, HasSubstr("byte_order is \"BigEndian\""));
}

TEST(HostileMeshes, EveryBeginningOfAFileIsASentenceOrAMesh) {
  const auto made = testing::cube(0.1);
  for (const auto& [name, bytes] :
       {std::pair{"a.vtp", testing::vtp_of(made)}, std::pair{"a.stl", testing::stl_bytes_of(made)},
        std::pair{"a.stl", testing::stl_text_of(made)}, std::pair{"a.obj", testing::obj_of(made)}})
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
      const auto read = parse_mesh(std::string_view(bytes).substr(0, size), name);
      EXPECT_TRUE(read ? read->validate().has_value() : !read.error().message.empty());
    }
}

}  // namespace
}  // namespace kinemark::io
