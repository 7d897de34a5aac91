// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Models that the tests of this folder move.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/model.h"
#include "support/test_data.h"

namespace kinemark::simulation {

/// models/human.osim, compiled once.
inline const model::Model& human() {
  static const model::Model model = [] {
    auto description = io::read_osim(testing_support::project_folder() / "models" / "human.osim");
    if (!description) throw std::runtime_error(description.error().message);
    return model::Model::compile(std::move(*description)).value();
  }();
  return model;
}

/// An arm of two bones on a post: two hinges, one locked slide, one coupled and one idle coordinate, a marker
/// on each part.
inline data::ModelDescription small_arm() {
  data::ModelDescription d;
  d.name = "arm";
  for (const char* name : {"post", "upper", "lower"})
    d.bodies.push_back({.name = name, .mass = 2.0, .com_in_body = {0.0, -0.15, 0.0}});
  const auto add = [&](const char* name, double low, double high) {
    d.coordinates.push_back({.name = name, .range_min = low, .range_max = high, .clamped = true});
  };
  add("shoulder", -0.3, 2.0);
  add("elbow", 0.0, 2.5);
  add("slide", -1.0, 1.0);
  add("twist", -9.0, 9.0);
  add("idle", -1.0, 1.0);
  d.coordinates[2].is_rotation = false;
  d.coordinates[2].locked = true;
  d.coordinates[2].default_value = 0.02;
  d.couplings.push_back({.name = "c",
                         .dependent_idx = 3,
                         .independent_idx = 1,
                         .function = math::ScalarFunction::linear(-0.5, 0.1)});
  for (int b = 0; b < 3; ++b) {
    data::JointDescription joint{.name = "j" + std::to_string(b), .type = "CustomJoint"};
    joint.parent_body_idx = b - 1;
    joint.child_body_idx = b;
    joint.parent_from_joint.translation = {0.0, b == 0 ? 1.0 : -0.3, 0.0};
    if (b > 0) joint.axes.push_back({.is_rotation = true, .axis = {0, 0, 1}, .coordinate_idx = b - 1});
    if (b == 2) {
      joint.axes.push_back({.is_rotation = true, .axis = {0, 1, 0}, .coordinate_idx = 3});
      joint.axes.push_back({.is_rotation = false, .axis = {0, 1, 0}, .coordinate_idx = 2});
    }
    d.joints.push_back(joint);
    d.markers.push_back({.name = "m" + std::to_string(b), .body_idx = b, .x_in_body = {0.04, -0.12, 0.01}});
  }
  d.markers.push_back({.name = "floor", .body_idx = data::kGround, .x_in_body = {0.5, 0.0, 0.5}});
  return d;
}

}  // namespace kinemark::simulation
