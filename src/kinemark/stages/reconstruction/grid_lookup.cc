// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/reconstruction/grid_lookup.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"

namespace kinemark::reconstruction {
namespace {

Eigen::Vector2d node_at(const data::RatioTable& table, int i, int j) {
  return Eigen::Map<const Eigen::Vector2d>(table.uv.data() + 2 * (i * table.nodes + j));
}

struct Lagrange {
  std::array<double, 3> weight, slope;
  explicit Lagrange(double x)
      : weight{0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)}, slope{x - 0.5, -2.0 * x, x + 0.5} {}
};

}  // namespace

Eigen::Vector2d detector_ratios(const Eigen::Vector4d& counts) {
  const double x = counts(0) + counts(1), y = counts(2) + counts(3);
  if (!(x > 0.0) || !(y > 0.0)) return Eigen::Vector2d::Constant(kNaN);
  return {(counts(0) - counts(1)) / x, (counts(2) - counts(3)) / y};
}

Eigen::Vector2d look_up(const data::RatioTable& table, const Eigen::Vector2d& ratio) {
  check(table.nodes >= 3, "a look-up table needs 3 x 3 nodes or more");
  if (!ratio.allFinite()) return Eigen::Vector2d::Constant(kNaN);
  int i = 0, j = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (int a = 0; a < table.nodes; ++a)
    for (int b = 0; b < table.nodes; ++b)
      if (const double d = (ratio - node_at(table, a, b)).squaredNorm(); d < nearest)
        nearest = d, i = a, j = b;
  i = std::clamp(i, 1, table.nodes - 2);
  j = std::clamp(j, 1, table.nodes - 2);
  constexpr int kSteps = 25;
  constexpr double kLongestStep = 0.7, kFarthest = 4.0;  // pitches
  Eigen::Vector2d s = Eigen::Vector2d::Zero();
  for (int step = 0; step < kSteps; ++step) {
    const Lagrange la(s.x()), lb(s.y());
    Eigen::Vector2d misfit = -ratio;
    Eigen::Matrix2d jacobian = 1e-12 * Eigen::Matrix2d::Identity();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        const Eigen::Vector2d node = node_at(table, i + static_cast<int>(a) - 1, j + static_cast<int>(b) - 1);
        misfit += la.weight[a] * lb.weight[b] * node;
        jacobian.col(0) += la.slope[a] * lb.weight[b] * node;
        jacobian.col(1) += la.weight[a] * lb.slope[b] * node;
      }
    Eigen::Vector2d move = jacobian.inverse() * misfit;
    if (!move.allFinite()) return Eigen::Vector2d::Constant(kNaN);
    move = move.cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
    s = (s - move).cwiseMax(-kFarthest).cwiseMin(kFarthest);
    if (move.squaredNorm() < 1e-24) break;
  }
  const double middle = 0.5 * (table.nodes - 1);
  return table.spacing_m * Eigen::Vector2d(i + s.x() - middle, j + s.y() - middle);
}

Eigen::Vector3d meet_midway(std::span<const data::Camera> cameras,
                            std::span<const Eigen::Vector2d> on_plane) {
  check(cameras.size() >= 2 && on_plane.size() >= 2, "the midpoint of two rays needs two cameras");
  std::array<Eigen::Vector3d, 2> origin, direction;
  for (std::size_t c = 0; c < 2; ++c) {
    const math::SE3 world_from_cam = cameras[c].cam_from_world.inverse();
    origin[c] = world_from_cam.translation;
    direction[c] =
        world_from_cam.rotation *
        Eigen::Vector3d(on_plane[c].x(), on_plane[c].y(), cameras[c].table.distance_m).normalized();
  }
  const Eigen::Vector3d base = origin[0] - origin[1];
  const double b = direction[0].dot(direction[1]), d = direction[0].dot(base), e = direction[1].dot(base);
  const double across = 1.0 - b * b;
  if (!(across > 1e-12)) return Eigen::Vector3d::Constant(kNaN);
  return 0.5 *
         (origin[0] + (b * e - d) / across * direction[0] + origin[1] + (e - b * d) / across * direction[1]);
}

}  // namespace kinemark::reconstruction
