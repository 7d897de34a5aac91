// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/far_points.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"

namespace kinemark::motion::internal {
namespace {

std::string corner_name(std::size_t sensor, int corner) {
  return fmt::format("sensor {} corner {}", sensor, corner);
}

}  // namespace

Eigen::Matrix<double, 3, kCorners> far_corners() {
  Eigen::Matrix<double, 3, kCorners> corners;
  corners << 1.0, 1.0, -1.0, -1.0,  //
      1.0, -1.0, 1.0, -1.0,         //
      1.0, -1.0, -1.0, 1.0;
  return 0.5 * kFar_m * corners;
}

double far_weight(double marker_variance_m2, double orientation_variance_rad2) {
  // |R - S|^2 is twice the squared angle.
  return marker_variance_m2 / (2.0 * kFar_m * kFar_m * orientation_variance_rad2);
}

data::ModelDescription add_far_points(data::ModelDescription model, const std::vector<int>& bodies) {
  const auto corners = far_corners();
  for (std::size_t s = 0; s < bodies.size(); ++s)
    for (int k = 0; k < kCorners; ++k)
      model.markers.push_back(
          {.name = corner_name(s, k), .body_idx = bodies[s], .x_in_body = corners.col(k)});
  return model;
}

data::Trajectories add_far_points(const data::Trajectories& markers,
                                  const std::vector<Eigen::Matrix3d>& turned,
                                  const std::vector<Eigen::Vector3d>& origin) {
  const auto F = at(markers.frames()), M = markers.names.size();
  const std::size_t S = F == 0 ? 0 : turned.size() / F;
  data::Trajectories out;
  out.time = markers.time;
  out.names = markers.names;
  for (std::size_t s = 0; s < S; ++s)
    for (int k = 0; k < kCorners; ++k) out.names.push_back(corner_name(s, k));
  const std::size_t all = M + S * at(kCorners);
  out.x_in_world.assign(3 * F * all, kNaN);
  out.state.assign(F * all, data::SampleState::missing);
  const auto corners = far_corners();
  for (std::size_t f = 0; f < F; ++f) {
    std::copy_n(markers.x_in_world.data() + 3 * f * M, 3 * M, out.x_in_world.data() + 3 * f * all);
    std::copy_n(markers.state.data() + f * M, M, out.state.data() + f * all);
    for (std::size_t s = 0; s < S; ++s) {
      const Eigen::Matrix3d& R = turned[f * S + s];
      if (!R.allFinite()) continue;
      for (int k = 0; k < kCorners; ++k) {
        const std::size_t sample = f * all + M + s * at(kCorners) + at(k);
        Eigen::Map<Eigen::Vector3d>(out.x_in_world.data() + 3 * sample) =
            origin[f * S + s] + R * corners.col(k);
        out.state[sample] = data::SampleState::measured;
      }
    }
  }
  return out;
}

}  // namespace kinemark::motion::internal
