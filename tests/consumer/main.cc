// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// A stranger's program: one link with a marker at its end, turned by 0.3 rad, found again.
#include <cmath>
#include <cstdio>

#include "kinemark/core/version.h"
#include "kinemark/stages/motion/ik.h"

static_assert(KINEMARK_VERSION_MAJOR == 0);

int main() {
  using namespace kinemark;
  data::ModelDescription arm{.name = "arm"};
  arm.bodies = {{.name = "link", .mass = 1.0}};
  arm.coordinates = {{.name = "angle", .is_rotation = true}};
  data::JointDescription hinge{.name = "hinge", .parent_body_idx = data::kGround, .child_body_idx = 0};
  hinge.axes = {{.axis = Eigen::Vector3d::UnitZ(), .coordinate_idx = 0}};
  arm.joints = {hinge};
  arm.markers = {{.name = "tip", .body_idx = 0, .x_in_body = {1.0, 0.0, 0.0}}};
  const auto model = model::Model::compile(arm);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().message.c_str()), 1;

  auto markers = data::Trajectories::all_missing({"tip"}, {.rate_hz = 100.0, .frames = 1});
  markers.x(0, 0) = Eigen::Vector3d(std::cos(0.3), std::sin(0.3), 0.0);
  markers.state[0] = data::SampleState::measured;
  const auto result = motion::solve_ik(*model, markers);
  if (!result) return std::fprintf(stderr, "%s\n", result.error().message.c_str()), 1;
  std::printf("kinemark %s: angle %.9f rad\n", kVersion, result->motion.q[0]);
  return std::abs(result->motion.q[0] - 0.3) < 1e-9 ? 0 : 1;
}
