// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/segments.h"

#include <array>

namespace kinemark::motion::internal {

std::pair<std::string, std::string> split_side(const std::string& body) {
  if (body.ends_with("_r") || body.ends_with("_l"))
    return {body.substr(0, body.size() - 2), body.substr(body.size() - 2)};
  return {body, ""};
}

std::string segment_of(const std::string& stem) {
  static constexpr std::array<std::pair<const char*, const char*>, 23> kSegments{{
      {"pelvis", "pelvis"}, {"torso", "trunk"},    {"thorax", "trunk"},   {"abdomen", "trunk"},
      {"lumbar", "trunk"},  {"spine", "trunk"},    {"clavicle", "trunk"}, {"scapula", "trunk"},
      {"head", "head"},     {"skull", "head"},     {"neck", "head"},      {"humerus", "upper arm"},
      {"ulna", "forearm"},  {"radius", "forearm"}, {"hand", "hand"},      {"fingers", "hand"},
      {"femur", "thigh"},   {"patella", "thigh"},  {"tibia", "shank"},    {"fibula", "shank"},
      {"talus", "foot"},    {"calcn", "foot"},     {"toes", "foot"},
  }};
  for (const auto& [start, segment] : kSegments)
    if (stem.starts_with(start)) return segment;
  return {};
}

}  // namespace kinemark::motion::internal
