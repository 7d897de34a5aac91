// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/camera/parameters.h"
#include "kinemark/camera/projection.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/simulation/rig_calibration.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kWellInside = 0.96;  ///< half-sides, before the sheet's warp
constexpr std::int64_t kMostTries = 1'000'000;

bool well_inside(const std::vector<data::Camera>& cameras, const Matrix3d& leds) {
  return std::ranges::all_of(cameras, [&](const data::Camera& camera) {
    for (int l = 0; l < 3; ++l) {
      const auto seen = camera::project(camera, leds.col(l));
      if (!seen.in_front || seen.image.cwiseAbs().maxCoeff() >= kWellInside) return false;
    }
    return true;
  });
}

TreePose draw_pose(Random& random) {
  double u[8];  // the last two are spare: every pose uses as many
  for (double& v : u) v = random.uniform() - 0.5;
  return {.centroid_in_world = {0.7 * u[0], 0.9 * u[1], 1.0 * u[2]},
          .yaw_deg = 100.0 * u[3],
          .pitch_deg = 80.0 * u[4],
          .roll_deg = 360.0 * u[5]};
}

Result<std::vector<TreePose>> draw_poses(const PhysicalRig& rig, const TreePosesOptions& options) {
  std::vector<data::Camera> smooth;
  for (const auto& camera : rig.rig.cameras) smooth.push_back(camera::with_warp_degree(camera, 0));
  Random random(rig.seed, 500 + static_cast<std::uint64_t>(options.set));
  std::vector<TreePose> out;
  for (std::int64_t tries = 0; out.size() < static_cast<std::size_t>(options.poses); ++tries) {
    if (tries == kMostTries)
      return fail(Code::bad_input,
                  "too few poses of the tree are seen by all cameras; check the poses of the cameras");
    const TreePose pose = draw_pose(random);
    if (well_inside(smooth, pose.leds_in_world())) out.push_back(pose);
  }
  return out;
}

Status check_count(int value, int most, const char* what) {
  if (value >= 1 && value <= most) return {};
  return fail(Code::usage, fmt::format("{} {}; need 1 to {}", value, what, most));
}

}  // namespace

Status TreePosesOptions::check() const {
  if (auto s = check_count(poses, 10'000, "poses of the tree"); !s) return s;
  if (auto s = check_count(frames_per_pose, 1000, "frames of each pose"); !s) return s;
  if (set < 0 || set > 1000) return fail(Code::usage, fmt::format("set {} of poses; need 0 to 1000", set));
  return {};
}

Result<TreePosesRecording> record_tree_poses(const PhysicalRig& rig, const TreePosesOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  const auto poses = draw_poses(rig, options);
  if (!poses) return std::unexpected(poses.error());
  TreePosesRecording out;
  out.frames_per_pose = options.frames_per_pose;
  RigRecordingOptions each = options.recording;
  each.frames = options.frames_per_pose;
  each.seed = rig.seed;
  each.threads = 1;
  const auto record_pose = [&](int n) {
    each.t0_s = static_cast<double>(n) * options.frames_per_pose / each.rate_hz;
    each.stream = 10'000 + 1000 * static_cast<std::uint64_t>(options.set) + static_cast<std::uint64_t>(n);
    return record(rig, still_tree((*poses)[static_cast<std::size_t>(n)]), each);
  };
  for (int n = 0; n < options.poses; ++n) {
    const auto one = record_pose(n);
    if (!one) return std::unexpected(one.error());
    if (n == 0) {
      out.counts = one->counts;
      out.counts.time.frames *= options.poses;
    } else {
      const auto append = [](auto& all, const auto& part) {
        all.insert(all.end(), part.begin(), part.end());
      };
      append(out.counts.counts, one->counts.counts);
      append(out.counts.flags, one->counts.flags);
      append(out.counts.dark, one->counts.dark);
    }
    out.leds_in_world.push_back((*poses)[static_cast<std::size_t>(n)].leds_in_world());
  }
  return out;
}

Status ScanOptions::check() const {
  for (int axis = 0; axis < 3; ++axis) {
    if (positions[axis] < 2 || positions[axis] > 50)
      return fail(Code::usage,
                  fmt::format("{} positions along an axis of the scan; need 2 to 50", positions[axis]));
    if (!(size_m[axis] > 0.0) || !(size_m[axis] < 10.0))
      return fail(Code::usage, fmt::format("a scan of {} m; need up to 10 m", size_m[axis]));
  }
  for (const double v : {stage_sd_m, alignment_sd_deg, alignment_sd_m})
    if (!(v >= 0.0) || !(v < 90.0))
      return fail(Code::usage, fmt::format("a standard deviation of {} in the scan; need 0 or more", v));
  return check_count(frames_per_position, 1000, "frames of each position");
}

Result<ScanRecording> record_scan(const PhysicalRig& rig, const ScanOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  ScanRecording out;
  out.frames_per_position = options.frames_per_position;
  Random random(rig.seed, 600);
  const auto gaussians = [&random](double sd) {
    const double x = random.gaussian();
    const double y = random.gaussian();
    const double z = random.gaussian();
    return Vector3d(sd * x, sd * y, sd * z);
  };
  out.world_from_stage.rotation = math::exp_so3(gaussians(options.alignment_sd_deg * kRadPerDeg));
  out.world_from_stage.translation = gaussians(options.alignment_sd_m);
  const int count = options.positions.prod();
  out.x_in_stage.resize(3, count);
  out.x_in_world.resize(3, count);
  for (int n = 0; n < count; ++n) {
    const Eigen::Vector3i at(n / (options.positions.y() * options.positions.z()),
                             n / options.positions.z() % options.positions.y(), n % options.positions.z());
    for (int axis = 0; axis < 3; ++axis)
      out.x_in_stage(axis, n) =
          (static_cast<double>(at[axis]) / (options.positions[axis] - 1) - 0.5) * options.size_m[axis];
    out.x_in_world.col(n) = out.world_from_stage * (out.x_in_stage.col(n) + gaussians(options.stage_sd_m));
  }
  RigRecordingOptions recording = options.recording;
  recording.frames = static_cast<std::int64_t>(count) * options.frames_per_position;
  recording.t0_s = 0.0;
  recording.seed = rig.seed;
  recording.stream = 601;
  const double positions_per_s = recording.rate_hz / options.frames_per_position;
  RigScene scene;
  scene.leds = {"stage"};
  scene.led = [&out, positions_per_s, count](int, double time_s) {
    // An instant of a frame lies well within it; rounding may put its beginning into the frame before.
    const double index = std::floor(time_s * positions_per_s + 1e-9);
    return LedState{.x_in_world =
                        out.x_in_world.col(static_cast<Eigen::Index>(std::clamp(index, 0.0, count - 1.0)))};
  };
  auto recorded = record(rig, scene, recording);
  if (!recorded) return std::unexpected(recorded.error());
  out.counts = std::move(recorded->counts);
  return out;
}

}  // namespace kinemark::simulation
