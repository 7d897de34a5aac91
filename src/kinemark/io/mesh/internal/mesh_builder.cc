// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/mesh/internal/mesh_builder.h"

#include <fmt/core.h>

#include <bit>
#include <unordered_map>
#include <utility>

namespace kinemark::io::internal {
namespace {

constexpr double kFarthest_m = 1e6;  // beyond it nobody's body is, and squares stay far from overflow

struct Place {
  std::uint64_t x, y, z;
  bool operator==(const Place&) const = default;
};

struct PlaceHash {
  std::size_t operator()(const Place& p) const {
    std::uint64_t h = p.x;
    for (const std::uint64_t next : {p.y, p.z}) h = std::rotl(h * 0x9e3779b97f4a7c15ULL, 29) ^ next;
    return static_cast<std::size_t>(h * 0x9e3779b97f4a7c15ULL);
  }
};

Place place_of(const Eigen::Vector3d& x) {
  // Adding 0 makes one zero of both.
  return {std::bit_cast<std::uint64_t>(x.x() + 0.0), std::bit_cast<std::uint64_t>(x.y() + 0.0),
          std::bit_cast<std::uint64_t>(x.z() + 0.0)};
}

}  // namespace

void MeshBuilder::note(std::string sentence) {
  if (error_.empty()) error_ = std::move(sentence);
}

void MeshBuilder::add_point(const Eigen::Vector3d& x, std::string_view place) {
  if (failed()) return;
  if (mesh_.points.size() >= kMost) return note(fmt::format("has more than {} points", kMost));
  if (!x.allFinite() || x.cwiseAbs().maxCoeff() > kFarthest_m)
    return note(fmt::format("{}: a point is not finite, or farther than {:g} m away", place, kFarthest_m));
  mesh_.points.push_back(x);
}

bool MeshBuilder::are_points(std::span<const std::int64_t> corners, std::string_view place) {
  if (failed()) return false;
  for (const std::int64_t corner : corners)
    if (corner < 0 || corner >= std::ssize(mesh_.points)) {
      note(fmt::format("{}: a face has point {} (from 0), and there are {}", place, corner,
                       mesh_.points.size()));
      return false;
    }
  return true;
}

void MeshBuilder::add_triangle(std::int64_t a, std::int64_t b, std::int64_t c) {
  if (mesh_.triangles.size() >= kMost) return note(fmt::format("has more than {} triangles", kMost));
  mesh_.triangles.push_back(
      {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
}

void MeshBuilder::add_polygon(std::span<const std::int64_t> corners, std::string_view place) {
  if (!are_points(corners, place)) return;
  for (std::size_t i = 2; i < corners.size(); ++i) add_triangle(corners[0], corners[i - 1], corners[i]);
}

void MeshBuilder::add_strip(std::span<const std::int64_t> corners, std::string_view place) {
  if (!are_points(corners, place)) return;
  for (std::size_t i = 2; i < corners.size(); ++i)  // every second one turns the other way
    add_triangle(corners[i - 2 + i % 2], corners[i - 1 - i % 2], corners[i]);
}

Result<data::TriangleMesh> MeshBuilder::finish() {
  if (failed()) return fail(Code::bad_input, error_);
  std::unordered_map<Place, std::uint32_t, PlaceHash> known;
  data::TriangleMesh out;
  const auto joined = [&](std::uint32_t corner) {
    const auto [at, is_new] =
        known.try_emplace(place_of(mesh_.points[corner]), static_cast<std::uint32_t>(out.points.size()));
    if (is_new) out.points.push_back(mesh_.points[corner]);
    return at->second;
  };
  for (const auto& [a, b, c] : mesh_.triangles) {
    const auto i = joined(a), j = joined(b), k = joined(c);
    if (i != j && j != k && k != i) out.triangles.push_back({i, j, k});
  }
  if (out.empty()) return fail(Code::bad_input, "holds no triangle and no polygon");
  return out;
}

}  // namespace kinemark::io::internal
