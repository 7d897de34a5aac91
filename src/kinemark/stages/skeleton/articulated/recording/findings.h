// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

namespace kinemark::skeleton::articulated {

/// How a joint moved in the sampled frames that determine it.
struct ObservedMotion {
  double range_rad = 0.0;         ///< largest rotation between two frames
  double second_rad = 0.0;        ///< spread (SD) of the rotations about the second axis
  double second_noise_rad = 0.0;  ///< what noise alone would show there
  bool one_axis = false;          ///< both segments solid, and no more than noise about other axes
  bool still = false;             ///< both segments more than lines, and no more than noise about any axis
  Vector3d axis_in_parent = Vector3d::Zero();  ///< unit length; chain's parent and child
  Vector3d axis_in_child = Vector3d::Zero();
  double axis_sd_rad = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no axis, and both are zero
  std::int64_t frames = 0;
};

[[nodiscard]] ObservedMotion observe_motion(const FittedChain& fit, const RecordingPass& pass, int joint);

/// What the motion shows of a joint, a phrase: range, and how well the axis of a hinge or the centre is known
/// in its segments (common_sd_m, m).
[[nodiscard]] std::string describe_motion(const ObservedMotion& seen, bool hinge, double common_sd_m);

/// A marker that sits elsewhere on its segment after some frame.
struct SlippedMarker {
  int marker = 0;          ///< of the chain
  std::int64_t frame = 0;  ///< first frame after it
  double distance_m = 0.0;
};

/// Steps in the residuals, seen from the segment, of at least two noise SDs; one marker a segment at most.
[[nodiscard]] std::vector<SlippedMarker> find_slipped_markers(const FittedChain& fit,
                                                              const ChainSamples& samples,
                                                              const RecordingPass& pass);

/// Two markers whose names are exchanged in some frames.
struct SwappedMarkers {
  int marker_a = 0, marker_b = 0;
  std::int64_t frames = 0, first_frame = 0;  ///< how many: estimated where not all were examined
};

/// Pairs of names whose exchange makes the geometry explain frames that it does not explain as they are. Up
/// to a dozen such frames are examined, and in each the pairs of which a marker lies far from its predicted
/// position.
[[nodiscard]] std::vector<SwappedMarkers> find_swapped_markers(const FittedChain& fit,
                                                               const ChainSamples& samples,
                                                               const RecordingPass& pass);

/// Markers that move on their segment: their residuals exceed the noise by half or more.
struct LooseMarker {
  int marker = 0;
  double rms_m = 0.0;  ///< of the residual per axis
};
[[nodiscard]] std::vector<LooseMarker> find_loose_markers(const FittedChain& fit, const ChainSamples& samples,
                                                          const RecordingPass& pass);

}  // namespace kinemark::skeleton::articulated
