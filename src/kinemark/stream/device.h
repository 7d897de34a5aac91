// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A device on the desk: LEDs lit in turn, detectors whose electrodes are converted. Simulated, replayed, a
// microcontroller, an A/D board.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/counts.h"
#include "kinemark/data/rig.h"

namespace kinemark::stream {

/// One voltage range of a converter.
struct VoltageRange {
  double lowest_v = 0.0;   ///< of code 0
  double highest_v = 0.0;  ///< of the highest code
};

/// How a recording can begin.
enum class Trigger : std::uint8_t {
  at_once,       ///< with start()
  digital_line,  ///< when a digital input rises
};

/// What a device can do, as it says itself once it is open.
struct DeviceCapabilities {
  std::string name;               ///< what it calls itself: "rig328p 1.0", "comedi_test"
  int most_leds = 0;              ///< that it can light in turn; 0: it lights none, they run by themselves
  std::vector<std::string> leds;  ///< names that it has for them; empty: none, see own_names()
  std::vector<std::string> camera_names;  ///< likewise, of its cameras
  int cameras = 0;                        ///< with four electrodes each
  int bits = 0;                           ///< of the converter
  std::vector<VoltageRange> ranges;       ///< empty: not known
  data::SlotTiming fastest;               ///< shortest slot
  double lowest_rate_hz = 0.0;            ///< frames in a second; the highest follows from the slots
  bool sets_intensity = false;            ///< of each LED, by the length of its pulse or its current
  bool has_dark_slot = false;             ///< can convert with all LEDs dark
  bool pauses = false;                    ///< may give no frames for long and be there: a recording with gaps
  int analog_outputs = 0;                 ///< channels of write_analog()
  int digital_outputs = 0;                ///< lines of write_digital()
  std::vector<Trigger> triggers;          ///< at least at_once
  /// Seconds of its own clock in one of the host's: 1 but for simulations and recordings. 0: frames come when
  /// they are asked for, however late, and none is lost.
  double speed = 1.0;
};

/// Names of the first `count`: those given, then "1", "2" ... or, for cameras, "A", "B" ...
[[nodiscard]] std::vector<std::string> own_names(const std::vector<std::string>& given, int count,
                                                 bool cameras);

/// What is wanted of a device, and what it grants.
struct ScanPlan {
  std::vector<std::string> leds;     ///< L names, unique; empty: all that it has, by own_names()
  std::vector<std::string> cameras;  ///< C names, unique; empty: likewise
  double rate_hz = 0.0;              ///< frames in a second; 0: the highest that slots and device allow
  data::SlotTiming timing;           ///< of each LED's slot
  std::vector<double> intensity;     ///< L, of an LED's full light, in (0, 1]; empty: 1
  Trigger trigger = Trigger::at_once;
};

/// The plan with names of its own where it has none: all LEDs (one, of a device that lights none) and all
/// cameras of the device.
[[nodiscard]] ScanPlan with_names(ScanPlan plan, const DeviceCapabilities& device);

/// Slots as on the rig of 1986 (data::SlotTiming), which its amplifiers need to settle, and no shorter than
/// the device's shortest; with a dark slot where that has one.
[[nodiscard]] data::SlotTiming usual_timing(const DeviceCapabilities& device);

/// A plan as the device will run it.
struct GrantedPlan {
  ScanPlan plan;        ///< with the rate, timing and intensities that it really has
  data::Counts layout;  ///< names, rate, codes and time of each conversion; without a frame
  std::map<std::string, std::string> facts;  ///< to be kept with the recording: "firmware", "seed"
};

/// Frames that came together.
struct Block {
  std::int64_t first_frame = 0;  ///< from 0 at start(); a step says that the device lost those between
  std::int64_t frames = 0;       ///< F in this block; at least 1
  std::int64_t host_before_ns =
      0;                           ///< steady clock of the host when it was last looked whether they came ...
  std::int64_t host_after_ns = 0;  ///< ... and once they were read: the last of them ended before
  std::vector<std::int16_t> counts;  ///< F x L x C x 4, as in data::Counts
  std::vector<std::int16_t> dark;    ///< F x C x 4; empty without a dark slot
  std::vector<std::uint8_t> flags;   ///< F x L x C, bits of data::CountFlag
  bool overflow = false;             ///< the device's own buffer ran over before this block
  bool gap = false;                  ///< frames are missing before first_frame, whoever lost them
  bool renumbered = false;  ///< first_frame is by the host's clock, since the device began to count again
  bool saturated = false;   ///< one of these counts or more stands at the highest code
};

/// What read() found.
enum class ReadResult : std::uint8_t {
  block,    ///< the block holds frames
  timeout,  ///< none came in time; the device goes on
  ended,    ///< no more will come: a recording that was replayed, a count that was asked for
};

/// An open device. To be used by one thread at a time, but for write_analog() and write_digital(). Failures
/// have Code::device and say what to do: who holds it, which group to join, which plug to look at.
class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  /// The same from the beginning to the end.
  [[nodiscard]] virtual const DeviceCapabilities& capabilities() const = 0;
  /// Set it up; not while it runs. Code::usage for what it cannot do, with the nearest that it can: "8 LEDs
  /// at 200 Hz do not fit: the highest rate is 138 Hz".
  [[nodiscard]] virtual Result<GrantedPlan> configure(const ScanPlan& plan) = 0;
  /// Begin with frame 0, or, with a trigger, wait for it. A contract: after configure().
  [[nodiscard]] virtual Status start() = 0;
  /// The next frames, into a block whose memory is used again. Waits no longer than `timeout`. After a
  /// failure reopen() may find it again.
  [[nodiscard]] virtual Result<ReadResult> read(Block& block, std::chrono::milliseconds timeout) = 0;
  /// No more frames; LEDs are dark. It may start() again.
  [[nodiscard]] virtual Status stop() = 0;
  /// Look for a device that was unplugged; goes on with the plan it had. Frames are numbered on by the host's
  /// clock, so that those in between are missing.
  [[nodiscard]] virtual Status reopen() = 0;
  /// @param channel  of analog_outputs  @param volts  clipped to nothing: out of range is Code::usage
  [[nodiscard]] virtual Status write_analog(int channel, double volts) = 0;
  /// @param line  of digital_outputs
  [[nodiscard]] virtual Status write_digital(int line, bool high) = 0;

 protected:
  Device() = default;
};

/// A device that could be opened.
struct DeviceInfo {
  std::string uri;    ///< what to open: "serial:/dev/ttyACM0"
  std::string name;   ///< for people: "Arduino Uno"
  std::string state;  ///< empty: ready; else why it cannot be opened, and what to do
};

}  // namespace kinemark::stream
