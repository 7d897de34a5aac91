// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/live/live_source.h"
#include "kinemark/stages/motion/control/online_tracker.h"

namespace kinemark::pipeline {

/// Coordinates of the model in one frame, as a page shows them; n of them, in the model's order.
struct LiveAnglesFrame {
  std::int64_t frame = 0;                ///< number of the frame, from 0
  double time_s = 0.0;                   ///< of the frame
  std::vector<float> value;              ///< degrees, translations in mm
  std::vector<float> sd;                 ///< likewise; NaN where the markers do not determine it
  std::vector<std::uint8_t> determined;  ///< 0: the markers do not determine it
};

/// Angles of a source's model, a fixed number of frames after their markers. Direct marker control with its
/// default options; frames that are left out count as not seen.
class LiveAngles {
 public:
  /// Fails as OnlineTracker::create(); the source must have a model and outlive this.
  [[nodiscard]] static Result<LiveAngles> create(const LiveSource& source);

  /// One frame of the source. Fails as OnlineTracker::push().
  [[nodiscard]] Status push(double time_s, std::span<const double> x_in_world);
  /// No more frames come: what is still inside becomes available.
  void finish() { tracker_.finish(); }
  /// The next frame that is ready, valid until the next call, or nullptr. To be called until then after every
  /// push().
  [[nodiscard]] Result<const LiveAnglesFrame*> next();

 private:
  LiveAngles(motion::OnlineTracker tracker, std::shared_ptr<const model::Model> model, std::int64_t markers);
  motion::OnlineTracker tracker_;
  std::shared_ptr<const model::Model> model_;
  Eigen::Matrix3Xd x_;
  std::vector<double> per_unit_;
  LiveAnglesFrame out_;
};

}  // namespace kinemark::pipeline
