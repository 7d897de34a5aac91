// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a rig sees now, from its counts as they come: spots, light, noise, occlusions.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/counts.h"

namespace kinemark::workflow {

/// One LED as one camera saw it in the last frames. NaN: it was not seen.
struct LedInCamera {
  Eigen::Vector2d spot = Eigen::Vector2d::Constant(kNaN);  ///< detector ratios, x right, y down, in [-1, 1]
  double light_counts = kNaN;    ///< mean sum of the four channels above the dark slot, if there is one
  double highest_share = kNaN;   ///< of the brightest channel, of the highest code; near 1: it will clip
  double noise_counts = kNaN;    ///< standard deviation of a channel from frame to frame, movement taken out
  double occluded_share = 0.0;   ///< of the frames that came
  double saturated_share = 0.0;  ///< of the frames that came
};

/// Looks at the last frames of a stream of counts. Memory is constant.
///
/// Noise is stream::DifferenceNoise of the frames in which an LED was seen. An observation is taken for
/// occluded when it is flagged so, or when its channels give less than stream::kLeastLightShare.
class CountsMonitor {
 public:
  /// @param layout  names, codes, dark slot; its frames are not looked at  @param frames  that count, >= 4
  explicit CountsMonitor(const data::Counts& layout, int frames = 100);
  /// The next frame; shapes are a contract. Frames that are missing before it end the run of differences.
  void push(std::int64_t number, std::span<const std::int16_t> counts, std::span<const std::uint8_t> flags,
            std::span<const std::int16_t> dark);
  /// From the frames that came last. O(frames).
  [[nodiscard]] LedInCamera seen(int led, int camera) const;
  /// The spots of the frames that came last, oldest first; NaN where it was not seen.
  [[nodiscard]] std::vector<Eigen::Vector2d> spots(int led, int camera) const;
  [[nodiscard]] std::int64_t frames() const { return came_; }  ///< that came

 private:
  struct Frame {
    std::int64_t number = -1;
    std::vector<std::int16_t> counts, dark;
    std::vector<std::uint8_t> flags;
  };
  [[nodiscard]] const Frame& back(std::int64_t age) const;
  [[nodiscard]] std::int64_t kept() const;
  [[nodiscard]] std::size_t index(int led, int camera) const;
  [[nodiscard]] Eigen::Vector4d light(const Frame& frame, int led, int camera) const;
  [[nodiscard]] bool is_seen(const Frame& frame, int led, int camera) const;
  [[nodiscard]] double noise(int led, int camera) const;

  int cameras_ = 0;
  double highest_code_ = 0.0;
  std::vector<Frame> ring_;
  std::int64_t came_ = 0;
};

}  // namespace kinemark::workflow
