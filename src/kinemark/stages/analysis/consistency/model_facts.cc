// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/consistency/model_facts.h"

#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

constexpr double kSameAxis = 0.99985;  // cosine of 1 deg

bool are_one_axis(const data::AxisDescription& a, const data::AxisDescription& b) {
  return std::abs(a.axis.normalized().dot(b.axis.normalized())) > kSameAxis;
}

}  // namespace

std::vector<std::string> contradicted_joints(const data::ModelDescription& model) {
  std::vector<std::string> out;
  for (const auto& joint : model.joints) {
    const data::AxisDescription* before = nullptr;
    for (const auto& axis : joint.axes) {
      if (!axis.is_rotation) continue;
      if (axis.coordinate_idx < 0) {
        if (axis.function(0.0).f != 0.0) before = nullptr;  // it turns the next axis away
        continue;
      }
      if (before != nullptr && before->coordinate_idx != axis.coordinate_idx && are_one_axis(*before, axis))
        out.push_back(
            fmt::format("joint '{}' turns about one axis by two coordinates, '{}' and '{}': no marker can "
                        "tell them apart",
                        joint.name, model.coordinates[at(before->coordinate_idx)].name,
                        model.coordinates[at(axis.coordinate_idx)].name));
      before = &axis;
    }
  }
  return out;
}

}  // namespace kinemark::analysis
