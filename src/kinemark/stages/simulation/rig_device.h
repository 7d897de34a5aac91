// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The simulated rig as a device: counts that come as time passes, without a past or a future in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/stages/simulation/internal/rig_frame.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"
#include "kinemark/stream/clock.h"
#include "kinemark/stream/device.h"

namespace kinemark::simulation {

/// How a simulated rig behaves as a device.
struct RigDeviceOptions {
  double rate_hz = 0.0;                ///< where the plan does not say; 0: the highest that the slots allow
  double duration_s = 0.0;             ///< after which no frame comes; 0: never, up to 2^32 frames
  std::uint64_t seed = 1, stream = 0;  ///< of the noise
  double speed = 1.0;                  ///< its seconds in one of the host's; 0: as fast as it is read
  double clock_ppm = 0.0;              ///< that its clock is fast, millionths; below 100,000 either way
  double buffer_s = 1.0;               ///< of frames that it keeps for a host that does not read; > 0
  double unplug_at_s = 0.0;            ///< when its plug is pulled; 0: never
  double unplug_for_s = 1.0;           ///< until it is put back
  // Faults, each by number from 1; 0: none.
  int dark_led = 0;       ///< that never shines
  int bright_led = 0;     ///< with 30 times its light
  int noisy_channel = 0;  ///< with 20 counts of noise; channels of camera after camera, +x -x +y -y

  double afterglow = 0.0;  ///< 0 to 0.5: share of the last LED's counts that is still there in the dark slot

  /// Ranges hold.
  [[nodiscard]] Status check() const;
};

/// The counts are those of record(), to the bit, with the same seed, stream and number of frames; where no
/// duration is given noise is drawn as for a recording of 2^32 frames. Frame f is there once it has ended, at
/// (f + 1) / rate by the device's clock. A plan may name LEDs, fewer than the scene has: the first are lit.
/// Frames that nobody has read within buffer_s are lost, the oldest first. Its timing is that of the rig,
/// whatever a plan asks for. Memory does not grow with time.
class RigDevice final : public stream::Device {
 public:
  /// @param scene  with the names of its LEDs  @param clock  never nullptr
  [[nodiscard]] static Result<std::unique_ptr<RigDevice>> create(PhysicalRig rig, RigScene scene,
                                                                 const RigDeviceOptions& options,
                                                                 std::shared_ptr<stream::HostClock> clock);
  [[nodiscard]] const stream::DeviceCapabilities& capabilities() const override { return capabilities_; }
  [[nodiscard]] Result<stream::GrantedPlan> configure(const stream::ScanPlan& plan) override;
  [[nodiscard]] Status start() override;
  [[nodiscard]] Result<stream::ReadResult> read(stream::Block& block,
                                                std::chrono::milliseconds timeout) override;
  [[nodiscard]] Status stop() override;
  [[nodiscard]] Status reopen() override;
  /// It has no outputs.
  [[nodiscard]] Status write_analog(int channel, double volts) override;
  [[nodiscard]] Status write_digital(int line, bool high) override;

 private:
  RigDevice(PhysicalRig rig, RigScene scene, const RigDeviceOptions& options,
            std::shared_ptr<stream::HostClock> clock);
  [[nodiscard]] Result<RigRecordingOptions> grant(stream::ScanPlan& plan) const;
  void plant_faults(std::size_t leds);
  void disturb(std::int64_t frame, std::int16_t* counts, std::int16_t* dark) const;
  void glow_on(std::int64_t frame, const std::int16_t* counts, std::int16_t* dark) const;
  [[nodiscard]] std::int64_t due_ns(std::int64_t frame) const;
  [[nodiscard]] std::int64_t ended_frames(std::int64_t now_ns) const;
  [[nodiscard]] bool is_unplugged(std::int64_t now_ns) const;
  void skip_what_is_lost(std::int64_t ended, stream::Block& block);
  void fill(std::int64_t frames, stream::Block& block);

  PhysicalRig rig_;
  RigScene scene_;
  RigDeviceOptions options_;
  std::shared_ptr<stream::HostClock> clock_;
  stream::DeviceCapabilities capabilities_;
  data::Counts layout_;            ///< of the plan that was granted
  RigRecordingOptions recording_;  ///< of the plan that was granted
  bool configured_ = false, running_ = false, unplugged_ = false, was_unplugged_ = false;
  bool gap_ = false;  ///< before the next frame
  std::int64_t start_ns_ = 0, next_ = 0;
};

}  // namespace kinemark::simulation
