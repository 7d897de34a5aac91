// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What of an LED's light is still there in the slot after its own.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/counts.h"
#include "kinemark/stream/device.h"

namespace kinemark::stream {

/// Crosstalk from a slot into the dark slot after it, channel by channel of a camera.
struct SlotShare {
  Eigen::Vector4d share =
      Eigen::Vector4d::Constant(kNaN);  ///< of the counts of the slot before; NaN: not known
  /// Standard deviations; the light of the room, which both slots have in common, is part of it.
  Eigen::Vector4d sd = Eigen::Vector4d::Constant(kNaN);
};

/// Finds the share of a slot's counts that is still in the dark slot after it: amplifiers that have not
/// settled, an LED that goes out slowly.
///
/// Counts of the dark slot are regressed on those of the slot before it, in spans of kSpan frames with a
/// level of their own each, so that slow changes of the room do not count. SDs are those of the scatter
/// between spans (a sandwich by spans), to which is added what flicker that both slots share can make at
/// most: the variance of the dark counts over that of the others. So the LED must move: the share of one that
/// stands still is not known. Electrodes among each other, and other channels, are a matter of `calibrate`.
/// Constant memory, O(C) a frame.
class SlotCrosstalk {
 public:
  static constexpr int kSpan = 50;       ///< frames
  static constexpr int kLeastSpans = 8;  ///< from which on a share is known
  /// @param like  shapes and times of conversions; without a dark slot nothing is found
  explicit SlotCrosstalk(const data::Counts& like);
  /// Frames of the shape that it was made for, in their order; lost and saturated ones are left out.
  void add(const Block& block);
  /// By camera; empty without a dark slot.
  [[nodiscard]] std::vector<SlotShare> found() const;
  /// Whose slot comes before the dark one; -1 without a dark slot.
  [[nodiscard]] int led() const { return led_; }

 private:
  /// Sums of one channel.
  struct Span {
    std::int64_t frames = 0;
    double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    void add(double x, double y);
  };
  struct Channel {
    Span now;
    std::int64_t spans = 0, frames = 0;
    double xx = 0.0, xy = 0.0, yy = 0.0;           // of all spans that are whole
    double xx_xx = 0.0, xx_xy = 0.0, xy_xy = 0.0;  // products of the spans' own sums
    void add(double x, double y);
    void end_span();
  };
  void add_frame(const Block& block, std::size_t frame);

  std::size_t observations_ = 0, cameras_ = 0;
  int led_ = -1;
  bool frame_before_ = false;  // that slot is the last one of the frame before
  std::vector<double> last_;   // counts of it, where it is
  std::vector<bool> known_;    // of each camera: they can be taken
  std::int64_t last_frame_ = -2;
  std::vector<Channel> channels_;
};

}  // namespace kinemark::stream
