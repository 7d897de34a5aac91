// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace kinemark {

/// Evenly spaced instants: frame i is at t0_s + i / rate_hz, for i in [0, frames).
struct TimeBase {
  double rate_hz = 0.0;           ///< > 0
  double t0_s = 0.0;              ///< time of frame 0
  std::int64_t frames = 0;        ///< number of instants, >= 0
  std::int64_t first_number = 0;  ///< of frame 0, as the recording's file counts its frames

  /// Time of a frame, s.
  [[nodiscard]] double time_s(std::int64_t frame) const {
    return t0_s + static_cast<double>(frame) / rate_hz;
  }
  /// Frame nearest to a time; may lie outside [0, frames).
  [[nodiscard]] std::int64_t nearest_frame(double time_s) const {
    return static_cast<std::int64_t>(std::llround((time_s - t0_s) * rate_hz));
  }
  /// What people know a frame by: its number in the recording's file.
  [[nodiscard]] std::int64_t number(std::int64_t frame) const { return first_number + frame; }
  /// The same instants, to the bit, however their frames are numbered.
  friend bool operator==(const TimeBase& a, const TimeBase& b) {
    return a.rate_hz == b.rate_hz && a.t0_s == b.t0_s && a.frames == b.frames;
  }
};

}  // namespace kinemark
