// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From a device that runs to a recording, and nothing lost without being counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/stream/clock.h"
#include "kinemark/stream/clock_fit.h"
#include "kinemark/stream/count_check.h"
#include "kinemark/stream/device.h"
#include "kinemark/stream/slot_crosstalk.h"

namespace kinemark::pipeline {

/// Begin with the first frame in which an LED is as bright as that at one camera or more.
struct BrightnessTrigger {
  int led = 0;             ///< index into the plan's LEDs
  double counts = 1000.0;  ///< sum of the four electrodes
};

/// Somebody who looks at what comes: live curves, an alignment guide.
class BlockFollower {
 public:
  virtual ~BlockFollower() = default;
  BlockFollower(const BlockFollower&) = delete;
  BlockFollower& operator=(const BlockFollower&) = delete;
  /// On a thread of its own, in the order of frames. Whoever takes long misses blocks, and nobody else does.
  virtual void take(const stream::Block& block) = 0;

 protected:
  BlockFollower() = default;
};

/// Options of Recorder.
struct RecorderOptions {
  std::filesystem::path file;                   ///< the recording, .mcap; empty: nothing is kept
  io::RecordingOptions recording;               ///< replacing, forcing to the disk
  std::vector<io::RecordingMetadata> metadata;  ///< written before the first frame
  std::int64_t frames = 0;                      ///< of the device, lost ones included; 0: until stop()
  std::optional<BrightnessTrigger> begin;       ///< nothing: with frame 0
  double ring_s = 10.0;                         ///< of frames that wait for the disk at most, > 0
  double give_up_s = 600.0;                     ///< that a device may be away, without a frame
  std::chrono::milliseconds look_every{200};    ///< for one that is away
  std::vector<std::shared_ptr<BlockFollower>> followers = {};
  std::shared_ptr<stream::HostClock> clock;  ///< nullptr: the machine's
};

/// Where a recording stands. frames = received + dropped_by_device; received = acknowledged + dropped_here +
/// those that wait, which are none once it is finished.
struct RecorderProgress {
  std::int64_t frames = 0;             ///< of the device since the beginning, whoever lost them
  std::int64_t received = 0;           ///< read from the device
  std::int64_t acknowledged = 0;       ///< that a stop of this program cannot lose
  std::int64_t dropped_by_device = 0;  ///< that it never gave
  std::int64_t dropped_here = 0;       ///< that the disk was too slow or too full for
  std::int64_t missed_by_followers = 0;
  int reopened = 0;           ///< times that it was away and came back
  double fullest_ring = 0.0;  ///< 0 to 1, of the room for frames that wait for the disk
  bool away = false;          ///< it is unplugged now, or silent
  bool begun = true;          ///< false: waits for the LED that begins it
};

/// What ended it.
enum class RecorderEnd : std::uint8_t {
  complete,  ///< as many frames as were asked for, or the device has no more
  stopped,   ///< by stop()
  failed,    ///< the disk, or a device that did not come back: see Recorded::error
};
[[nodiscard]] std::string_view to_string(RecorderEnd end);  ///< "complete", "stopped", "failed"

/// A recording that is closed.
struct Recorded {
  RecorderProgress progress;
  RecorderEnd end = RecorderEnd::complete;
  std::optional<Error> error;                ///< why it failed; what was acknowledged is kept
  std::optional<stream::ClockRate> clock;    ///< of the device; nothing: too short, or it has no clock
  std::vector<stream::CountLevels> lit;      ///< L x C, of the blocks that were kept whole
  std::vector<stream::CountLevels> dark;     ///< C; empty without a dark slot
  std::vector<stream::SlotShare> crosstalk;  ///< C, into the dark slot; empty without one
  int crosstalk_led = -1;                    ///< whose light it is
};

/// Reads a device on one thread and writes on another; between them frames wait in a ring. Where it is full
/// frames are dropped and counted; a device without a clock of its own (speed 0) waits instead. What is
/// missing is a step of the frames' numbers, with a metadata record "gap" before it that says who lost it
/// (the first thousand). At the end comes the record "acquisition_end". A device that fails is looked for
/// until it is back, and its frames go on in the same recording; so is one with a clock that gave frames and
/// gives none for 2 s and three frames, unless it pauses. The device is stopped at the end; that it does
/// not answer any more is noted there, and spoils nothing.
class Recorder {
 public:
  /// Starts the device, then makes the file. Fails as both do: where the device does not start no file is
  /// made and none is replaced; where no file can be made the device is stopped.
  /// @param device  configured with `plan`; must outlive the recorder, and is nobody else's meanwhile
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> start(stream::Device& device,
                                                               const stream::GrantedPlan& plan,
                                                               RecorderOptions options);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// From any thread.
  [[nodiscard]] RecorderProgress progress() const;
  /// No more frames; what waits is written. From any thread.
  void stop();
  /// Whether it has ended by itself within that time.
  [[nodiscard]] bool wait_for(std::chrono::milliseconds time);
  /// Until it has ended, by itself or by stop(); closes the file. Once.
  [[nodiscard]] Recorded finish();

 private:
  struct State;
  explicit Recorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace kinemark::pipeline
