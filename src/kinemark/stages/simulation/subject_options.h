// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::simulation {

/// How the subject moves. Every coordinate of its own is a sum of two or three sines within the range of the
/// model.
enum class MotionKind : std::uint8_t {
  walk,   ///< one stride frequency (0.8 to 1.05 Hz) and its double; left and right sides half a stride apart
  reach,  ///< arms, shoulders, hands widely at 0.2 to 0.7 Hz, the rest of the body little
  tai_chi,  ///< wide and slow, 0.05 to 0.25 Hz
  mixed,    ///< everything, 0.1 to 0.9 Hz: the richest motion per second
};

[[nodiscard]] std::string_view to_string(MotionKind kind);  ///< "walk", "reach", "tai-chi", "mixed"
/// The kind of that name; the failure lists all names.
[[nodiscard]] Result<MotionKind> parse_motion_kind(std::string_view name);

/// Options of simulate_subject().
struct SubjectOptions {
  MotionKind motion = MotionKind::mixed;  ///< how the subject moves
  double duration_s = 10.0;               ///< > 0; round(duration rate) frames, at most 10 million
  double rate_hz = 100.0;                 ///< > 0
  std::uint64_t seed = 1;                 ///< of everything below
  double full_turns = 0.0;    ///< turns of the whole body about the vertical over the recording (free roots
                              ///< only); a walking subject then goes round in a circle instead of on the spot
  double noise_sd_m = 0.001;  ///< >= 0, Gaussian, per axis
  double soft_tissue =
      0.0;  ///< 0 to 1, times the amplitudes of soft_tissue_rms_m(): 2 mm (hand) to 15 mm (thigh)
  double soft_tissue_common =
      0.3;  ///< 0 to 1, share of its variance that moves all markers of a segment together
  double dropout_random =
      0.0;  ///< 0 to 0.9, share of marker-frames lost in gaps of 0.01 s to seconds, anywhere
  double dropout_sight = 0.0;  ///< 0 to 0.9, share lost where the pose hides markers from a ring of cameras;
                               ///< on top of the random ones (may coincide)
  int threads = 1;             ///< 0: all cores. Any number gives the same bits.

  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
  [[nodiscard]] std::int64_t frames() const;  ///< round(duration_s * rate_hz)
};

}  // namespace kinemark::simulation
