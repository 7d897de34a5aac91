// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Forces, moments and powers at the joints of a definition, from markers and force plates.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::analysis {

/// How loads are found.
struct JointLoadOptions {
  SegmentOptions segments;   ///< noise of markers, up, threads
  double gravity = 9.81;     ///< m/s^2, of Plug-in Gait
  std::int64_t refits = 99;  ///< behind each deviation: 0 (none) or at least 20
  std::uint64_t seed = 1;    ///< of the refits

  [[nodiscard]] Status check() const;  ///< Code::usage
};

/// A step of a foot on a plate.
struct PlateStep {
  std::string body;                   ///< of the definition
  std::string plate;                  ///< "plate 1"
  double begin_s = 0.0, end_s = 0.0;  ///< on the recording's clock
};

/// What acts at the joints.
struct JointLoads {
  /// Ground reactions (N/kg, in the laboratory), then force (N/kg), moment (N m/kg) and power (W/kg) of each
  /// joint: on the segment beyond it, in its axes; power is positive where muscles shorten. State: measured,
  /// interpolated where a marker was within four frames, missing where the joint's markers or the load of a
  /// foot beyond it are not known, and in the first and last four frames.
  std::vector<SegmentSeries> series;
  std::vector<PlateStep> steps;       ///< that were used, by body and time
  std::vector<std::string> warnings;  ///< what could not be computed and why, a sentence each
};

/// Inverse dynamics of the bodies beyond each joint: plates, weight and inertia
/// (docs/theory/joint-moments.md).
///
/// Markers are smoothed by the difference smoother at 1.5 times the cut-off of least expected error; where
/// their differences show no noise, hardly or not at all. Deviations are those of refits: noise of the
/// markers (stated: white; SegmentInput::noise: as it is) and white noise of the plates, through the same
/// smoothing. They know nothing of masses, of where a joint centre really is, or of skin.
///
/// @param plates  on the frames of the markers, not cut off at a threshold
///
/// Code::usage as JointLoadOptions::check(); Code::bad_input for a definition that makes no sense.
/// Nothing, without a word, where the definition has no joints or there are no plates.
[[nodiscard]] Result<JointLoads> find_joint_loads(const SegmentDefinition& definition,
                                                  const SegmentInput& input, const data::Wrenches& plates,
                                                  const JointLoadOptions& options = {});

}  // namespace kinemark::analysis
