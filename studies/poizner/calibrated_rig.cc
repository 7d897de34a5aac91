// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/calibrated_rig.h"

#include <algorithm>
#include <array>
#include <chrono>

#include "kinemark/camera/light.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/stages/calibration/grid_lut.h"
#include "kinemark/stages/calibration/still_poses.h"
#include "kinemark/stages/reconstruction/grid_lookup.h"

namespace kinemark::studies {
namespace {

/// Pairs of points to lay on each other.
struct Pairs {
  std::vector<Eigen::Vector3d> from, to;

  [[nodiscard]] math::SE3 fit() const {
    const auto n = static_cast<Eigen::Index>(from.size());
    return math::fit_rigid(Eigen::Map<const Eigen::Matrix3Xd>(from.front().data(), 3, n),
                           Eigen::Map<const Eigen::Matrix3Xd>(to.front().data(), 3, n))
        .target_from_source;
  }
};

constexpr int kAligned = 60;  // poses that lay a method's world on the true one

math::SE3 align_ours(const CalibratedRig& rig, const calibration::StillPoses& tree,
                     const simulation::TreePosesRecording& recorded) {
  Pairs pairs;
  for (int pose = 0; pose < std::min(kAligned, tree.poses()); ++pose)
    for (int led = 0; led < tree.leds(); ++led) {
      const auto p = static_cast<std::size_t>(pose), l = static_cast<std::size_t>(led);
      pairs.from.push_back(rig.bundle.report.world_from_tree[p] * tree.tree[l]);
      pairs.to.emplace_back(recorded.leds_in_world[p].col(led));
    }
  return pairs.fit();
}

math::SE3 align_classic(const data::Rig& classic, const calibration::StillPoses& tree,
                        const simulation::TreePosesRecording& recorded) {
  constexpr double kBright =
      100.0;  // counts of every channel: away from the edge, where the table does not hold
  Pairs pairs;
  for (int pose = 0; pose < std::min(kAligned, tree.poses()); ++pose)
    for (int led = 0; led < tree.leds(); ++led) {
      std::array<Eigen::Vector2d, 2> plane;
      bool bright = true;
      for (int c = 0; c < 2; ++c) {
        const auto& counts = tree.at(pose, led, c).counts;
        bright = bright && counts.minCoeff() > kBright;
        plane[static_cast<std::size_t>(c)] = reconstruction::look_up(
            classic.cameras[static_cast<std::size_t>(c)].table, reconstruction::detector_ratios(counts));
      }
      const Eigen::Vector3d x = reconstruction::meet_midway(classic.cameras, plane);
      if (!bright || !x.allFinite()) continue;
      pairs.from.push_back(x);
      pairs.to.emplace_back(recorded.leds_in_world[static_cast<std::size_t>(pose)].col(led));
    }
  return pairs.fit();
}

}  // namespace

Result<CalibratedRig> calibrate_rig(std::uint64_t seed, CalibratedRigOptions options) {
  options.rig.seed = seed;
  auto physical = simulation::draw_rig(options.rig);
  if (!physical) return std::unexpected(physical.error());
  return calibrate_rig(std::move(*physical), options);
}

Result<CalibratedRig> calibrate_rig(simulation::PhysicalRig physical, const CalibratedRigOptions& options) {
  const auto grid = simulation::record_grid(physical, options.grid);
  if (!grid) return std::unexpected(grid.error());
  simulation::TreePosesOptions poses;
  poses.poses = options.tree_poses;
  poses.recording.intensity.assign(3, options.intensity);
  const auto tree = simulation::record_tree_poses(physical, poses);
  if (!tree) return std::unexpected(tree.error());

  std::vector<calibration::GridObservations> grids;
  for (int c = 0; c < physical.nominal.camera_count(); ++c) {
    auto seen = calibration::grid_observations(grid->counts[static_cast<std::size_t>(c)], physical.nominal, c,
                                               {grid->nodes, grid->spacing_m, grid->distance_m});
    if (!seen) return std::unexpected(seen.error());
    grids.push_back(std::move(*seen));
  }
  auto classic = calibration::calibrate_grid_lut(physical.nominal, grids);
  if (!classic) return std::unexpected(classic.error());
  const auto sides = simulation::tree_sides_m();
  auto shape = calibration::tree_from_sides({sides.begin(), sides.end()});
  if (!shape) return std::unexpected(shape.error());
  const auto still = calibration::still_poses(tree->counts, physical.nominal, *shape, tree->frames_per_pose);
  if (!still) return std::unexpected(still.error());
  if (!options.grid_in_bundle) grids.clear();
  const auto begin = std::chrono::steady_clock::now();
  data::Rig start = *classic;
  camera::begin_in_the_dark(tree->counts, start);
  auto bundle = calibration::calibrate_bundle(start, *still, grids, options.bundle);
  if (!bundle) return std::unexpected(bundle.error());
  camera::find_dark_counts(tree->counts, bundle->rig);
  CalibratedRig out{
      .physical = std::move(physical),
      .classic = std::move(*classic),
      .bundle = std::move(*bundle),
      .bundle_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
      .truth_from_ours = {},
      .truth_from_classic = {}};
  out.truth_from_ours = align_ours(out, *still, *tree);
  out.truth_from_classic = align_classic(out.classic, *still, *tree);
  return out;
}

}  // namespace kinemark::studies
