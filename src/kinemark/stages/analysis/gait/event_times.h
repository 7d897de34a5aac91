// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What four detectors are late or early by against force plates, and the one time made of them.
#pragma once

#include <array>
#include <cstdint>

#include "kinemark/core/missing.h"
#include "kinemark/data/gait_event.h"
#include "kinemark/stages/analysis/gait/gait_markers.h"

namespace kinemark::analysis {

/// Detectors of an event, in the order of their numbers.
enum class Detector : std::uint8_t {
  vertical,  ///< strike: last fall of the middle of the foot, leaving: its fastest rise (after O'Connor et
             ///< al. 2007)
  pelvis,    ///< heel farthest before the pelvis, toe farthest behind it (Zeni et al. 2008)
  rear,      ///< the heel's speed over the ground passes 0.14 of the usual greatest (after Ghoussayni et al.
             ///< 2004)
  middle,    ///< that of the middle of the foot passes kStands of it: there by construction
};
inline constexpr std::size_t kDetectors = 4;  ///< number of Detector

/// Times of one event in seconds after that of Detector::middle, which is 0; NaN: not found.
using DetectorTimes = std::array<double, kDetectors>;

/// One time of an event, in seconds after that of Detector::middle.
struct FusedTime {
  double after_s = 0.0;    ///< detectors less their biases: the median, and weights of what they differ by
  data::EventError error;  ///< where all detectors agree
  DetectorTimes apart_s{kNaN, kNaN, kNaN, kNaN};  ///< each detector less its bias, from the median of all
};

/// Fuse the detectors of an event.
///
/// Biases and SDs were learnt on 202 events of force plates in 41 recordings of 22 laboratories and subjects,
/// each laboratory judged with biases learnt from the others (docs/theory/gait.md); for walking and running
/// apart, and for each FootSet. Nothing of the recording's own plates enters.
///
/// @param frame_s  1 / rate
[[nodiscard]] FusedTime fuse(const DetectorTimes& times, data::FootEvent what, bool running, FootSet set,
                             double frame_s);

/// What an event errs by, s, SD, where its detectors lie apart so (FusedTime::apart_s): 0.4 of their SD, and
/// all that it has beyond 20 ms, the most that was learnt from: the foot moves otherwise than feet there, and
/// which detector is right is open.
[[nodiscard]] double error_of_apart(const DetectorTimes& apart_s);

}  // namespace kinemark::analysis
