// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kinemark/data/triangle_mesh.h"

namespace kinemark::io {

/// Make meshes coarser until they have `most_triangles` together, or fewer; those that have no more stay as
/// they are. Points that share a cell of a grid become one, placed where the planes of their triangles meet
/// best (P. Lindstrom, Out-of-core simplification of large polygonal models, SIGGRAPH 2000), so that edges
/// and tips stay; cells grow with the square root of a mesh's size, so that small bones keep their shape.
/// Points are then in the order in which triangles use them. O(points and triangles).
void reduce_meshes(std::vector<data::TriangleMesh>& meshes, std::size_t most_triangles);

}  // namespace kinemark::io
