// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "studies/poizner/calibrated_rig.h"
#include "studies/poizner/coverage.h"

namespace kinemark::studies {

/// Results of one method for the tree held still in ten poses.
struct StillMeasures {
  Eigen::Vector3d sd_m = Eigen::Vector3d::Zero();  ///< median over poses and LEDs, per axis
  double over_cramer_rao = 0.0;                    ///< scatter over the bound, mean over poses
  std::vector<double> distance_error_m;  ///< of mean positions, 10 poses x 3 sides less those left out

  [[nodiscard]] double mean_error_m() const;
  [[nodiscard]] double max_error_m() const;
};

struct StillOutcome {
  StillMeasures classic, ours;
  Eigen::Vector3d cramer_rao_sd_m =
      Eigen::Vector3d::Zero();         ///< median over poses and LEDs, per axis of our world
  std::vector<double> predicted_sd_m;  ///< of each distance: calibration and noise
  double error_over_predicted = 0.0;   ///< root mean square
  int distances_left_out = 0;  ///< an end of them was unseen in some frame, or flagged at the detector's edge
  Coverage points, distances;
};

struct StillStudyOptions {
  std::int64_t frames = 100;
  double rate_hz = 100.0;
  double intensity = 1.0;  ///< of the LEDs
};

/// Scenario S1: ten poses, 100 frames at 100 Hz each.
[[nodiscard]] Result<StillOutcome> study_still_tree(const CalibratedRig& rig,
                                                    const StillStudyOptions& options = {});

}  // namespace kinemark::studies
