// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a body's motion, each without the bias of noise and with an interval.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/body/body_series.h"

namespace kinemark::analysis {

/// What is measured, and how.
struct BodyMeasureOptions {
  std::vector<std::string>
      measures;  ///< ids of body_definitions(); empty: all but those of pairs without one
  std::vector<Eigen::Index> coordinates;                     ///< to measure; empty: all that are measured
  std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs;  ///< coordinates whose coupling is measured
  std::vector<BodyStretch> stretches;                        ///< empty: the whole motion
  bool normalized = false;   ///< kinetics per mass, momentum over mass, speed and height
  std::int64_t refits = 99;  ///< behind each interval: 0 (none) or what `level` needs, 39 at 0.95
  double level = 0.95;       ///< of the intervals, above 0.5 to 0.9999
  std::uint64_t seed = 1;    ///< of the refits
  int threads = 1;           ///< 0: all cores; any number gives the same bits

  /// Ranges hold, every measure is one: Code::usage.
  [[nodiscard]] Status check() const;
};

/// Measures of a motion, and what was left out.
struct BodyMeasures {
  std::vector<data::Measure> measures;  ///< by stretch: coordinates, pairs, the body
  std::vector<std::string> notes;       ///< a sentence each
};

/// Smooth each coordinate, measure, and simulate its errors again (docs/theory/motion-measures.md).
///
/// Errors of different coordinates are taken as independent, and the first and last 80 ms are not measured.
/// A measure of a coordinate that is not determined for longer than 0.2 s of a stretch has no interval, and
/// no value where it is determined nowhere; a torque that is not known throughout a stretch has no value.
///
/// @return  Code::bad_input where the motion is shorter than 30 frames, a stretch holds fewer than 5, or
///          nothing moves. Time: refits x mechanics.
[[nodiscard]] Result<BodyMeasures> measure_body(const BodyRecord& record, const Mechanics& mechanics,
                                                const BodyMeasureOptions& options);

}  // namespace kinemark::analysis
