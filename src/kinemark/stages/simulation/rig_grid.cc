// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/camera/noise.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/simulation/rig_calibration.h"

namespace kinemark::simulation {
namespace {

/// A board that hangs before a camera: LEDs in camera axes.
Eigen::Matrix3Xd hang_board(const GridOptions& o, const Eigen::Matrix2Xd& on_board, Random& random) {
  const double tilt_x = o.tilt_sd_deg * kRadPerDeg * random.gaussian();
  const double tilt_y = o.tilt_sd_deg * kRadPerDeg * random.gaussian();
  const double nearer = o.distance_sd_m * random.gaussian();
  const double centre_x = o.centre_sd_m * random.gaussian();
  const double centre_y = o.centre_sd_m * random.gaussian();
  const double roll = o.roll_sd_deg * kRadPerDeg * random.gaussian();
  Eigen::Matrix3Xd out(3, on_board.cols());
  for (Eigen::Index n = 0; n < on_board.cols(); ++n) {
    const double x = on_board(0, n), y = on_board(1, n);
    out.col(n) << x * std::cos(roll) - y * std::sin(roll) + centre_x,
        x * std::sin(roll) + y * std::cos(roll) + centre_y, o.distance_m + nearer + tilt_x * x + tilt_y * y;
  }
  return out;
}

data::Counts empty_counts(const PhysicalRig& rig, int camera, const GridOptions& o) {
  std::vector<std::string> leds;
  for (int i = 0; i < o.nodes; ++i)
    for (int j = 0; j < o.nodes; ++j) leds.push_back(fmt::format("{},{}", i, j));
  const auto& timing = rig.rig.timing;
  const auto n = static_cast<int>(leds.size());
  auto out =
      data::Counts::zeros(leds, {rig.rig.cameras[static_cast<std::size_t>(camera)].name},
                          {.rate_hz = 1.0 / (n * timing.slot_s(1)), .t0_s = 0.0, .frames = o.samples}, false);
  out.rig_id = rig.rig.id;
  out.highest_code = static_cast<std::int16_t>(rig.rig.electronics.highest_code());
  for (int l = 0; l < n; ++l)
    for (int k = 0; k < 4; ++k)
      out.conversion_time_s[static_cast<std::size_t>(4 * l + k)] = timing.conversion_offset_s(l, 0, k, 1);
  return out;
}

void sample_board(const PhysicalRig& rig, int camera_idx, const Eigen::Matrix3Xd& x_in_cam, Random& random,
                  data::Counts& out) {
  const auto& camera = rig.rig.cameras[static_cast<std::size_t>(camera_idx)];
  const math::SE3 world_from_cam = camera.cam_from_world.inverse();
  const auto& electronics = rig.rig.electronics;
  const double amplifier = camera::amplifier_noise_counts(electronics, 0.0);
  const double sd = std::hypot(amplifier, electronics.converter_noise_counts);
  Eigen::Matrix4Xd expected(4, x_in_cam.cols());
  for (Eigen::Index n = 0; n < x_in_cam.cols(); ++n)
    expected.col(n) = expected_counts(rig, camera_idx,
                                      {.x_in_world = world_from_cam * x_in_cam.col(n),
                                       .normal = -world_from_cam.rotation.col(2)})
                          .counts;
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (Eigen::Index n = 0; n < expected.cols(); ++n) {
      const std::size_t at = out.index(f, n, 0);
      for (int k = 0; k < 4; ++k) {
        const double m = std::nearbyint(expected(k, n) + sd * random.gaussian());
        const auto code =
            static_cast<std::int16_t>(std::clamp(m, 0.0, static_cast<double>(out.highest_code)));
        out.counts[4 * at + static_cast<std::size_t>(k)] = code;
        if (code == out.highest_code) out.flags[at] |= data::kCountSaturated;
      }
    }
}

}  // namespace

Status GridOptions::check() const {
  if (nodes < 3 || nodes > 101 || nodes % 2 == 0)
    return fail(Code::usage,
                fmt::format("a grid of {} nodes a side; need an odd number from 3 to 101", nodes));
  if (samples < 1 || samples > 10'000)
    return fail(Code::usage, fmt::format("{} samples of each LED of the grid; need 1 to 10000", samples));
  for (const double v : {side_m, distance_m})
    if (!(v > 0.0) || !(v < 100.0))
      return fail(Code::usage, fmt::format("a grid with a side or distance of {} m; need up to 100 m", v));
  for (const double v : {placement_sd_m, tilt_sd_deg, roll_sd_deg, distance_sd_m, centre_sd_m})
    if (!(v >= 0.0) || !(v < 90.0))
      return fail(Code::usage, fmt::format("a standard deviation of {} in the grid; need 0 or more", v));
  return {};
}

Result<GridRecording> record_grid(const PhysicalRig& rig, const GridOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  GridRecording out;
  out.nodes = options.nodes;
  out.spacing_m = options.side_m / (options.nodes - 1);
  out.distance_m = options.distance_m;
  Random placement(rig.seed, 200);
  Eigen::Matrix2Xd on_board(2, options.nodes * options.nodes);
  const int middle = options.nodes / 2;  // of an odd number of nodes
  for (int i = 0; i < options.nodes; ++i)
    for (int j = 0; j < options.nodes; ++j)
      for (int axis = 0; axis < 2; ++axis)
        on_board(axis, i * options.nodes + j) =
            ((axis == 0 ? i : j) - middle) * out.spacing_m + options.placement_sd_m * placement.gaussian();
  for (int c = 0; c < rig.rig.camera_count(); ++c) {
    Random random(rig.seed, 210 + static_cast<std::uint64_t>(c));
    out.x_in_cam.push_back(hang_board(options, on_board, random));
    out.counts.push_back(empty_counts(rig, c, options));
    sample_board(rig, c, out.x_in_cam.back(), random, out.counts.back());
  }
  return out;
}

}  // namespace kinemark::simulation
