// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/limb.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/stages/simulation/internal/limb_build.h"

namespace kinemark::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using internal::in_range;

/// Where losses are heaviest.
const Vector3d kLossySide(0.36, 0.53, 0.77);

/// Markers at even steps along the bone, turned about it from one to the next.
Eigen::Matrix3Xd marker_positions(const ChainOptions& options, double length_m) {
  const int n = options.markers_per_segment;
  Eigen::Matrix3Xd out(3, n);
  for (int k = 0; k < n; ++k) {
    const double along = length_m * (k + 1) / (options.last_at_end ? n : n + 1),
                 angle = 2.0 * std::numbers::pi * k / n;
    out.col(k) = options.planar ? Vector3d(k % 2 == 0 ? options.stagger_m : -options.stagger_m, 0.0, along)
                                : Vector3d(options.stagger_m * std::cos(angle),
                                           options.stagger_m * std::sin(angle), along);
  }
  return out;
}

/// A uniformly distributed random rotation: z points anywhere on the sphere, and x anywhere around it.
Matrix3d any_orientation(Random& random) {
  const double height = random.uniform(-1.0, 1.0);
  const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double roll = random.uniform(0.0, 2.0 * std::numbers::pi);
  return (Eigen::AngleAxisd(azimuth, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(std::acos(height), Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Vector3d::UnitZ()))
      .toRotationMatrix();
}

}  // namespace

Status ChainOptions::check() const {
  constexpr double kMostSegments = 32, kMostMarkers = 64;
  for (const auto& status :
       {in_range("frames", static_cast<double>(frames), 1.0, internal::kMostLimbFrames),
        in_range("rate_hz", rate_hz, 1e-3, 1e6),
        in_range("number of segments", static_cast<double>(lengths_m.size()), 2.0, kMostSegments),
        in_range("markers_per_segment", markers_per_segment, 1.0, kMostMarkers),
        in_range("stagger_m", stagger_m, 0.0, 10.0), in_range("noise_sd_m", noise_sd_m, 0.0, 1.0),
        in_range("missing", missing, 0.0, 0.95)})
    if (!status) return status;
  for (const double length : lengths_m)
    if (auto status = in_range("length of a segment, m", length, 1e-4, 100.0); !status) return status;
  const double samples =
      static_cast<double>(frames) * static_cast<double>(lengths_m.size()) * markers_per_segment;
  return in_range("frames x markers", samples, 1.0, 1e8);
}

Result<LimbRecording> simulate_chain(const ChainOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  const std::size_t segments = options.lengths_m.size();
  std::vector<std::string> names, joints, prefixes;
  for (std::size_t s = 0; s < segments; ++s) {
    names.push_back(fmt::format("s{}", s));
    prefixes.push_back(fmt::format("s{}m", s));
    if (s > 0) joints.push_back(fmt::format("j{}", s - 1));
  }
  LimbRecording out = internal::empty_limb(names, joints, prefixes, options.markers_per_segment,
                                           {options.rate_hz, 0.0, options.frames});
  for (std::size_t s = 0; s < segments; ++s)
    out.x_in_segment[s] = marker_positions(options, options.lengths_m[s]);

  Random motion(options.seed, static_cast<std::uint64_t>(internal::LimbStream::motion));
  auto x = out.x_true.begin();
  auto centre = out.centre_in_world.begin();
  auto end = out.end_in_world.begin();
  std::vector<double> weight;
  for (std::int64_t f = 0; f < options.frames; ++f) {
    Vector3d upper = Vector3d::Zero();
    for (std::size_t s = 0; s < segments; ++s) {
      const Matrix3d world_from_segment = any_orientation(motion);
      for (const auto position : out.x_in_segment[s].colwise()) {
        const Vector3d at = upper + world_from_segment * position;
        for (const double value : at) *x++ = value;
      }
      upper += options.lengths_m[s] * world_from_segment.col(2);
      if (s + 1 == segments) continue;
      for (const double value : upper) *centre++ = value;
    }
    for (const double value : upper) *end++ = value;
    if (options.pose_correlated)
      weight.push_back(1.0 + upper.stableNormalized().dot(kLossySide.normalized()));
  }
  internal::record_limb(out, options.noise_sd_m, options.missing, options.seed, weight);
  return out;
}

}  // namespace kinemark::simulation
