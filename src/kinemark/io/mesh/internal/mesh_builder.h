// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/triangle_mesh.h"

namespace kinemark::io::internal {

/// A mesh that is put together, within bounds. The first thing that is wrong is kept; what follows it is
/// passed over.
class MeshBuilder {
 public:
  static constexpr std::size_t kMost = 2'000'000;  ///< points, and triangles

  /// A point; `place` says in a message where it stands ("line 7").
  void add_point(const Eigen::Vector3d& x, std::string_view place);
  /// A polygon of places in points(), as triangles that share its first corner.
  void add_polygon(std::span<const std::int64_t> corners, std::string_view place);
  /// A strip: every corner from the third on makes a triangle with the two before it.
  void add_strip(std::span<const std::int64_t> corners, std::string_view place);
  /// Note what is wrong.
  void note(std::string sentence);

  [[nodiscard]] bool failed() const { return !error_.empty(); }
  [[nodiscard]] std::size_t points() const { return mesh_.points.size(); }
  /// The mesh, equal points joined; or the sentence. Ends the building.
  [[nodiscard]] Result<data::TriangleMesh> finish();

 private:
  [[nodiscard]] bool are_points(std::span<const std::int64_t> corners, std::string_view place);
  void add_triangle(std::int64_t a, std::int64_t b, std::int64_t c);

  data::TriangleMesh mesh_;
  std::string error_;
};

}  // namespace kinemark::io::internal
