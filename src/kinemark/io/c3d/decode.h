// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kinemark/data/trajectories.h"
#include "kinemark/io/c3d/layout.h"

namespace kinemark::io {

/// Where decoded frames go, n frames of M points and K analog channels. An empty span is not written.
struct C3dFrames {
  std::span<double> x_in_world;         ///< n x M x 3, m; NaN where missing
  std::span<data::SampleState> state;   ///< n x M: missing, measured, interpolated
  std::span<float> residual_m;          ///< n x M, NaN where not measured
  std::span<std::uint8_t> camera_mask;  ///< n x M, bit c: camera c + 1
  std::span<double> analog;             ///< n x (S / F) x K
  std::span<double> channels;           ///< n x C x 3, numbers of the file; NaN where missing
};

/// Counts of what was decoded, and the box around it; they add up over pieces of a file.
struct C3dSeen {
  std::int64_t measured = 0;      ///< samples with a residual or cameras
  std::int64_t unmeasured = 0;    ///< samples with coordinates and a fourth word of 0
  std::int64_t with_cameras = 0;  ///< samples with a camera mask
  /// Around all positions that were written and, perhaps, what the file has where they are missing, in world;
  /// empty: none was, or not known.
  Eigen::AlignedBox3d box_m;

  C3dSeen& operator+=(const C3dSeen& other);  ///< adds another piece
};

/// Decode `frames` whole frames at `bytes`.
///
/// A sample is missing when its fourth word is negative, 65535 or NaN, when a coordinate is not finite, or
/// when all three are exactly 0. The fourth word's high byte is the camera mask, its low byte the residual in
/// steps of POINT:SCALE; both 0 say that the point was filtered, interpolated or made (c3d.org, "Notes for
/// programmers"). Where cameras saw the point but the residual byte is 0, the residual was below half a step:
/// the sample is measured. Points that are no markers are missing by their fourth word alone: an angle may be
/// 0. Every byte is read once and every output written once.
C3dSeen decode_frames(const C3dLayout& layout, const std::byte* bytes, std::int64_t frames,
                      const C3dFrames& out);

}  // namespace kinemark::io
