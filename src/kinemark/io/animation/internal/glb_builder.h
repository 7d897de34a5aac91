// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::animation {

using Json = nlohmann::ordered_json;

/// Three corners, counter-clockwise when seen from outside.
using Triangle = std::array<Eigen::Vector3f, 3>;

/// Gathers a glTF scene and its numbers, and writes both as one GLB.
class GlbBuilder {
 public:
  GlbBuilder();

  /// A node; its index. It stands in the scene unless `parent` has it.
  int add_node(Json node, int parent = -1);
  /// A shape of flat faces; its index as a mesh.
  int add_mesh(std::string_view name, std::span<const Triangle> triangles,
               const std::array<double, 3>& colour);
  /// Times of an animation, s, increasing; an index for animate().
  int add_times(std::span<const float> times_s);
  /// Animates "translation", "rotation" or "scale" of a node: 3, 4 or 3 numbers for each time. `steps`: no
  /// value between two times.
  void animate(int node, std::string_view path, int times, std::span<const float> values, bool steps = false);
  /// Facts about the scene that no other place holds.
  void add_extra(std::string_view key, Json value) {
    root_["scenes"][0]["extras"][std::string(key)] = std::move(value);
  }

  /// Code::not_supported when it is over 4 GiB; else as OutputFile.
  Status write(const std::filesystem::path& path, bool force);

 private:
  int add_floats(std::span<const float> values, std::size_t components, bool bounds, int target = 0);

  Json root_;
  std::string numbers_;
};

}  // namespace kinemark::io::animation
