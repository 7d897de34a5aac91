// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/triangle_mesh.h"

namespace kinemark::io {

/// True for what is read here by its ending in any case: .vtp, .stl, .obj.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

/// Read a surface, in the unit of its file taken as metres, as OpenSim does. Polygons become fans of
/// triangles; equal points are kept once; what has fewer than three different corners is left out. Refused in
/// one sentence: an ending that is none of those above, more than 256 MB, more than two million points or
/// triangles, damage, and a file without any triangle.
[[nodiscard]] Result<data::TriangleMesh> read_mesh(const std::filesystem::path& path);

/// The same from bytes; `name` tells the format by its ending, and stands for the file in messages.
[[nodiscard]] Result<data::TriangleMesh> parse_mesh(std::string_view bytes, std::string_view name);

}  // namespace kinemark::io
