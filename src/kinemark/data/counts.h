// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::data {

/// Notes on one observation of one LED by one camera; bits that may be combined.
enum CountFlag : std::uint8_t {
  kCountSaturated = 1,  ///< a channel stands at the converter's highest code
  kCountOccluded = 2,   ///< too little light: the LED is hidden from this camera
  kCountLost = 4,       ///< never recorded; the four counts are 0
};

/// Output of the converters of a rig of lateral-effect cameras: F frames, L LEDs lit in turn, C cameras with
/// four channels.
///
/// A channel is one electrode, in the order +x, -x, +y, -y of the detector (pin-cushion detectors: the
/// corners
/// ++, --, -+, +-). Element (frame, led, camera, channel) is counts[((frame * L + led) * C + camera) * 4 +
/// channel]. Frame f begins at time.time_s(f); conversions follow at the offsets of conversion_time_s. A dark
/// slot is one more slot of every frame in which no LED is lit.
struct Counts {
  std::string rig_id;                ///< of the rig that made them; empty when unknown
  std::vector<std::string> leds;     ///< L names, unique
  std::vector<std::string> cameras;  ///< C names, unique
  TimeBase time;                     ///< F = time.frames
  std::int16_t highest_code = 4095;  ///< of the converter; counts lie in [0, highest_code]
  Array<std::int16_t> counts;        ///< F x L x C x 4
  Array<double> conversion_time_s;   ///< L x C x 4, s after the frame's time
  Array<std::uint8_t> flags;         ///< F x L x C, bits of CountFlag
  Array<std::int16_t> dark;          ///< F x C x 4; empty without a dark slot
  Array<double> dark_time_s;         ///< C x 4, s after the frame's time; empty without a dark slot

  [[nodiscard]] std::int64_t frames() const { return time.frames; }                                ///< F
  [[nodiscard]] std::int64_t led_count() const { return static_cast<std::int64_t>(leds.size()); }  ///< L
  [[nodiscard]] std::int64_t camera_count() const {
    return static_cast<std::int64_t>(cameras.size());
  }  ///< C
  /// whether frames hold a slot without light
  [[nodiscard]] bool has_dark_slot() const { return !dark_time_s.empty(); }
  /// Index of an observation, into flags and, times four, into counts.
  [[nodiscard]] std::size_t index(std::int64_t frame, std::int64_t led, std::int64_t camera) const {
    return static_cast<std::size_t>((frame * led_count() + led) * camera_count() + camera);
  }
  /// The four counts of one observation.
  [[nodiscard]] Eigen::Vector4d at(std::int64_t frame, std::int64_t led, std::int64_t camera) const {
    return Eigen::Map<const Eigen::Matrix<std::int16_t, 4, 1>>(counts.data() + 4 * index(frame, led, camera))
        .cast<double>();
  }
  /// The four counts of one camera in the dark slot of a frame.
  [[nodiscard]] Eigen::Vector4d dark_at(std::int64_t frame, std::int64_t camera) const {
    return Eigen::Map<const Eigen::Matrix<std::int16_t, 4, 1>>(dark.data() +
                                                               4 * (frame * camera_count() + camera))
        .cast<double>();
  }
  /// Times of the four conversions of an observation, s after the frame's time.
  [[nodiscard]] Eigen::Map<const Eigen::Vector4d> offset_s(std::int64_t led, std::int64_t camera) const {
    return Eigen::Map<const Eigen::Vector4d>(conversion_time_s.data() + 4 * (led * camera_count() + camera));
  }
  /// Times of the four conversions of a camera in the dark slot, s after the frame's time.
  [[nodiscard]] Eigen::Map<const Eigen::Vector4d> dark_offset_s(std::int64_t camera) const {
    return Eigen::Map<const Eigen::Vector4d>(dark_time_s.data() + 4 * camera);
  }
  /// Whether an observation bears a flag.
  [[nodiscard]] bool has_flag(std::int64_t frame, std::int64_t led, std::int64_t camera,
                              CountFlag flag) const {
    return (flags[index(frame, led, camera)] & flag) != 0;
  }

  /// Counts of 0 with no flag set, conversions at time 0.
  static Counts zeros(std::vector<std::string> leds, std::vector<std::string> cameras, const TimeBase& time,
                      bool dark_slot);

  /// Shapes agree, names are unique and not empty, the rate is positive, counts lie in [0, highest_code],
  /// conversion times are finite and lie within two frames of their frame. O(F L C).
  [[nodiscard]] Status validate() const;
};

struct Rig;
/// That a recording can be of this rig: as many cameras, and the same id where both have one. Both may still
/// be wrong by themselves.
[[nodiscard]] Status check_same_rig(const Counts& counts, const Rig& rig);

}  // namespace kinemark::data
