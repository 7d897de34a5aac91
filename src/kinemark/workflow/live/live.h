// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Joint angles of frames of markers as they come: from a device, a simulation, a recording played again.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/motion/control/track_options.h"
#include "kinemark/stream/stream.h"

namespace kinemark::workflow {

/// Gets the angles of each frame, in order, on the thread that gives frames; they are valid until it returns.
using LiveTaker = std::function<void(const motion::LivePose&)>;

/// A model that follows a source of markers; made by live(). Memory does not grow with the frames. To be used
/// by one thread at a time.
class LiveAngles final : public stream::Sink {
 public:
  /// Take a frame, and hand on the angles that are ready: those of the frame delay_frames() before it. Frames
  /// that are left out count as not seen. Fails as OnlineTracker::push() and next().
  [[nodiscard]] Status push(const stream::Frame& frame) override;
  /// A force on the simulated body from the next frame on, as OnlineTracker::push_body(); what is tracked and
  /// its numbers stay as they are.
  [[nodiscard]] Status push_body(int body, const Eigen::Vector3d& point_in_body,
                                 const Eigen::Vector3d& force_in_world) {
    return tracker_.push_body(body, point_in_body, force_in_world);
  }
  /// No more frames come: what is still inside is handed on.
  [[nodiscard]] Status finish() override;
  /// Frames by which angles come later than their markers.
  [[nodiscard]] std::int64_t delay_frames() const { return tracker_.delay_frames(); }

 private:
  friend Result<std::unique_ptr<LiveAngles>> live(const model::Model& model, const stream::SourceFacts& facts,
                                                  LiveTaker take, const motion::TrackOptions& options);
  LiveAngles(motion::OnlineTracker tracker, std::size_t markers, LiveTaker take);
  [[nodiscard]] Status hand_on();

  motion::OnlineTracker tracker_;
  Eigen::Matrix3Xd x_;
  std::int64_t first_ = -1;  ///< number of the first frame; -1: none came
  motion::LivePose pose_;
  LiveTaker take_;
};

/// Joint angles of a source, each with its standard deviation and a flag that says whether the markers fix
/// it, by direct marker control: the angles of track() on the same frames, a fixed number of frames later
/// (OnlineTracker says what is the same to the bit). Frames are numbered as the source numbers its own. Where
/// no marker holds the body, before the first are seen and in gaps of all of them, every number is NaN;
/// track() holds the last pose there. Unless a marker noise is given, deviations are of what the residuals of
/// the frames so far show, skin that slides among it: in the first seconds of less than those of track().
/// Frames are followed as they come, in whichever axes: what the torques are worth depends on the vertical
/// being the model's.
///
/// @param facts  of the source: its name, which errors begin with, markers and rate
/// @param options  as of track(); its lookahead is the delay, a time range does nothing here
/// Fails as OnlineTracker::create(). About 1 ms per frame for a whole body.
[[nodiscard]] Result<std::unique_ptr<LiveAngles>> live(const model::Model& model,
                                                       const stream::SourceFacts& facts, LiveTaker take,
                                                       const motion::TrackOptions& options = {});

}  // namespace kinemark::workflow
