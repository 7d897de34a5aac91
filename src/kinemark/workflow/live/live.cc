// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/live/live.h"

#include <algorithm>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"

namespace kinemark::workflow {
namespace {

/// Nothing is known of the coordinates: what is there is a posture that no marker holds.
void set_unknown(motion::LivePose& pose) {
  const auto n = pose.q.size();
  for (auto* numbers : {&pose.q, &pose.qd, &pose.qdd, &pose.tau, &pose.q_sd, &pose.q_bound})
    numbers->setConstant(n, kNaN);
  pose.pushed_q.setConstant(kNaN);
  pose.determined.assign(static_cast<std::size_t>(n), 0);
}

}  // namespace

LiveAngles::LiveAngles(motion::OnlineTracker tracker, std::size_t markers, LiveTaker take)
    : tracker_(std::move(tracker)), x_(3, static_cast<Eigen::Index>(markers)), take_(std::move(take)) {}

Status LiveAngles::push(const stream::Frame& frame) {
  check(std::cmp_equal(frame.x_in_world.size(), x_.size()), "a frame has the markers of its source");
  x_ = Eigen::Map<const Eigen::Matrix3Xd>(frame.x_in_world.data(), 3, x_.cols());
  if (auto s = tracker_.push(frame.time_s, x_); !s) return s;
  if (first_ < 0) first_ = frame.number;
  return hand_on();
}

Status LiveAngles::finish() {
  tracker_.finish();
  return hand_on();
}

Status LiveAngles::hand_on() {
  for (;;) {
    const auto ready = tracker_.next();
    if (!ready) return std::unexpected(ready.error());
    if (*ready == nullptr) return {};
    pose_ = **ready;
    pose_.frame += first_;
    if (pose_.status == data::FrameStatus::no_markers) set_unknown(pose_);
    take_(pose_);
  }
}

Result<std::unique_ptr<LiveAngles>> live(const model::Model& model, const stream::SourceFacts& facts,
                                         LiveTaker take, const motion::TrackOptions& options) {
  check(take != nullptr, "angles need somebody who takes them");
  auto tracker = motion::OnlineTracker::create(model, facts.markers, facts.rate_hz, options);
  if (!tracker) return fail_at(facts.name, tracker.error());
  return std::unique_ptr<LiveAngles>(
      new LiveAngles(std::move(*tracker), facts.markers.size(), std::move(take)));
}

}  // namespace kinemark::workflow
