// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/light.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/camera/response.h"
#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/math/scale_free.h"

namespace kinemark::calibration {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One sight of an LED: what its light would be if it faced the camera and the camera's constant were 1.
struct Sight {
  int led = 0, camera = 0;
  Vector3d to_camera_in_tree, to_camera_in_world;  ///< directions of length 1
  double light = 0.0;                              ///< counts m^2
};

std::vector<Sight> sights_of(const StillPoses& poses, std::span<const math::SE3> world_from_tree,
                             const data::Rig& rig) {
  std::vector<Sight> out;
  for (int p = 0; p < poses.poses(); ++p) {
    const auto& pose = world_from_tree[at(p)];
    if (!pose.translation.allFinite() || !pose.rotation.allFinite()) continue;
    for (int led = 0; led < poses.leds(); ++led)
      for (int c = 0; c < poses.cameras; ++c) {
        const auto& seen = poses.at(p, led, c);
        if (!seen.seen()) continue;
        const auto& camera = rig.cameras[at(c)];
        const Vector3d x = pose * poses.tree[at(led)];
        const auto response = camera::respond(camera, x);
        if (!response.in_front || !response.on_sheet) continue;
        const auto found = math::eliminate_scale(seen.counts - camera.detector.offset_counts, response.phi);
        if (!(found.scale > 0.0)) continue;
        const Vector3d to_camera = camera.centre_in_world() - x;
        const double distance = to_camera.norm(), depth = (camera.cam_from_world * x).z();
        out.push_back({.led = led,
                       .camera = c,
                       .to_camera_in_tree = pose.rotation.transpose() * to_camera / distance,
                       .to_camera_in_world = to_camera / distance,
                       .light = found.scale * distance * distance * distance / depth});
      }
  }
  return out;
}

/// Constants of the cameras, and the squares of what they leave of the sights' light.
struct Constants {
  std::vector<double> constant;
  double squares = 0.0;
};

/// Light times direction of each LED, and the constant of each camera, in turns by least squares; the light
/// is 1 in the mean. Directions are fixed in the frame that `to_camera` is in.
Constants fit_constants(const std::vector<Sight>& sights, std::size_t leds, std::size_t cameras,
                        Vector3d Sight::* to_camera) {
  constexpr int kTurns = 5000;       // directions that stay in the room part from the constants slowly
  constexpr double kSettled = 1e-9;  // of a constant, from one turn to the next
  constexpr double kFacing = 0.05;   // sights that the prior, an LED that faces the cameras, weighs
  Constants out{.constant = std::vector<double>(cameras, 1.0)};
  std::vector<Vector3d> shining(leds, Vector3d::Zero());
  for (int turn = 0; turn < kTurns; ++turn) {
    std::vector<Matrix3d> square(leds, Matrix3d::Zero());
    std::vector<Vector3d> right(leds, Vector3d::Zero()), mean = right;
    std::vector<double> light(leds, 0.0), count = light;
    for (const auto& s : sights) {
      const double y = s.light / out.constant[at(s.camera)];
      const Vector3d& to = s.*to_camera;
      square[at(s.led)] += to * to.transpose();
      right[at(s.led)] += y * to;
      mean[at(s.led)] += to;
      light[at(s.led)] += y, count[at(s.led)] += 1.0;
    }
    double sum = 0.0, seen_leds = 0.0;
    for (std::size_t l = 0; l < leds; ++l) {
      if (count[l] < 1.0) continue;
      const Vector3d facing = mean[l].normalized() * light[l] / count[l];
      shining[l] = (square[l] + kFacing * Matrix3d::Identity()).ldlt().solve(right[l] + kFacing * facing);
      sum += shining[l].norm(), seen_leds += 1.0;
    }
    for (auto& m : shining) m *= seen_leds / sum;
    std::vector<double> above(cameras, 0.0), below = above;
    for (const auto& s : sights) {
      const double seen = shining[at(s.led)].dot(s.*to_camera);
      above[at(s.camera)] += s.light * seen, below[at(s.camera)] += seen * seen;
    }
    double change = 0.0;
    for (std::size_t c = 0; c < cameras; ++c) {
      const double before = std::exchange(out.constant[c], above[c] / below[c]);
      change = std::max(change, std::abs(out.constant[c] / before - 1.0));
    }
    if (change < kSettled) break;
  }
  for (const auto& s : sights)
    out.squares += std::pow(s.light - out.constant[at(s.camera)] * shining[at(s.led)].dot(s.*to_camera), 2);
  return out;
}

}  // namespace

void find_light_counts(const StillPoses& poses, std::span<const math::SE3> world_from_tree, data::Rig& rig) {
  constexpr int kFewest = 10;
  check(std::cmp_equal(world_from_tree.size(), poses.poses()), "one pose of the tree each");
  const auto sights = sights_of(poses, world_from_tree, rig);
  std::vector<int> of_camera(rig.cameras.size(), 0);
  for (const auto& s : sights) ++of_camera[at(s.camera)];
  if (of_camera.empty() || *std::ranges::min_element(of_camera) < kFewest) return;
  const auto with_tree =
      fit_constants(sights, poses.tree.size(), rig.cameras.size(), &Sight::to_camera_in_tree);
  const auto in_world =
      fit_constants(sights, poses.tree.size(), rig.cameras.size(), &Sight::to_camera_in_world);
  const auto& better = with_tree.squares < in_world.squares ? with_tree : in_world;
  for (std::size_t c = 0; c < better.constant.size(); ++c)
    if (std::isfinite(better.constant[c]) && better.constant[c] > 0.0)
      rig.cameras[c].detector.light_counts = better.constant[c];
}

}  // namespace kinemark::calibration
