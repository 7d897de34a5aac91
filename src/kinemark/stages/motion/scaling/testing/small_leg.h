// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A pelvis with one leg for the tests of this folder: free root, three-axis hip, a knee that slides as it
// bends, an ankle; 12 markers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::motion::testing_leg {

[[nodiscard]] data::ModelDescription leg();

/// Sizes of the leg's segments, its hip's offset in the pelvis (prior 20 mm) and all markers (5 mm).
[[nodiscard]] std::vector<GeometryParameter> sizes_and_hip(const data::ModelDescription& model,
                                                           double size_prior_sd = 0.3);

/// How the leg is recorded.
struct Recording {
  std::int64_t frames = 120;
  double noise_sd_m = 0.0;
  double amplitude = 1.0;   ///< times 0.4 rad or so in every coordinate
  bool knee_still = false;  ///< the shank does not move in the thigh, nor the foot in the shank
  double slide_m = 0.0;     ///< markers of the thigh slide by this times sin 3 (knee - its middle)
  std::uint64_t seed = 1;
};

/// Markers of the moving model at 60 Hz.
[[nodiscard]] data::Trajectories record(const data::ModelDescription& model, const Recording& how = {});

}  // namespace kinemark::motion::testing_leg
