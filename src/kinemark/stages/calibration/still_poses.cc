// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/still_poses.h"

#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "kinemark/camera/noise.h"

namespace kinemark::calibration {
namespace {

/// Remaining amplitude of a flicker in the mean of conversions at these times: |mean of exp(i omega t)|.
double left_of_flicker(const data::Counts& counts, const FrameRange& frames, double offset_s, double hz) {
  std::complex<double> sum = 0.0;
  for (std::int64_t f = 0; f < frames.count; ++f)
    sum += std::polar(1.0, 2.0 * std::numbers::pi * hz * (counts.time.time_s(frames.first + f) + offset_s));
  return std::abs(sum) / static_cast<double>(frames.count);
}

}  // namespace

StillObservation still_observation(const data::Counts& counts, const data::Electronics& electronics,
                                   const FrameRange& frames, std::int64_t led, std::int64_t camera,
                                   const StillOptions& options) {
  constexpr std::uint8_t kUnusable = data::kCountSaturated | data::kCountOccluded | data::kCountLost;
  constexpr double kDark = 100.0;  // counts of all four channels: reached by offsets and stray light alone
  Eigen::Vector4d mean = Eigen::Vector4d::Zero(), square = Eigen::Vector4d::Zero();
  const auto count = static_cast<double>(frames.count);
  for (std::int64_t f = frames.first; f < frames.first + frames.count; ++f) {
    if ((counts.flags[counts.index(f, led, camera)] & kUnusable) != 0) return {};
    mean += counts.at(f, led, camera);
  }
  mean /= count;
  if (!(mean.sum() > kDark)) return {};
  for (std::int64_t f = frames.first; f < frames.first + frames.count; ++f)
    square += (counts.at(f, led, camera) - mean).cwiseAbs2();
  const double noise = camera::conversion_variance(electronics, mean.mean());
  const double flicker = options.flicker_counts * options.flicker_counts / 2.0;
  // Held still, the scatter has 4 (frames - 1) degrees of freedom; ten standard deviations above its mean is
  // motion.
  const double freedom = 4.0 * (count - 1.0);
  if (frames.count > 1 && square.sum() > (noise + flicker) * (freedom + 10.0 * std::sqrt(2.0 * freedom)))
    return {};
  const double left =
      left_of_flicker(counts, frames, counts.offset_s(led, camera).mean(), options.flicker_hz);
  return {mean, noise / count + flicker * left * left};
}

Result<std::vector<Eigen::Vector3d>> tree_from_sides(const std::vector<double>& sides_m) {
  if (sides_m.size() != 3)
    return fail(Code::usage, fmt::format("tree: {} sides; three were expected: between LEDs 1-2, 1-3 and 2-3",
                                         sides_m.size()));
  const double base = sides_m[0], left = sides_m[1], right = sides_m[2];
  const double x =
      (left * left - right * right + base * base) / (2.0 * base);  // foot of vertex 2 from vertex 0
  const double height2 = left * left - x * x;
  if (!(base > 0.0) || !(height2 > 1e-6 * left * left))
    return fail(Code::usage,
                fmt::format("tree: sides of {}, {} and {} m close no triangle", base, left, right));
  std::vector<Eigen::Vector3d> out{{0.0, 0.0, 0.0}, {base, 0.0, 0.0}, {x, 0.0, std::sqrt(height2)}};
  const Eigen::Vector3d centroid = (out[0] + out[1] + out[2]) / 3.0;
  for (auto& p : out) p -= centroid;
  return out;
}

Result<StillPoses> still_poses(const data::Counts& counts, const data::Rig& rig,
                               std::vector<Eigen::Vector3d> tree, int frames_per_pose,
                               const StillOptions& options) {
  if (auto s = counts.validate(); !s) return std::unexpected(s.error());
  if (auto s = data::check_same_rig(counts, rig); !s) return std::unexpected(s.error());
  if (counts.led_count() != static_cast<std::int64_t>(tree.size()))
    return fail(Code::bad_input,
                fmt::format("the recording has {} LEDs and the tree {}; they must be the same",
                            counts.led_count(), tree.size()));
  if (frames_per_pose < 1 || counts.frames() < frames_per_pose)
    return fail(Code::bad_input,
                fmt::format("{} frames hold no whole pose of {} frames", counts.frames(), frames_per_pose));
  StillPoses out{.tree = std::move(tree),
                 .cameras = rig.camera_count(),
                 .observations = {},
                 .frames_left_over = counts.frames() % frames_per_pose};
  for (std::int64_t first = 0; first + frames_per_pose <= counts.frames(); first += frames_per_pose)
    for (int led = 0; led < out.leds(); ++led)
      for (int c = 0; c < out.cameras; ++c)
        out.observations.push_back(
            still_observation(counts, rig.electronics, {first, frames_per_pose}, led, c, options));
  return out;
}

}  // namespace kinemark::calibration
