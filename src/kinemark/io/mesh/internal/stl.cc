// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <bit>
#include <cstring>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"

#include "kinemark/io/mesh/internal/mesh_builder.h"
#include "kinemark/io/mesh/internal/mesh_formats.h"
#include "kinemark/io/mesh/internal/words.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kHead = 84, kFacet = 50;  // bytes of the binary form

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

std::uint32_t count_of(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHead) std::memcpy(&count, bytes.data() + kHead - sizeof(count), sizeof(count));
  return count;
}

/// Binary files may begin with "solid" as well; their size gives them away.
bool is_text(std::string_view bytes) {
  if (bytes.size() >= kHead && bytes.size() == kHead + kFacet * std::size_t{count_of(bytes)}) return false;
  Words words(bytes.substr(0, 2000));
  return words.next() == "solid";
}

void add_triangle(MeshBuilder& mesh) {
  const auto n = static_cast<std::int64_t>(mesh.points());
  mesh.add_polygon(std::array{n - 3, n - 2, n - 1}, "");
}

Result<data::TriangleMesh> parse_text(std::string_view bytes) {
  MeshBuilder mesh;
  std::size_t corners = 0;
  for (std::size_t number = 1; !bytes.empty() && !mesh.failed(); ++number) {
    Words words(take_line(bytes));
    const std::string_view first = words.next();
    if (first == "outer") corners = 0;
    if (first != "vertex") continue;
    Eigen::Vector3d x;
    for (double& v : x) v = parse_number(words.next()).value_or(kNaN);
    mesh.add_point(x, fmt::format("line {}", number));
    if (!mesh.failed() && ++corners == 3) add_triangle(mesh);
    if (corners > 3) mesh.note(fmt::format("line {}: a facet has more than three corners", number));
  }
  return mesh.finish();
}

Result<data::TriangleMesh> parse_binary(std::string_view bytes) {
  const std::size_t count = count_of(bytes);
  if (bytes.size() < kHead || (bytes.size() - kHead) / kFacet < count)
    return fail(
        Code::bad_input,
        fmt::format("is neither an ASCII STL, which begins with \"solid\", nor a binary one: {} bytes "
                    "cannot hold the {} triangles that it names",
                    bytes.size(), count));
  MeshBuilder mesh;
  for (std::size_t i = 0; i < count && !mesh.failed(); ++i) {
    std::array<float, 12> values;  // the normal, then three corners
    std::memcpy(values.data(), bytes.data() + kHead + i * kFacet, sizeof(values));
    const std::string place = fmt::format("triangle {}", i + 1);
    for (std::size_t k = 3; k < 12; k += 3)
      mesh.add_point(Eigen::Vector3f(values[k], values[k + 1], values[k + 2]).cast<double>(), place);
    if (!mesh.failed()) add_triangle(mesh);
  }
  return mesh.finish();
}

}  // namespace

Result<data::TriangleMesh> parse_stl(std::string_view bytes) {
  return is_text(bytes) ? parse_text(bytes) : parse_binary(bytes);
}

}  // namespace kinemark::io::internal
