// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_angles.h"

#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"

namespace kinemark::pipeline {

LiveAngles::LiveAngles(motion::OnlineTracker tracker, std::shared_ptr<const model::Model> model,
                       std::size_t markers, Taker take)
    : tracker_(std::move(tracker)),
      model_(std::move(model)),
      x_(3, static_cast<Eigen::Index>(markers)),
      take_(std::move(take)) {
  constexpr double kMmPerM = 1e3;
  for (const auto& coordinate : model_->description().coordinates)
    per_unit_.push_back(coordinate.is_rotation ? kDegPerRad : kMmPerM);
  out_.value.resize(per_unit_.size());
  out_.sd.resize(per_unit_.size());
  out_.determined.resize(per_unit_.size());
}

Result<std::unique_ptr<LiveAngles>> LiveAngles::create(std::shared_ptr<const model::Model> model,
                                                       const stream::SourceFacts& facts, Taker take) {
  check(model != nullptr, "angles need a model");
  auto tracker = motion::OnlineTracker::create(*model, facts.markers, facts.rate_hz);
  if (!tracker) return fail_at(facts.name, tracker.error());
  return std::unique_ptr<LiveAngles>(
      new LiveAngles(std::move(*tracker), std::move(model), facts.markers.size(), std::move(take)));
}

Status LiveAngles::push(const stream::Frame& frame) {
  check(std::cmp_equal(frame.x_in_world.size(), x_.size()), "a frame has the markers of its source");
  x_ = Eigen::Map<const Eigen::Matrix3Xd>(frame.x_in_world.data(), 3, x_.cols());
  if (auto s = tracker_.push(frame.time_s, x_); !s) return s;
  return give_ready();
}

Status LiveAngles::finish() {
  tracker_.finish();
  return give_ready();
}

Status LiveAngles::give_ready() {
  for (;;) {
    const auto pose = tracker_.next();
    if (!pose) return std::unexpected(pose.error());
    if (*pose == nullptr) return {};
    show(**pose);
    take_(out_);
  }
}

void LiveAngles::show(const motion::LivePose& p) {
  out_.frame = p.frame;
  out_.time_s = p.time_s;
  // Before it has begun, the body is only in its rest posture.
  const bool known = p.status != data::FrameStatus::no_markers;
  for (std::size_t c = 0; c < per_unit_.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    out_.value[c] = static_cast<float>(known && i < p.q.size() ? per_unit_[c] * p.q[i] : kNaN);
    out_.sd[c] = static_cast<float>(known && i < p.q_sd.size() ? per_unit_[c] * p.q_sd[i] : kNaN);
    out_.determined[c] = known && c < p.determined.size() ? p.determined[c] : 0;
  }
}

}  // namespace kinemark::pipeline
