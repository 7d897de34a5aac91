// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/triangle_mesh.h"

#include <fmt/core.h>

#include <algorithm>

namespace kinemark::data {

Status TriangleMesh::validate() const {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      return fail(Code::bad_input, fmt::format("point {} of the mesh is not finite", i));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (std::ranges::any_of(triangles[i], [&](std::uint32_t corner) { return corner >= points.size(); }))
      return fail(Code::bad_input,
                  fmt::format("triangle {} of the mesh has a corner that is none of its {} points", i,
                              points.size()));
  return {};
}

}  // namespace kinemark::data
