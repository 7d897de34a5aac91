// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Chains with known geometry and poses for this folder's tests.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::testing_limbs {

using articulated::Chain;
using articulated::ChainLayout;
using articulated::ChainPose;
using articulated::ChainSamples;
using Eigen::Matrix3d;
using Eigen::Vector3d;

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

/// Draw the samples again from the chain and its poses, all markers seen.
inline void redraw(RandomChain& limb, double noise_sd_m, std::uint64_t seed) {
  Random random(seed, 2);
  limb.samples.x.clear();
  for (const ChainPose& pose : limb.pose) {
    for (int k = 0; k < limb.chain.markers(); ++k) {
      const Vector3d x = limb.chain.predict(pose, k);
      for (int i = 0; i < 3; ++i) limb.samples.x.push_back(x[i] + noise_sd_m * random.gaussian());
    }
  }
}

/// The same limb in slow motion: each segment rotates against the one before by up to half a radian or so.
inline void move_slowly(RandomChain& limb, double rate_hz, double noise_sd_m) {
  for (std::size_t f = 0; f < limb.pose.size(); ++f) {
    const double t = static_cast<double>(f) / rate_hz;
    limb.pose[f].joint0 = 0.05 * Vector3d(std::sin(2.0 * t), std::cos(1.7 * t), std::sin(1.3 * t + 1.0));
    Matrix3d R = Matrix3d::Identity();
    for (std::size_t s = 0; s < limb.pose[f].rotation.size(); ++s) {
      const double phase = 1.1 * static_cast<double>(s);
      const Vector3d v(std::sin(2.1 * t + phase), std::sin(1.6 * t + 2.0 * phase), std::cos(1.9 * t + phase));
      R = (R * math::exp_so3(0.5 * v)).eval();
      limb.pose[f].rotation[s] = R;
    }
  }
  redraw(limb, noise_sd_m, 5);
}

/// The same limb with joint 0 a hinge: segment 1 rotates against segment 0 about the x axis of both.
inline void move_as_hinge(RandomChain& limb, double noise_sd_m) {
  for (std::size_t f = 0; f < limb.pose.size(); ++f) {
    const double angle = std::sin(0.1 * static_cast<double>(f));
    limb.pose[f].rotation[1] = limb.pose[f].rotation[0] * math::exp_so3(angle * Vector3d::UnitX());
  }
  redraw(limb, noise_sd_m, 6);
}

/// The same recording in a lab that was rotated by R and shifted.
inline void move_lab(RandomChain& limb, const Matrix3d& R, const Vector3d& shift) {
  for (std::size_t i = 0; i < limb.samples.x.size(); i += 3) {
    Eigen::Map<Vector3d> x(limb.samples.x.data() + i);
    x = (R * x + shift).eval();
  }
  for (ChainPose& pose : limb.pose) {
    pose.joint0 = (R * pose.joint0 + shift).eval();
    for (Matrix3d& rotation : pose.rotation) rotation = (R * rotation).eval();
  }
}

/// Hide a marker in a frame.
inline void hide(ChainSamples& samples, std::int64_t frame, int marker) {
  for (int i = 0; i < 3; ++i) {
    samples.x[static_cast<std::size_t>(3 * (frame * samples.markers + marker) + i)] =
        std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace kinemark::skeleton::testing_limbs
