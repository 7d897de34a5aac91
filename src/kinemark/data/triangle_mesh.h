// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A surface of triangles, and where a model has it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/math/se3.h"

namespace kinemark::data {

/// A surface of triangles.
struct TriangleMesh {
  /// Corners of a triangle as places in `points`, from 0, counter-clockwise seen from outside.
  using Triangle = std::array<std::uint32_t, 3>;

  std::vector<Eigen::Vector3d> points;  ///< m, finite
  std::vector<Triangle> triangles;      ///< of the points

  [[nodiscard]] bool empty() const { return triangles.empty(); }  ///< No triangle.
  [[nodiscard]] Status validate() const;                          ///< Points are finite, corners are points.
};

/// A mesh that a model shows on one of its bodies.
struct ShownMesh {
  std::string body;                                 ///< of the model
  std::string file;                                 ///< as the model's file names it, .vtp, .stl or .obj
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< factors of its own x, y, z; applied first
  math::SE3 body_from_mesh;                         ///< m
};

}  // namespace kinemark::data
