// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Small limbs of known joints for this folder's tests.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton::testing_limbs {

struct Limb {
  data::Trajectories markers;
  data::SegmentLayout layout;
  Array<double> x_true;           ///< F x M x 3, m
  Array<double> centre_in_world;  ///< F x J x 3, m
};

struct LimbOptions {
  std::int64_t frames = 300;
  int segments = 2, markers_per_segment = 3;
  double stagger_m = 0.0;  ///< 0: all on the bone
  double noise_sd_m = 0.001, missing = 0.0;
  double rotation_hz = 0.0;   ///< 0: every frame a pose of its own; else smooth rotations of about this pace
  double rotation_rad = 1.0;  ///< half range of the smooth rotations
  bool one_axis = false;      ///< smooth rotations of each joint about one axis of its parent
  std::uint64_t seed = 1;
};

/// A chain of straight segments of 150 mm from the origin, at 60 Hz; markers "s0m0", ..., joints "j0", ...
[[nodiscard]] Limb make_limb(const LimbOptions& options);

}  // namespace kinemark::skeleton::testing_limbs
