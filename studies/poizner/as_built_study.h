// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The rig of 1986 as it may have been built: faults of amounts that make its method err as it was reported
// to.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/simulation/rig_calibration.h"
#include "studies/common/study_table.h"
#include "studies/poizner/wheel_measures.h"

namespace kinemark::studies {

/// What the rig of the paper may have had; the paper states none of it. Amounts were found by looking for
/// rigs whose six published numbers come out; standard deviations of what is drawn unless said otherwise.
struct AsBuiltOptions {
  double convergence_deg = 47.0;  ///< between the cameras' axes
  double lens_m = 3e-3;           ///< of a lens by tape, per axis
  double turn_rad = 1e-3;         ///< of a camera, yaw and pitch
  double roll_rad = 6e-3;         ///< of a camera about its axis
  double stray_share = 0.013;     ///< light by way of the room, of an LED on the axis at 3 m
  double offset_counts = 0.5;     ///< of channels while the table was recorded
  double drift_counts = 2.3;      ///< of channels between the table and the recordings
  double outermost = 0.978;       ///< largest place of the tree's LEDs on a detector, half-sides
  double tree_light = 1.6;        ///< of the tree's LEDs over those of the table
  double wheel_light = 1.75;      ///< of the wheel's LED
  double wheel_turns = 3.1;       ///< in 220 frames
  double glint_share = 0.025;     ///< of one frame, from the other side of the wheel's axle
  simulation::GridOptions grid{.distance_sd_m = 6e-3};  ///< before each camera
};

/// What one method finds of one rig.
struct AsBuiltMeasures {
  std::vector<double> worst_distance_m;  ///< of ten places of the tree: largest error of its three distances
  double static_sd_m = 0.0;              ///< median of coordinates over places and LEDs
  WheelMeasures wheel;                   ///< unfiltered

  [[nodiscard]] double best_place_m() const;
  [[nodiscard]] double worst_place_m() const;
};

/// One rig as built, by the method of 1986 and by ours, for which the same rig has a dark slot. Ours measures
/// with nothing that reconstruct flags at the edge of a detector.
struct AsBuiltOutcome {
  AsBuiltMeasures classic, ours;
  std::vector<double> from_middle_m;  ///< of the places: distance of the tree from the middle of the room
};

/// Draws, calibrates and measures rig `seed`: the tree in ten places, its LEDs turned with it, the first in
/// the middle and two at the edge of the detectors, 50 frames each; the wheel at 8 degrees.
[[nodiscard]] Result<AsBuiltOutcome> study_as_built(std::uint64_t seed, const AsBuiltOptions& options = {});

/// Median and 10 and 90 % over rigs of the paper's numbers. No bounds: rigs that nobody can measure any more.
[[nodiscard]] std::vector<StudyRow> as_built_rows(const std::vector<AsBuiltOutcome>& rigs);

}  // namespace kinemark::studies
