// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/mesh/mesh_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "kinemark/io/file.h"

#include "kinemark/io/mesh/internal/mesh_formats.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kMostBytes = 256UL << 20;

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".vtp" || ending == ".stl" || ending == ".obj";
}

Result<data::TriangleMesh> read_mesh(const std::filesystem::path& path) {
  if (!is_mesh_file(path))
    return fail(Code::not_supported,
                fmt::format("{}: meshes are read from .vtp, .stl and .obj files", path.string()));
  const auto bytes = read_text(path, kMostBytes);
  if (!bytes) return std::unexpected(bytes.error());
  return parse_mesh(*bytes, path.string());
}

Result<data::TriangleMesh> parse_mesh(std::string_view bytes, std::string_view name) {
  const std::string ending = ending_of(std::filesystem::path(name));
  auto mesh = ending == ".vtp"   ? internal::parse_vtp(bytes)
              : ending == ".stl" ? internal::parse_stl(bytes)
                                 : internal::parse_obj(bytes);
  if (!mesh) return fail_at(name, mesh.error());
  return mesh;
}

}  // namespace kinemark::io
