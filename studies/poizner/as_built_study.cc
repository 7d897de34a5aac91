// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/as_built_study.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "kinemark/camera/light.h"
#include "kinemark/camera/projection.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/reconstruction/reconstruct.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "studies/poizner/calibrated_rig.h"
#include "studies/poizner/still_cloud.h"

namespace kinemark::studies {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kFrames = 50, kWheelFrames = 220;
constexpr double kRate_hz = 100.0;
constexpr std::size_t kPositions = 10;
constexpr double kEdge = 0.04;        // half-sides, below the outermost, where two places reach
constexpr double kLeastReach = 0.35;  // half-sides, of all places but the first
constexpr std::int64_t kMostTries = 1'000'000;
constexpr std::uint64_t kPoseStream = 700, kPositionStream = 800, kDriftStream = 950, kTreeStream = 300,
                        kWheelStream = 400;

Vector3d gaussians3(Random& random) {
  const double x = random.gaussian(), y = random.gaussian();
  return {x, y, random.gaussian()};
}

// As the operator set it up and recorded the table with it.
Result<simulation::PhysicalRig> draw(std::uint64_t seed, bool dark_slot, const AsBuiltOptions& options) {
  auto rig = simulation::draw_rig({.seed = seed,
                                   .misalignment = 0.0,
                                   .convergence_deg = options.convergence_deg,
                                   .dark_slot = dark_slot});
  if (!rig) return rig;
  rig->light.stray_share = options.stray_share;
  for (std::size_t c = 0; c < rig->rig.cameras.size(); ++c) {
    Random random(seed, kPoseStream + c);
    auto& camera = rig->rig.cameras[c];
    const Vector3d centre = rig->nominal.cameras[c].centre_in_world() + options.lens_m * gaussians3(random);
    const Vector3d turn = gaussians3(random);
    camera.cam_from_world = simulation::looking_at_origin(
        centre, options.roll_rad * turn[0], options.turn_rad * turn[1], options.turn_rad * turn[2]);
    for (double& offset : camera.detector.offset_counts)
      offset = options.offset_counts * random.gaussian() + (dark_slot ? simulation::kPedestal_counts : 0.0);
  }
  return rig;
}

void drift(std::uint64_t seed, double counts, simulation::PhysicalRig& rig) {
  Random random(seed, kDriftStream);
  for (auto& camera : rig.rig.cameras)
    for (double& offset : camera.detector.offset_counts) offset += counts * random.gaussian();
}

// How far out the outermost LED lies on any detector, half-sides.
double reach_of(const data::Rig& rig, const simulation::TreePose& pose) {
  double out = 0.0;
  const Eigen::Matrix3d leds = pose.leds_in_world();
  for (const auto& camera : rig.cameras)
    for (int led = 0; led < 3; ++led) {
      const auto seen = camera::project(camera, leds.col(led));
      if (!seen.in_front) return INFINITY;
      out = std::max(out, seen.image.cwiseAbs().maxCoeff());
    }
  return out;
}

// Over the field; the first in its middle, the fourth and the eighth at its edge.
Result<std::vector<simulation::TreePose>> tree_poses(const simulation::PhysicalRig& rig, double outermost) {
  Random random(rig.seed, kPositionStream);
  std::vector<simulation::TreePose> out(1);
  for (std::int64_t tries = 0; out.size() < kPositions; ++tries) {
    if (tries == kMostTries)
      return fail(Code::bad_input, "too few places of the tree are seen by both cameras");
    double u[6];
    for (double& v : u) v = random.uniform() - 0.5;
    const simulation::TreePose pose{.centroid_in_world = {0.8 * u[0], 0.95 * u[1], u[2]},
                                    .yaw_deg = 90.0 * u[3],
                                    .pitch_deg = 50.0 * u[4],
                                    .roll_deg = 180.0 * u[5]};
    const double reach = reach_of(rig.rig, pose),
                 least = out.size() == 3 || out.size() == 7 ? outermost - kEdge : kLeastReach;
    if (reach > least && reach < outermost) out.push_back(pose);
  }
  return out;
}

double worst_distance(const StillCloud& cloud) {
  const auto sides = simulation::tree_sides_m();
  double out = kNaN;  // of those whose ends are seen
  for (std::size_t side = 0; side < sides.size(); ++side)
    out = std::fmax(out, std::abs(cloud.distance(kTreeSides[side]) - sides[side]));
  return out;
}

// One rig by one method: that of 1986, or ours, for which the rig has a dark slot.
struct Chain {
  CalibratedRig rig;
  bool classic = true;

