// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What counts look like while they come: levels, noise, saturation, of each LED at each camera.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kinemark/data/counts.h"
#include "kinemark/stream/device.h"

namespace kinemark::stream {

/// Channels of an LED that shines add up to more than this share of the highest code, above the dark level.
inline constexpr double kLeastLightShare = 0.03;

/// Noise of four channels from third differences of frames that follow each other, in which a path of
/// constant acceleration leaves nothing; their variance is 20 times that of a frame (1 + 9 + 9 + 1).
class DifferenceNoise {
 public:
  /// Frames in their order; one that does not follow the last begins anew.
  void add(std::int64_t frame, const Eigen::Vector4d& counts);
  /// Standard deviations; NaN before four frames in a row.
  [[nodiscard]] Eigen::Vector4d sd() const;

 private:
  std::array<Eigen::Vector4d, 3> last_;  // of the frames before, the youngest first
  std::int64_t last_frame_ = 0, in_a_row_ = 0, differences_ = 0;
  Eigen::Vector4d squares_ = Eigen::Vector4d::Zero();
};

/// Counts of one LED at one camera over a trial. NaN where too few frames came.
struct CountLevels {
  std::int64_t frames = 0;                          ///< that came, without those that were lost
  std::int64_t saturated = 0;                       ///< of them, with a channel at the highest code
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();   ///< counts
  Eigen::Vector4d sd = Eigen::Vector4d::Zero();     ///< of all frames: noise and movement
  Eigen::Vector4d noise = Eigen::Vector4d::Zero();  ///< SD, see DifferenceNoise
  bool still = false;  ///< no channel moves more than its noise does: sd at most 1.5 noise + 0.3 counts
};

/// Running figures of counts; constant memory, O(L C) a frame.
class CountCheck {
 public:
  /// @param like  shapes; its frames are not looked at
  explicit CountCheck(const data::Counts& like);
  /// Frames of the shape that it was made for, in their order.
  void add(const Block& block);
  /// L x C, LED by LED.
  [[nodiscard]] std::vector<CountLevels> lit() const;
  /// C, of the dark slot; empty without one.
  [[nodiscard]] std::vector<CountLevels> dark() const;

 private:
  struct Running {
    std::int64_t frames = 0, saturated = 0;
    Eigen::Vector4d mean = Eigen::Vector4d::Zero(), squares = Eigen::Vector4d::Zero();
    DifferenceNoise noise;
    void add(std::int64_t frame, const std::int16_t* counts);
    [[nodiscard]] CountLevels levels() const;
  };
  std::vector<Running> lit_, dark_;
};

}  // namespace kinemark::stream
