// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint centres of a whole chain of segments by maximum likelihood: the markers' positions in their segments
// are unknown and common to all frames, every frame has its pose, neighbouring segments share a point.
// Theory: docs/theory/joint-centres.md and docs/theory/joint-centres-continuity.md
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// Options of fit_articulated().
struct ArticulatedOptions {
  double noise_sd_m = 0.0;               ///< of a marker, per axis, >= 0; 0: estimated from the residuals
  std::vector<data::SegmentKind> kinds;  ///< one a segment; empty: the data choose line, plane or solid
  data::JointChoice joint = data::JointChoice::automatic;  ///< of all joints: ball, hinge, or found
  bool continuity = true;  ///< smooth the centres in time and bridge what one frame leaves open
  bool robust = true;      ///< single markers far off lose their weight
  /// Soft tissue: every marker has a noise of its own, found from its residuals and shrunk towards the common
  /// one. Markers on loose skin then count less, and covariances know of them.
  bool soft_tissue = false;
  int max_fit_frames = 1500;  ///< 20 or more; frames, spread over the recording, for the geometry
  /// > 0; a first geometry with more noise of a marker is not refined further, but returned as it is.
  double most_noise_m = std::numeric_limits<double>::infinity();
  /// > 0; the same for one with a joint farther from the nearest marker of one of its segments.
  double most_reach_m = std::numeric_limits<double>::infinity();
  /// > 0; the same for one with a joint whose distance from a marker of its segments changes by more (RMS).
  double most_change_m = std::numeric_limits<double>::infinity();
  double max_bridge_sd_m = 0.02;  ///< > 0; a centre known worse (root of the trace) is not bridged
  int threads = 1;                ///< 0: all cores. Any number gives the same bits.

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

/// What became of one joint over the recording.
struct JointSummary {
  std::int64_t determined = 0, bridged = 0, ambiguous = 0, undetermined = 0;  ///< frames, together F
  std::int64_t modes = 0;    ///< positions that fit alike, summed over the frames not determined on their own
  double common_sd_m = 0.0;  ///< root of the trace: error that all frames share through the geometry
  double white_jerk = 0.0;   ///< m^2/s^5, of the smoothing; 0: none was done
};

/// Joint centres of a layout, and what became of each joint.
struct ArticulatedFit {
  data::Skeleton skeleton;           ///< one centre a frame and joint; covariances include the common part
  std::vector<JointSummary> joints;  ///< as skeleton.joints
  /// Noise of each marker, M, per axis, m: the same for all but with soft_tissue. NaN: not in the layout, or
  /// left out.
  std::vector<double> marker_noise_sd_m;
  bool refined = true;  ///< false: a first geometry beyond the bounds of the options was returned as it was
};

/// Centres of all joints of `layout` in every frame, their covariances, and what can be known of them.
///
/// Layouts are trees of two segments or more; markers not in the layout are left out. A frame is `determined`
/// when its own markers leave one position; otherwise, with continuity, `bridged` when the path between
/// neighbours decides or fills in, else `ambiguous` (best of several positions, with that position's own
/// covariance) or `undetermined` (NaN). With continuity the centres of determined frames are smoothed as
/// well; the result is then better than each frame's own, by as much as the movement is slow. Where frames do
/// not follow each other (their innovations say so) nothing is smoothed and a warning says it. The noise of
/// markers that went through a filter (Trajectories::filters) follows itself, and smoothing once more takes
/// nothing of it: their determined frames keep their own centre, and the geometry rests on no more frames
/// than the filter lets differ (50 at least).
///
/// Fails with one sentence where the geometry cannot be known at all: no frame that shows two segments, fewer
/// than two markers on a segment, a joint that never moves. What the recording shows about each joint is in
/// skeleton.joints[].words; markers that move on their segment, swapped names and a mirror ambiguity of the
/// geometry are in skeleton.warnings. About 60 us a frame and thread for 16 markers.
[[nodiscard]] Result<ArticulatedFit> fit_articulated(const data::Trajectories& markers,
                                                     const data::SegmentLayout& layout,
                                                     const ArticulatedOptions& options = {},
                                                     const Progress& progress = {});

}  // namespace kinemark::skeleton
