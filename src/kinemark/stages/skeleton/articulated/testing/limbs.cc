// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/testing/limbs.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"

namespace kinemark::skeleton::testing_limbs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLength_m = 0.150;
constexpr double kRate_hz = 60.0;

Matrix3d any_rotation(Random& random) {
  const double a = random.gaussian(), b = random.gaussian(), c = random.gaussian(), d = random.gaussian();
  return Eigen::Quaterniond(a, b, c, d).normalized().toRotationMatrix();
}

/// Slow turns of one segment against the one before: three sines of unrelated pace.
struct RotationPath {
  Vector3d pace_hz, phase;

  RotationPath(Random& random, double hz) {
    for (int i = 0; i < 3; ++i) {
      pace_hz[i] = hz * random.uniform(0.5, 1.5);
      phase[i] = random.uniform(0.0, 6.0);
    }
  }
  [[nodiscard]] Matrix3d at(double time_s, double size_rad, bool one_axis) const {
    Vector3d v;
    for (int i = 0; i < 3; ++i)
      v[i] = size_rad * std::sin(2.0 * std::numbers::pi * pace_hz[i] * time_s + phase[i]);
    if (one_axis) v = {v[0], 0.0, 0.0};
    return Eigen::AngleAxisd(v.norm(), v.norm() > 0.0 ? Vector3d(v.normalized()) : Vector3d::UnitX())
        .toRotationMatrix();
  }
};

}  // namespace

Limb make_limb(const LimbOptions& o) {
  Limb limb;
  Random poses(o.seed, 1), noise(o.seed, 2), loss(o.seed, 3);
  std::vector<std::string> names;
  std::vector<Vector3d> local;
  for (int k = 0; k < o.markers_per_segment; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / o.markers_per_segment;
    local.emplace_back(o.stagger_m * std::cos(angle), o.stagger_m * std::sin(angle),
                       kLength_m * (k + 1) / (o.markers_per_segment + 1));
  }
  std::vector<RotationPath> rotation_paths;
  for (int s = 0; s < o.segments; ++s) {
    data::SegmentLayout::Segment segment{.name = fmt::format("s{}", s)};
    for (int k = 0; k < o.markers_per_segment; ++k) {
      segment.markers.push_back(static_cast<int>(names.size()));
      names.push_back(fmt::format("s{}m{}", s, k));
    }
    limb.layout.segments.push_back(segment);
    if (s > 0) limb.layout.joints.push_back({.name = fmt::format("j{}", s - 1), .parent = s - 1, .child = s});
    rotation_paths.emplace_back(poses, o.rotation_hz);
  }
  limb.markers =
      data::Trajectories::all_missing(names, {.rate_hz = kRate_hz, .t0_s = 0.0, .frames = o.frames});
  for (std::int64_t f = 0; f < o.frames; ++f) {
    Vector3d from = Vector3d::Zero();
    Matrix3d R = Matrix3d::Identity();
    for (int s = 0; s < o.segments; ++s) {
      if (o.rotation_hz > 0.0)
        R = (R * rotation_paths[static_cast<std::size_t>(s)].at(static_cast<double>(f) / kRate_hz,
                                                                o.rotation_rad, o.one_axis && s > 0))
                .eval();
      else
        R = any_rotation(poses);
      for (int k = 0; k < o.markers_per_segment; ++k) {
        const Vector3d x = from + R * local[static_cast<std::size_t>(k)];
        limb.x_true.insert(limb.x_true.end(), x.data(), x.data() + 3);
        Vector3d error;
        for (int i = 0; i < 3; ++i) error[i] = o.noise_sd_m * noise.gaussian();
        if (loss.uniform() < o.missing) continue;
        const int m = s * o.markers_per_segment + k;
        limb.markers.x(f, m) = x + error;
        limb.markers.state[limb.markers.index(f, m)] = data::SampleState::measured;
      }
      from += kLength_m * R.col(2);
      if (s + 1 < o.segments)
        limb.centre_in_world.insert(limb.centre_in_world.end(), from.data(), from.data() + 3);
    }
  }
  return limb;
}

}  // namespace kinemark::skeleton::testing_limbs
