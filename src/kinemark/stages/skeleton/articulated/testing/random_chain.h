// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Chains with known geometry and poses for this folder's tests.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::testing_limbs {

struct RandomChain {
  Chain chain;
  std::vector<ChainPose> pose;
  ChainSamples samples;
};

struct RandomChainOptions {
  int segments = 2, markers_per_segment = 3, frames = 200;
  data::SegmentKind kind = data::SegmentKind::solid;
  double stagger_m = 0.02, noise_sd_m = 0.001, missing = 0.0;
  std::uint64_t seed = 1;
};

inline Matrix3d random_rotation(Random& random) {
  const double w = random.gaussian();
  const double x = random.gaussian();
  const double y = random.gaussian();
  const double z = random.gaussian();
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// Straight segments of 150 mm, each frame turned at random; markers staggered around the bone (plane: to
/// both sides).
inline RandomChain make_random_chain(const RandomChainOptions& o) {
  ChainLayout layout;
  for (int s = 0; s < o.segments; ++s) {
    if (s > 0) layout.parent.push_back(s - 1);
    for (int k = 0; k < o.markers_per_segment; ++k) layout.segment_of_marker.push_back(s);
  }
  RandomChain out{.chain = Chain(layout, std::vector<data::SegmentKind>(layout.segments(), o.kind)),
                  .pose = {},
                  .samples = {}};
  for (int k = 0; k < layout.markers(); ++k) {
    const int s = layout.segment_of_marker[k];
    const int i = k % o.markers_per_segment;
    const double part = o.kind == data::SegmentKind::solid ? 2.0 / o.markers_per_segment : 1.0;
    const double angle = std::numbers::pi * part * i;
    const double wide = o.kind == data::SegmentKind::line ? 0.0 : o.stagger_m;
    const double along = 0.150 * (i + 1) / (o.markers_per_segment + 1);
    const double across = o.kind == data::SegmentKind::solid ? wide * std::sin(angle) : 0.0;
    out.chain.marker.col(k) = Vector3d(wide * std::cos(angle), across, s == 0 ? along - 0.150 : along);
  }
  for (int j = 1; j < layout.joints(); ++j) out.chain.joint.col(j) = Vector3d(0.0, 0.0, 0.150);
  Random random(o.seed, 1);
  out.samples.frames = o.frames;
  out.samples.markers = layout.markers();
  for (int f = 0; f < o.frames; ++f) {
    ChainPose pose;
    for (int i = 0; i < 3; ++i) pose.joint0[i] = random.uniform(-0.2, 0.2);
    for (int s = 0; s < o.segments; ++s) pose.rotation.push_back(random_rotation(random));
    for (int k = 0; k < layout.markers(); ++k) {
      const Vector3d x = out.chain.predict(pose, k);
      const bool lost = random.uniform() < o.missing;
      for (int i = 0; i < 3; ++i) {
        const double value = x[i] + o.noise_sd_m * random.gaussian();
        out.samples.x.push_back(lost ? std::numeric_limits<double>::quiet_NaN() : value);
      }
    }
    out.pose.push_back(std::move(pose));
  }
  return out;
}

/// Hide a marker in a frame.
inline void hide(ChainSamples& samples, std::int64_t frame, int marker) {
  for (int i = 0; i < 3; ++i) {
    samples.x[static_cast<std::size_t>(3 * (frame * samples.markers + marker) + i)] =
        std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace kinemark::skeleton::testing_limbs
