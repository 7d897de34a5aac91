// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/core/result.h"
#include "studies/macaque/centre_errors.h"

namespace kinemark::studies {

/// One way of recording the report's arm: 150 and 160 mm, three markers on each segment, every frame a pose
/// of its own.
struct ElbowCell {
  double noise_m = 0.001, missing = 0.0, stagger_m = 0.0;
  bool pose_correlated = false;  ///< simulation::ChainOptions
  std::int64_t frames = 400;
};

/// The elbow by all methods. Ours frame by frame, as these frames have no order; noise and kind of segment
/// (line, plane, solid) are found in the data. A method that refuses the recording answers in no frame.
struct ElbowErrors {
  CentreErrors report;  ///< constant distances from the markers (Kirk et al. 2005)
  CentreErrors score;   ///< SCoRE; no frame at all where markers are collinear, as it needs poses
  CentreErrors ours;    ///< left out without noise
  ElbowErrors& operator+=(const ElbowErrors& other);
};

[[nodiscard]] simulation::ChainOptions chain_options(const ElbowCell& cell, std::uint64_t seed);
/// Fails only where the cell is out of range.
[[nodiscard]] Result<ElbowErrors> study_elbow(const ElbowCell& cell, std::uint64_t seed);

/// One recording of the sleeve: 16 LEDs, 60 Hz, losses by line of sight.
struct SleeveCell {
  double noise_m = 0.001;
  bool hard = false;  ///< simulation::SleeveOptions::hard()
  double duration_s = 15.0;
};

struct SleeveErrors {
  CentreErrors report, score;
  CentreErrors alone;     ///< ours, every frame by its own markers
  CentreErrors smoothed;  ///< ours with continuity; determined: by the frame's own markers
  SleeveErrors& operator+=(const SleeveErrors& other);
};

[[nodiscard]] simulation::SleeveOptions sleeve_options(const SleeveCell& cell, std::uint64_t seed);
[[nodiscard]] Result<SleeveErrors> study_sleeve(const SleeveCell& cell, std::uint64_t seed);

}  // namespace kinemark::studies
