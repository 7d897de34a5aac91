// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/triangle_mesh.h"

namespace kinemark::io::internal {

/// VTK's PolyData in XML. Fails with a sentence that does not name the file, as all here.
[[nodiscard]] Result<data::TriangleMesh> parse_vtp(std::string_view bytes);

/// Stereolithography, binary or ASCII.
[[nodiscard]] Result<data::TriangleMesh> parse_stl(std::string_view bytes);

/// Wavefront: lines that begin with "v" and "f".
[[nodiscard]] Result<data::TriangleMesh> parse_obj(std::string_view bytes);

}  // namespace kinemark::io::internal
