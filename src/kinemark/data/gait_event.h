// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Instants of walking: a foot comes to the ground, and leaves it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "kinemark/core/missing.h"

namespace kinemark::data {

/// Of the body.
enum class Side : std::uint8_t { left, right };
/// Both, in the order of their numbers.
inline constexpr std::array<Side, 2> kBothSides{Side::left, Side::right};
/// "Left" or "Right", as C3D files call it.
[[nodiscard]] constexpr std::string_view to_string(Side side) {
  return side == Side::left ? "Left" : "Right";
}
/// Index in arrays of two.
[[nodiscard]] constexpr std::size_t index_of(Side side) { return side == Side::left ? 0 : 1; }
/// The other one.
[[nodiscard]] constexpr Side opposite(Side side) { return side == Side::left ? Side::right : Side::left; }

/// What a foot does.
enum class FootEvent : std::uint8_t { strike, off };
/// Both, in the order of their numbers.
inline constexpr std::array<FootEvent, 2> kFootEvents{FootEvent::strike, FootEvent::off};
/// "Foot Strike" or "Foot Off", as C3D files call it.
[[nodiscard]] constexpr std::string_view to_string(FootEvent what) {
  return what == FootEvent::strike ? "Foot Strike" : "Foot Off";
}
/// Index in arrays of two.
[[nodiscard]] constexpr std::size_t index_of(FootEvent what) { return what == FootEvent::strike ? 0 : 1; }

/// Who says so.
enum class EventSource : std::uint8_t { plate, kinematics, file };
/// "plate", "kinematics" or "file".
[[nodiscard]] constexpr std::string_view to_string(EventSource source) {
  return source == EventSource::plate ? "plate" : source == EventSource::kinematics ? "kinematics" : "file";
}

/// One instant of one foot.
struct GaitEvent {
  Side side = Side::left;                        ///< of the foot
  FootEvent what = FootEvent::strike;            ///< what it does
  double time_s = 0.0;                           ///< on the recording's clock
  double sd_s = kNaN;                            ///< one standard deviation of the time; NaN: not known
  EventSource source = EventSource::kinematics;  ///< who says so
  std::string method;                            ///< "plate 2", "O'Connor 2007", "the file"
};

/// Parts of what an event errs by, standard deviations in s.
struct EventError {
  double kind_s = 0.0;  ///< the same for all events of a kind in a recording: laboratory, marker set, shoe
  double foot_s = 0.0;  ///< the same for all of a kind and foot: how this foot comes and goes
  double own_s = 0.0;   ///< of each event by itself
  /// All of it.
  [[nodiscard]] double sd_s() const { return std::hypot(kind_s, foot_s, own_s); }
};

}  // namespace kinemark::data