  [[nodiscard]] Result<data::Trajectories> locate(const data::Counts& counts) const {
    data::Rig known = rig.bundle.rig;
    camera::follow_dark_counts(counts, known);
    auto found = classic ? reconstruction::reconstruct_classic(counts, rig.classic)
                         : reconstruction::reconstruct(counts, known);
    if (!found) return std::unexpected(found.error());
    // What reconstruct flags is not measured with; the method of 1986 flags nothing.
    for (std::size_t i = 0; !classic && i < found->near_edge.size(); ++i)
      if (found->near_edge[i] != 0) found->points.state[i] = data::SampleState::missing;
    return std::move(found->points);
  }
};

Status study_tree(const Chain& chain, const std::vector<simulation::TreePose>& poses,
                  const AsBuiltOptions& options, AsBuiltMeasures& out) {
  std::vector<double> sds;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    simulation::RigRecordingOptions how{
        .rate_hz = kRate_hz, .frames = kFrames, .seed = chain.rig.physical.seed};
    how.intensity.assign(3, options.tree_light);
    how.stream = kTreeStream + k;
    const auto recorded = simulation::record(
        chain.rig.physical, simulation::still_tree(poses[k], simulation::TreeLeds::turn_with_it), how);
    if (!recorded) return std::unexpected(recorded.error());
    const auto points = chain.locate(recorded->counts);
    if (!points) return std::unexpected(points.error());
    const StillCloud cloud(*points);
    out.worst_distance_m.push_back(worst_distance(cloud));
    for (const auto& variance : cloud.variance)
      for (const double v : variance)
        if (v > 0.0) sds.push_back(std::sqrt(v));
  }
  out.static_sd_m = math::median(sds);
  return {};
}

// One LED, once mirrored from the other side of the axle.
simulation::RigScene wheel_with_glint(const simulation::WheelOptions& wheel, double share) {
  auto scene = simulation::rotating_wheel(wheel);
  const Vector3d hub = simulation::wheel_pose(wheel).translation;
  scene.reflection = [hub, share](int, double time_s, const Vector3d& x_in_world) {
    constexpr double kWhen_s = 1.0, kHalfFrame_s = 0.4 / kRate_hz;
    return simulation::Reflection{.position_in_world = x_in_world + 1.6 * (hub - x_in_world),
                                  .share = std::abs(time_s - kWhen_s) < kHalfFrame_s ? share : 0.0};
  };
  return scene;
}

Eigen::Matrix3Xd seen(const data::Trajectories& points) {
  Eigen::Matrix3Xd out(3, points.frames());
  Eigen::Index count = 0;
  for (std::int64_t f = 0; f < points.frames(); ++f)
    if (points.present(f, 0)) out.col(count++) = points.x(f, 0);
  return out.leftCols(count);
}

Status study_wheel(const Chain& chain, const AsBuiltOptions& options, AsBuiltMeasures& out) {
  const simulation::WheelOptions wheel{.rate_hz = options.wheel_turns * kRate_hz / kWheelFrames};
  const auto recorded = simulation::record(chain.rig.physical, wheel_with_glint(wheel, options.glint_share),
                                           {.rate_hz = kRate_hz,
                                            .frames = kWheelFrames,
                                            .intensity = {options.wheel_light},
                                            .seed = chain.rig.physical.seed,
                                            .stream = kWheelStream});
  if (!recorded) return std::unexpected(recorded.error());
  const auto points = chain.locate(recorded->counts);
  if (!points) return std::unexpected(points.error());
  out.wheel = measure_wheel(seen(*points), wheel.diameter_m);
  return {};
}

}  // namespace

