// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Counts of one frame: what record() and the simulated device share.
#pragma once

#include <cstdint>

#include "kinemark/data/counts.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "kinemark/stages/simulation/rig_recording.h"
#include "kinemark/stages/simulation/rig_scene.h"

namespace kinemark::simulation::internal {

/// Where the counts of one frame go; shapes as in data::Counts for a single frame.
struct FramePlace {
  std::int16_t* counts = nullptr;  ///< L x C x 4
  std::int16_t* dark = nullptr;    ///< C x 4; looked at with a dark slot only
  std::uint8_t* flags = nullptr;   ///< L x C; bits are set, none is cleared
  std::uint8_t* hidden = nullptr;  ///< L x C, bits of HiddenFlag; may be absent
};

/// Counts without a frame, as the rig makes them of these LEDs: names, rate, times of conversions.
[[nodiscard]] data::Counts layout_of(const PhysicalRig& rig, const std::vector<std::string>& leds,
                                     const TimeBase& time);

/// Converts one frame after the other, in any order and by several threads. Keeps references.
class FrameConverter {
 public:
  /// @param layout  names and times  @param options  options.frames orders the draws of noise, see record()
  FrameConverter(const PhysicalRig& rig, const RigScene& scene, const RigRecordingOptions& options,
                 const data::Counts& layout)
      : rig_(rig), scene_(scene), options_(options), layout_(layout) {}
  /// @param f  0 to options.frames - 1
  void convert(std::int64_t f, const FramePlace& out) const;

 private:
  [[nodiscard]] int leds() const { return static_cast<int>(layout_.leds.size()); }
  [[nodiscard]] int cameras() const { return rig_.rig.camera_count(); }
  [[nodiscard]] double intensity(int led) const;
  [[nodiscard]] bool occluded(std::int64_t f, int led, int camera) const;
  [[nodiscard]] Eigen::Vector3d behind(int camera) const;
  void observe(std::int64_t f, int led, int camera, const FramePlace& out) const;
  void dark(std::int64_t f, int camera, const FramePlace& out) const;
  bool digitize(Eigen::Vector4d expected, const Eigen::Vector4d& time_s, int camera, std::uint64_t stream,
                std::uint64_t block, std::int64_t f, std::int16_t* codes) const;

  const PhysicalRig& rig_;
  const RigScene& scene_;
  const RigRecordingOptions& options_;
  const data::Counts& layout_;
};

}  // namespace kinemark::simulation::internal
