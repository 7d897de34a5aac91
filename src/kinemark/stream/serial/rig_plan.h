// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Plans of a scan as commands to a rig on a serial line, in ticks of its clock, and what it grants.
#pragma once

#include <cstdint>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/stream/device.h"
#include "kinemark/stream/serial/frame_decoder.h"
#include "kinemark/stream/serial/rig_answer.h"

namespace kinemark::stream {

/// What a rig says of itself when it is asked "?". Times are ticks.
struct SerialRigFacts {
  std::string name;                        ///< "rig328p"
  std::string version;                     ///< of its program
  int leds = 0, cameras = 0, bits = 0;     ///< what it has
  double clock_hz = 0.0;                   ///< ticks in a second
  std::int64_t settle = 0;                 ///< least, from an LED's start to its first conversion
  std::int64_t conversion = 0;             ///< least, from one to the next
  std::int64_t off = 0;                    ///< least, between two LEDs
  std::int64_t longest = 0;                ///< of these three
  std::int64_t period = 0;                 ///< longest, of a frame
  std::int64_t hold = 0;                   ///< from the start of a conversion to its sample
  int levels = 0;                          ///< of an LED's light; 0 or 1: it has one
  int outputs = 0;                         ///< digital
  bool has_dark = false, trigger = false;  ///< a dark slot; a line that starts it
  double highest_v = 0.0;                  ///< of the highest code; 0: not said
};

/// Code::device when it is no rig, or one of another protocol.
[[nodiscard]] Result<SerialRigFacts> serial_facts(const RigAnswer& answer);
/// The same as others see it.
[[nodiscard]] DeviceCapabilities serial_capabilities(const SerialRigFacts& facts);
/// The command for a plan: "plan LEDS DARK PERIOD SETTLE CONVERSION OFF TRIGGER LEVEL...". Code::usage for
/// what it cannot be asked.
[[nodiscard]] Result<std::string> plan_command(const ScanPlan& plan, const SerialRigFacts& facts);
/// The plan as it was granted, or the refusal with what is possible (Code::usage).
[[nodiscard]] Result<GrantedPlan> granted_plan(const ScanPlan& wanted, const RigAnswer& answer,
                                               const SerialRigFacts& facts);
/// Size of the frames of a plan.
[[nodiscard]] FrameShape frame_shape(const ScanPlan& plan);

}  // namespace kinemark::stream
