// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <charconv>
#include <optional>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"

#include "kinemark/io/mesh/internal/mesh_builder.h"
#include "kinemark/io/mesh/internal/mesh_formats.h"
#include "kinemark/io/mesh/internal/words.h"

namespace kinemark::io::internal {
namespace {

/// The point of a corner "7", "7/1", "7//3" or "-1" (the last one so far), from 0.
std::optional<std::int64_t> corner_of(std::string_view word, std::size_t points) {
  const std::string_view digits = word.substr(0, word.find('/'));
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value == 0) return std::nullopt;
  return value > 0 ? value - 1 : static_cast<std::int64_t>(points) + value;
}

}  // namespace

Result<data::TriangleMesh> parse_obj(std::string_view bytes) {
  MeshBuilder mesh;
  std::vector<std::int64_t> corners;
  for (std::size_t number = 1; !bytes.empty() && !mesh.failed(); ++number) {
    Words words(take_line(bytes));
    const std::string_view kind = words.next();
    const std::string place = kind == "v" || kind == "f" ? fmt::format("line {}", number) : "";
    if (kind == "v") {
      Eigen::Vector3d x;
      for (double& v : x) v = parse_number(words.next()).value_or(kNaN);
      mesh.add_point(x, place);
    } else if (kind == "f") {
      corners.clear();
      for (auto word = words.next(); !word.empty(); word = words.next()) {
        const auto corner = corner_of(word, mesh.points());
        if (!corner) {
          mesh.note(fmt::format("{}: a corner of a face is no number of a point", place));
          break;
        }
        corners.push_back(*corner);
      }
      mesh.add_polygon(corners, place);
    }
  }
  return mesh.finish();
}

}  // namespace kinemark::io::internal
