// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stream/sink.h"
#include "kinemark/stream/source.h"

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
class LiveAngles final : public stream::Sink {
 public:
  /// Gets each frame of angles, in order; what it is given is valid until it returns.
  using Taker = std::function<void(const LiveAnglesFrame&)>;

  /// Fails as OnlineTracker::create(). @param model  of those frames; never nullptr
  [[nodiscard]] static Result<std::unique_ptr<LiveAngles>> create(std::shared_ptr<const model::Model> model,
                                                                  const stream::SourceFacts& facts,
                                                                  Taker take);

  /// Fails as OnlineTracker::push() and next().
  [[nodiscard]] Status push(const stream::Frame& frame) override;
  /// What is still inside comes out.
  [[nodiscard]] Status finish() override;

 private:
  LiveAngles(motion::OnlineTracker tracker, std::shared_ptr<const model::Model> model, std::size_t markers,
             Taker take);
  [[nodiscard]] Status give_ready();
  void show(const motion::LivePose& pose);

  motion::OnlineTracker tracker_;
  std::shared_ptr<const model::Model> model_;
  Eigen::Matrix3Xd x_;
  std::vector<double> per_unit_;
  LiveAnglesFrame out_;
  Taker take_;
};

}  // namespace kinemark::pipeline
