// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/mesh/mesh_reduction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <unordered_map>

namespace kinemark::io {
namespace {

using data::TriangleMesh;
using Eigen::Vector3d;

constexpr int kTries = 14;        // halvings of the range of cell sizes: to 2 % of a cell
constexpr double kFinest = 1e-4;  // of the size of a mesh
constexpr double kFlat = 0.02;    // directions in which planes bend less than this share do not count
constexpr std::int64_t kMostCells = 1 << 20;  // along an axis

struct Box {
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  [[nodiscard]] double size() const { return (high - low).norm(); }
};

Box box_of(const TriangleMesh& mesh) {
  Box box{mesh.points.front(), mesh.points.front()};
  for (const auto& x : mesh.points) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  return box;
}

/// The cell of each point, numbered from 0 in the order of the points.
struct Cells {
  std::vector<std::uint32_t> of_point;
  std::uint32_t count = 0;
};

Cells cells_of(const TriangleMesh& mesh, const Vector3d& low, double side) {
  Cells cells;
  std::unordered_map<std::int64_t, std::uint32_t> known;
  for (const auto& x : mesh.points) {
    std::int64_t key = 0;
    for (Eigen::Index k = 0; k < 3; ++k)
      key = key * kMostCells +
            std::min<std::int64_t>(kMostCells - 1, static_cast<std::int64_t>((x[k] - low[k]) / side));
    const auto [at, is_new] = known.try_emplace(key, cells.count);
    if (is_new) ++cells.count;
    cells.of_point.push_back(at->second);
  }
  return cells;
}

TriangleMesh::Triangle merged(const Cells& cells, const TriangleMesh::Triangle& t) {
  return {cells.of_point[t[0]], cells.of_point[t[1]], cells.of_point[t[2]]};
}

bool is_whole(const TriangleMesh::Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

std::size_t count_of(const TriangleMesh& mesh, const Cells& cells) {
  return static_cast<std::size_t>(
      std::ranges::count_if(mesh.triangles, [&](const auto& t) { return is_whole(merged(cells, t)); }));
}

/// What stands in one cell: its points, and the planes of the triangles that touch it (a x = b).
struct Cell {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero(), sum = Vector3d::Zero();
  double points = 0.0;

  /// Nearest to all planes; the mean where they do not say, or would lead out of the cell.
  [[nodiscard]] Vector3d place(double side) const {
    const Vector3d mean = sum / points;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(a);
    const Vector3d wanted = of.eigenvectors().transpose() * (b - a * mean);
    Vector3d step = Vector3d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k)
      if (of.eigenvalues()[k] > kFlat * of.eigenvalues()[2]) step[k] = wanted[k] / of.eigenvalues()[k];
    const Vector3d moved = of.eigenvectors() * step;
    return moved.allFinite() && moved.norm() <= side ? Vector3d(mean + moved) : mean;
  }
};

TriangleMesh merged_mesh(const TriangleMesh& mesh, const Cells& cells, double side) {
  std::vector<Cell> parts(cells.count);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    auto& part = parts[cells.of_point[i]];
    part.sum += mesh.points[i];
    part.points += 1.0;
  }
  TriangleMesh out;
  constexpr std::uint32_t kUnused = UINT32_MAX;
  std::vector<std::uint32_t> number(cells.count, kUnused);
  std::set<TriangleMesh::Triangle> known;
  for (const auto& t : mesh.triangles) {
    const Vector3d& x = mesh.points[t[0]];
    const Vector3d normal = (mesh.points[t[1]] - x).cross(mesh.points[t[2]] - x);
    auto corners = merged(cells, t);
    for (const auto cell : corners) {
      parts[cell].a += normal * normal.transpose();
      parts[cell].b += normal * normal.dot(x);
    }
    if (!is_whole(corners)) continue;
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    if (!known.insert(corners).second) continue;
    for (auto& corner : corners) {
      if (number[corner] == kUnused) {
        number[corner] = static_cast<std::uint32_t>(out.points.size());
        out.points.emplace_back(Vector3d::Zero());
      }
      corner = number[corner];
    }
    out.triangles.push_back(corners);
  }
  for (std::uint32_t cell = 0; cell < cells.count; ++cell)
    if (number[cell] != kUnused) out.points[number[cell]] = parts[cell].place(side);
  return out;
}

}  // namespace

void reduce_meshes(std::vector<TriangleMesh>& meshes, std::size_t most_triangles) {
  std::size_t total = 0;
  std::vector<Box> boxes(meshes.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    total += meshes[i].triangles.size();
    if (!meshes[i].points.empty()) boxes[i] = box_of(meshes[i]);
    largest = std::max(largest, boxes[i].size());
  }
  if (total <= most_triangles) return;
  const auto side = [&](std::size_t i, double share) {
    return std::max(1e-12, share * std::sqrt(boxes[i].size() * largest));
  };
  const auto fits = [&](double share) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < meshes.size(); ++i)
      count += count_of(meshes[i], cells_of(meshes[i], boxes[i].low, side(i, share)));
    return count <= most_triangles;
  };
  double fine = kFinest, coarse = 1.0;
  while (!fits(coarse) && coarse < 1e6) coarse *= 4.0;  // in the end a mesh is in one cell
  for (int i = 0; i < kTries; ++i) {
    const double middle = std::sqrt(fine * coarse);
    (fits(middle) ? coarse : fine) = middle;
  }
  for (std::size_t i = 0; i < meshes.size(); ++i)
    meshes[i] = merged_mesh(meshes[i], cells_of(meshes[i], boxes[i].low, side(i, coarse)), side(i, coarse));
}

}  // namespace kinemark::io
