// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Whether segments and joints can be those of a body, before any method has run and after one has.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::skeleton {

/// What is expected of a body whose markers are on skin or on clothes.
struct PlausibilityOptions {
  double most_noise_m = 0.02;  ///< > 0; per axis, of markers about their segment and of a joint's two places
  double least_length_m = 0.005;  ///< >= 0; between two joints of a segment
  double most_length_m = 1.5;  ///< > least_length_m; between joints, and from a joint to its nearest marker

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// What was measured of a segment or a joint.
enum class BodyFigure : std::uint8_t {
  shape,     ///< of a segment: RMS distance of its markers from a rigid shape, per axis
  spread,    ///< of a segment: largest distance of two of its markers
  gap,       ///< of a joint: RMS distance of the places that its two segments give it, per axis
  distance,  ///< of a joint: RMS change of its distance from the markers of its segments
  reach,     ///< of a joint: distance from the nearest marker of one of its segments
  length,    ///< of a joint: distance from another joint of the same segment
  noise,     ///< of a result: noise of all its markers; the joint is the one whose distances change most
};

[[nodiscard]] std::string_view to_string(BodyFigure figure);  ///< "shape", "spread", "gap", "distance", ...

/// A segment or a joint that cannot be part of a body.
struct Implausible {
  bool is_segment = false;                ///< a segment; false: a joint
  std::string name;                       ///< as in the layout
  std::string other;                      ///< of a length: the joint at its other end
  BodyFigure figure = BodyFigure::shape;  ///< which of its figures is beyond its bound
  double value_m = 0.0;                   ///< what was measured; infinite where it is no number
  double least_m = 0.0, most_m = 0.0;     ///< what was expected
  std::vector<std::string> markers;       ///< of the segment, or of the joint's segments

  /// Name, figure and what was expected, begun in lower case and without full stop.
  [[nodiscard]] std::string description() const;
  /// The same as a sentence of its own.
  [[nodiscard]] std::string sentence() const;
};

/// Segments and joints of a layout that the markers contradict, before any joint is fitted: shape and spread
/// of each segment; gap of each joint between two segments whose poses the markers tell. O(F M).
[[nodiscard]] std::vector<Implausible> judge_layout(const data::Trajectories& markers,
                                                    const data::SegmentLayout& layout,
                                                    const PlausibilityOptions& options = {});

/// Joints of a result that contradict its own markers or a body's size: distance, reach and length, in that
/// order of joints; of a length that is too long or short the joint is named that is known worse. Where none
/// of these is beyond its bound but the noise of all markers is, the joint whose distances change most. O(F
/// M).
[[nodiscard]] std::vector<Implausible> judge_skeleton(const data::Trajectories& markers,
                                                      const data::Skeleton& skeleton,
                                                      const PlausibilityOptions& options = {});

/// The layout without some of its segments (and their joints) and joints.
[[nodiscard]] data::SegmentLayout leave_out(const data::SegmentLayout& layout,
                                            std::span<const Implausible> what);

}  // namespace kinemark::skeleton