double AsBuiltMeasures::best_place_m() const {
  double out = kNaN;
  for (const double error : worst_distance_m) out = std::fmin(out, error);
  return out;
}
double AsBuiltMeasures::worst_place_m() const {
  double out = kNaN;
  for (const double error : worst_distance_m) out = std::fmax(out, error);
  return out;
}

Result<AsBuiltOutcome> study_as_built(std::uint64_t seed, const AsBuiltOptions& options) {
  AsBuiltOutcome out;
  for (const bool classic : {true, false}) {
    auto physical = draw(seed, !classic, options);
    if (!physical) return std::unexpected(physical.error());
    const auto poses = tree_poses(*physical, options.outermost);
    if (!poses) return std::unexpected(poses.error());
    auto rig = calibrate_rig(std::move(*physical), {.grid = options.grid});
    if (!rig) return std::unexpected(rig.error());
    Chain chain{std::move(*rig), classic};
    drift(seed, options.drift_counts, chain.rig.physical);
    auto& measures = classic ? out.classic : out.ours;
    if (auto s = study_tree(chain, *poses, options, measures); !s) return std::unexpected(s.error());
    if (auto s = study_wheel(chain, options, measures); !s) return std::unexpected(s.error());
    if (classic)
      for (const auto& pose : *poses) out.from_middle_m.push_back(pose.centroid_in_world.norm());
  }
  return out;
}

std::vector<StudyRow> as_built_rows(const std::vector<AsBuiltOutcome>& rigs) {
  struct Line {
    const char* what;
    std::optional<double> paper;
    double unit;
    std::function<double(const AsBuiltMeasures&)> get;
  };
  const std::vector<Line> lines{
      {"tree, best of ten places: largest error of a distance", 2.0, 1e3,
       [](const auto& m) { return m.best_place_m(); }},
      {"tree, worst of ten places: largest error of a distance", 46.0, 1e3,
       [](const auto& m) { return m.worst_place_m(); }},
      {"still LEDs: scatter of a coordinate", 1.0, 1e3, [](const auto& m) { return m.static_sd_m; }},
      {"wheel: median error of the diameter", 0.6, 1e3,
       [](const auto& m) { return std::abs(m.wheel.median_error_m); }},
      {"wheel: scatter of the diameter", 0.5, 1e3, [](const auto& m) { return m.wheel.sd_m; }},
      {"wheel: largest error of the diameter", 10.0, 1e3, [](const auto& m) { return m.wheel.max_error_m; }},
      {"wheel: scatter across the plane", 1.1, 1e3, [](const auto& m) { return m.wheel.plane_sd_m; }},
      {"wheel: ratio of the axes, by spread over all samples", 1.03, 1.0,
       [](const auto& m) { return m.wheel.spread_of_all; }},
      {"wheel: ratio of the axes, by widths", {}, 1.0, [](const auto& m) { return m.wheel.width_ratio; }},
      {"wheel: ratio of the axes, by an ellipse", {}, 1.0, [](const auto& m) {
         return m.wheel.ellipse_ratio;
       }}};
  constexpr std::array<std::pair<double, const char*>, 3> kShares{
      {{0.5, "median of rigs"}, {0.1, "10 % of rigs"}, {0.9, "90 % of rigs"}}};
  std::vector<StudyRow> out;
  for (const auto& line : lines)
    for (const auto& [share, name] : kShares) {
      std::vector<double> classic, ours;
      for (const auto& rig : rigs) {
        classic.push_back(line.unit * line.get(rig.classic));
        ours.push_back(line.unit * line.get(rig.ours));
      }
      StudyRow row{.quantity = fmt::format("{}, {}", line.what, name),
                   .unit = line.unit == 1.0 ? "1" : "mm",
                   .classic = math::quantile(classic, share),
                   .ours = math::quantile(ours, share)};
      if (share == 0.5) row.paper = line.paper;
      out.push_back(std::move(row));
    }
  return out;
}

}  // namespace kinemark::studies
