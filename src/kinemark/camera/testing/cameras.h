// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cameras with every kind of imperfection, for the tests of this folder.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "kinemark/camera/parameters.h"
#include "kinemark/core/random.h"
#include "kinemark/data/rig.h"
#include "kinemark/math/euler.h"

namespace kinemark::camera {

/// Three metres from the origin and looking there, somewhat off; everything drawn from the seed.
inline data::Camera imperfect_camera(data::CameraKind kind, data::DetectorKind detector, std::uint64_t seed) {
  Random random(seed, 7);
  const auto g = [&random](double size) { return size * random.gaussian(); };
  data::Camera c;
  c.name = "test";
  c.kind = kind;
  Eigen::Vector3d rotation{g(0.05), g(0.05), g(0.05)};
  Eigen::Matrix3d facing = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  c.cam_from_world.rotation = math::exp_so3(rotation) * facing;
  const Eigen::Vector3d centre{g(0.1), g(0.1), 3.0 + g(0.1)};
  c.cam_from_world.translation = -(c.cam_from_world.rotation * centre);
  const bool pinhole = kind == data::CameraKind::pinhole;
  c.focal = pinhole ? 1200.0 : 4.95;
  c.aspect = 1.0 + g(0.002);
  c.principal_point = pinhole ? Eigen::Vector2d(641.0, 355.0) : Eigen::Vector2d(0.01, -0.015);
  c.distortion = {-0.2 + g(0.03), 0.3, g(0.1), g(5e-4), g(5e-4)};
  if (pinhole) return c;
  c = with_warp_degree(c, 6);
  auto& d = c.detector;
  d.kind = detector;
  for (auto* warp : {&d.warp_x, &d.warp_y})
    for (double& v : *warp) v = g(0.003);
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 4; ++k) {
      d.crosstalk(j, k) = g(0.01);
    }
  for (int k = 0; k < 4; ++k) {
    d.gain[k] = 1.0 + g(0.005);
    d.offset_counts[k] = g(2.0);
  }
  if (detector == data::DetectorKind::generic) {
    d.generic_degree = 3;
    d.generic.resize(30);
    for (double& v : d.generic) v = 0.25 + g(0.1);
  }
  return c;
}

/// Points within half a metre of the origin.
inline Eigen::Vector3d some_point(Random& random) {
  return {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)};
}

/// Jacobian of f (n numbers) at x by central differences of the fourth order.
inline Eigen::MatrixXd differences(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f,
                                   const Eigen::VectorXd& x, double h) {
  const auto n = f(x).size();
  Eigen::MatrixXd jacobian(n, x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto at = [&](double step) -> Eigen::VectorXd {
      Eigen::VectorXd there = x;
      there[i] += step;
      return f(there);
    };
    jacobian.col(i) = (at(-2 * h) - 8.0 * at(-h) + 8.0 * at(h) - at(2 * h)) / (12.0 * h);
  }
  return jacobian;
}

}  // namespace kinemark::camera
