// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Foot strike and leaving from the paths of markers alone: one of each between two swings, by construction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/data/gait_event.h"
#include "kinemark/stages/analysis/gait/event_times.h"
#include "kinemark/stages/analysis/gait/gait_paths.h"
#include "kinemark/stages/analysis/gait/swings.h"

namespace kinemark::analysis {

/// Where the pelvis goes.
struct Progress {
  math::SeriesMatrix velocity;   ///< n x 2, m/s over the ground, over 0.3 s around each frame
  math::SeriesMatrix direction;  ///< n x 2, unit, of the mean velocity over 1.2 s
};
/// Of the pelvis against the ground.
[[nodiscard]] Progress progress_of(const GaitPaths& paths, const Eigen::RowVector2d& ground);

/// An event that the swings of a foot must have, before its detectors are fused.
struct SwingEdge {
  data::Side side = data::Side::left;              ///< of the foot
  data::FootEvent what = data::FootEvent::strike;  ///< at the swing's end, or its beginning
  std::size_t swing = 0;                           ///< index into the foot's swings
  double frame = 0.0;                              ///< of Detector::middle
  DetectorTimes after_s{};                         ///< of all
  bool seen = true;     ///< the foot is known in the frames around it; else there is no telling when it was
  bool at_gap = false;  ///< the foot is not known 50 ms before or after
  bool at_end = false;  ///< within 50 ms of an end of the recording
};
/// Every edge of every swing, by side and time.
[[nodiscard]] std::vector<SwingEdge> find_edges(const GaitPaths& paths, const Steps& steps,
                                                const Eigen::RowVector2d& ground, const Progress& progress);

/// The detectors of known edges on other paths, as simulated noise makes them.
/// @param edges  their frames are looked for again within a tenth of a stride
/// @return frames of Detector::middle and times after it, NaN where it is not passed
[[nodiscard]] std::vector<SwingEdge> find_edges_again(const GaitPaths& paths, const Steps& steps,
                                                      const Eigen::RowVector2d& ground,
                                                      const std::vector<SwingEdge>& edges);

/// Extra SD of an event at a gap or an end of the recording, s.
inline constexpr double kAtEdgeSd_s = 0.03;

}  // namespace kinemark::analysis
