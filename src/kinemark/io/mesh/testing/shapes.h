// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces of known area and volume, and the files that hold them.
#pragma once

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "kinemark/data/triangle_mesh.h"

namespace kinemark::io::testing {

/// A cube of this edge about the origin, twelve triangles seen from outside.
inline data::TriangleMesh cube(double edge) {
  data::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.points.emplace_back(
        0.5 * edge * Eigen::Vector3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// An ellipsoid of these half axes: rings of `around` points, as many as `across`, and two poles on z.
inline data::TriangleMesh ellipsoid(const Eigen::Vector3d& half, std::uint32_t around, std::uint32_t across) {
  data::TriangleMesh mesh;
  for (std::uint32_t i = 0; i < across; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const double polar = std::numbers::pi * (i + 1) / (across + 1),
                   turn = 2 * std::numbers::pi * k / around;
      mesh.points.emplace_back(half.x() * std::sin(polar) * std::cos(turn),
                               half.y() * std::sin(polar) * std::sin(turn), half.z() * std::cos(polar));
    }
  const std::uint32_t top = around * across;
  mesh.points.emplace_back(0.0, 0.0, half.z());
  mesh.points.emplace_back(0.0, 0.0, -half.z());
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around, last = (across - 1) * around;
    mesh.triangles.push_back({top, k, next});
    mesh.triangles.push_back({top + 1, last + next, last + k});
    for (std::uint32_t i = 0; i + 1 < across; ++i) {
      const std::uint32_t a = i * around, b = a + around;
      mesh.triangles.push_back({a + k, b + k, b + next});
      mesh.triangles.push_back({a + k, b + next, a + next});
    }
  }
  return mesh;
}

/// Enclosed volume, above 0 where triangles are seen from outside.
inline double volume(const data::TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c])) / 6.0;
  return sum;
}

inline std::string obj_of(const data::TriangleMesh& mesh) {
  std::string text = "# a mesh\no part\n";
  for (const auto& x : mesh.points) text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
  for (const auto& [a, b, c] : mesh.triangles)
    text += fmt::format("f {}/1/1 {}//1 {}\n", a + 1, b + 1, c + 1);
  return text;
}

inline std::string stl_text_of(const data::TriangleMesh& mesh) {
  std::string text = "solid part\n";
  for (const auto& t : mesh.triangles) {
    text += "  facet normal 0 0 1\n    outer loop\n";
    for (const auto corner : t) {
      const auto& x = mesh.points[corner];
      text += fmt::format("      vertex {} {} {}\n", x.x(), x.y(), x.z());
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid part\n";
}

/// @param head  the first of 80 bytes
inline std::string stl_bytes_of(const data::TriangleMesh& mesh, std::string head = "binary") {
  head.resize(80, ' ');
  const auto put = [&head](auto value) { head.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(0.0F);
    for (const auto corner : t)
      for (const double v : mesh.points[corner]) put(static_cast<float>(v));
    put(std::uint16_t{0});
  }
  return head;
}

/// @param polys  put between the points and the end
inline std::string vtp_around(std::size_t points, std::size_t polygons, const std::string& positions,
                              const std::string& polys, const std::string& file = "") {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"{}>\n"
      "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n<PointData Normals=\"Normals\"/>\n<Points>\n{}</Points>\n{}</Piece>\n"
      "</PolyData>\n</VTKFile>\n",
      file, points, polygons, positions, polys);
}

inline std::string vtp_of(const data::TriangleMesh& mesh) {
  std::string positions = "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (const auto& x : mesh.points) positions += fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  std::string corners = "<Polys>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n";
  std::string ends = "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const auto corner : mesh.triangles[i]) corners += fmt::format("{} ", corner);
    ends += fmt::format("{} ", 3 * (i + 1));
  }
  return vtp_around(mesh.points.size(), mesh.triangles.size(), positions + "</DataArray>\n",
                    corners + "</DataArray>\n" + ends + "</DataArray>\n</Polys>\n");
}

}  // namespace kinemark::io::testing
