// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The same triangle in every way in which VTK writes its arrays.
#include "kinemark/io/mesh/internal/vtk_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "kinemark/io/mesh/mesh_file.h"

#include "kinemark/io/mesh/testing/shapes.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k <= bytes.size() ? kLetters[bits >> (18 - 6 * k) & 63U] : '=');
  }
  return out;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()};
}

struct Way {
  bool wide = false, packed = false;
  enum { inline_base64, appended_base64, appended_raw } where = inline_base64;
};

/// Headers and bytes as VTK writes them. A packed array has blocks of 16 bytes.
std::string encoded(const std::string& bytes, const Way& way) {
  const auto number = [&way](std::uint64_t n) {
    return way.wide ? bytes_of(std::vector{n}) : bytes_of(std::vector{static_cast<std::uint32_t>(n)});
  };
  const auto as_text = [&way](const std::string& all) {
    return way.where == Way::appended_raw ? all : base64(all);
  };
  if (!way.packed) return as_text(number(bytes.size()) + bytes);
  constexpr std::size_t kBlock = 16;
  const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
  std::string head = number(blocks) + number(kBlock) + number(bytes.size() % kBlock), body;
  for (std::size_t at = 0; at < bytes.size(); at += kBlock) {
    const auto part = bytes.substr(at, kBlock);
    uLongf size = compressBound(part.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(part.data()),
             part.size());
    head += number(size);
    body += packed.substr(0, size);
  }
  return as_text(head) + as_text(body);
}

std::string file_of(const Way& way) {
  std::string appended;
  const auto array = [&](const char* type, const char* name, const std::string& bytes) {
    const std::string text = encoded(bytes, way);
    const auto offset = appended.size();
    if (way.where != Way::inline_base64) appended += text;
    return way.where == Way::inline_base64
               ? fmt::format(
                     "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"3\" format=\"binary\">\n  "
                     "{}\n</DataArray>",
                     type, name, text)
               : fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>", type,
                             name, offset);
  };
  const auto positions =
      array("Float64", "Points", bytes_of(std::vector{0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 2.5, 0.0}));
  const auto polys = "<Polys>" +
                     array("Int64", "connectivity", bytes_of(std::vector<std::int64_t>{0, 1, 2})) +
                     array("UInt8", "offsets", bytes_of(std::vector<std::uint8_t>{3})) + "</Polys>";
  std::string head = way.wide ? " header_type=\"UInt64\"" : " header_type=\"UInt32\"";
  if (way.packed) head += " compressor=\"vtkZLibDataCompressor\"";
  auto text = testing::vtp_around(3, 1, positions, polys, head);
  if (way.where != Way::inline_base64)
    text.insert(text.find("</VTKFile>"), fmt::format("<AppendedData encoding=\"{}\">\n _",
                                                     way.where == Way::appended_raw ? "raw" : "base64") +
                                             appended + "\n</AppendedData>\n");
  return text;
}

TEST(VtkArrays, AreReadInEveryWayOfWriting) {
  for (const bool wide : {false, true})
    for (const bool packed : {false, true})
      for (const auto where : {Way::inline_base64, Way::appended_base64, Way::appended_raw}) {
        const auto mesh = parse_mesh(file_of({wide, packed, where}), "a.vtp");
        ASSERT_TRUE(mesh) << mesh.error().message << wide << packed << where;
        ASSERT_EQ(mesh->points.size(), 3U);
        EXPECT_EQ(mesh->points[1], Eigen::Vector3d(1.5, 0.0, 0.0));
        EXPECT_EQ(mesh->points[2], Eigen::Vector3d(0.0, 2.5, 0.0));
      }
}

TEST(VtkArrays, DamageIsASentence) {
  for (const bool packed : {false, true})
    for (const auto where : {Way::inline_base64, Way::appended_base64, Way::appended_raw}) {
      const auto whole = file_of({.wide = false, .packed = packed, .where = where});
      for (std::size_t at = 0; at < whole.size(); ++at) {
        auto damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
        const auto mesh = parse_mesh(damaged, "a.vtp");
        if (mesh) {
          EXPECT_TRUE(mesh->validate());
        } else {
          EXPECT_THAT(mesh.error().message, ::testing::Not(HasSubstr("\n"))) << at;
        }
      }
    }
}

TEST(VtkArrays, AHeaderThatLiesTakesNoMemory) {
  // 4 GB of doubles in eight letters.
  const std::string positions =
      "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">/////w==</DataArray>";
  const auto mesh = parse_mesh(testing::vtp_around(3, 1, positions, ""), "a.vtp");
  ASSERT_FALSE(mesh);
  EXPECT_THAT(mesh.error().message, HasSubstr("an array has 4294967295 bytes"));
  const std::string long_one =
      "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">AAAAAg==</DataArray>";
  EXPECT_THAT(parse_mesh(testing::vtp_around(3, 1, long_one, ""), "a.vtp").error().message,
              HasSubstr("damaged or cut short"));
}

}  // namespace
}  // namespace kinemark::io
