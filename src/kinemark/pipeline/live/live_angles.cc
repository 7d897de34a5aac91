// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/live/live_angles.h"

#include <limits>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"

namespace kinemark::pipeline {

LiveAngles::LiveAngles(motion::OnlineTracker tracker, std::shared_ptr<const model::Model> model,
                       std::int64_t markers)
    : tracker_(std::move(tracker)), model_(std::move(model)), x_(3, markers) {
  constexpr double kMmPerM = 1e3;
  for (const auto& coordinate : model_->description().coordinates)
    per_unit_.push_back(coordinate.is_rotation ? kDegPerRad : kMmPerM);
  out_.value.resize(per_unit_.size());
  out_.sd.resize(per_unit_.size());
  out_.determined.resize(per_unit_.size());
}

Result<LiveAngles> LiveAngles::create(const LiveSource& source) {
  check(source.model != nullptr, "angles need a model");
  auto tracker =
      motion::OnlineTracker::create(*source.model, source.markers.names, source.markers.time.rate_hz);
  if (!tracker) return fail_at(source.name, tracker.error());
  return LiveAngles(std::move(*tracker), source.model, source.markers.markers());
}

Status LiveAngles::push(double time_s, std::span<const double> x_in_world) {
  check(std::cmp_equal(x_in_world.size(), x_.size()), "a frame has the markers of its source");
  x_ = Eigen::Map<const Eigen::Matrix3Xd>(x_in_world.data(), 3, x_.cols());
  return tracker_.push(time_s, x_);
}

Result<const LiveAnglesFrame*> LiveAngles::next() {
  const auto pose = tracker_.next();
  if (!pose) return std::unexpected(pose.error());
  if (*pose == nullptr) return nullptr;
  const motion::LivePose& p = **pose;
  out_.frame = p.frame;
  out_.time_s = p.time_s;
  // Before it has begun, the body is only in its rest posture.
  const bool known = p.status != data::FrameStatus::no_markers;
  for (std::size_t c = 0; c < per_unit_.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    out_.value[c] = static_cast<float>(known && i < p.q.size() ? per_unit_[c] * p.q[i] : kNaN);
    out_.sd[c] = static_cast<float>(known && i < p.q_sd.size() ? per_unit_[c] * p.q_sd[i] : kNaN);
    out_.determined[c] = known && c < p.determined.size() ? p.determined[c] : 0;
  }
  return &out_;
}

}  // namespace kinemark::pipeline
