// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_push.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::server {
namespace {

constexpr unsigned char kPushKind = 1, kPushVersion = 1;
constexpr double kSaidAgain_s = 1.0;

template <class Bits>
Bits bits_at(std::string_view bytes, std::size_t at) {
  Bits out = 0;
  for (std::size_t i = 0; i < sizeof(Bits); ++i)
    out = static_cast<Bits>(out | static_cast<Bits>(static_cast<unsigned char>(bytes[at + i])) << (8 * i));
  return out;
}

Eigen::Vector3d vector_at(std::string_view bytes, std::size_t at) {
  Eigen::Vector3d out;
  for (Eigen::Index i = 0; i < 3; ++i)
    out[i] = std::bit_cast<float>(bits_at<std::uint32_t>(bytes, at + 4 * static_cast<std::size_t>(i)));
  return out;
}

}  // namespace

std::optional<BodyPush> LivePush::read(std::string_view bytes) const {
  if (bytes.size() != kPushBytes || bytes[0] != kPushKind || bytes[1] != kPushVersion) return std::nullopt;
  const auto body = bits_at<std::uint16_t>(bytes, 2);
  BodyPush out{.body = body, .point_in_body = vector_at(bytes, 4), .force_in_world = vector_at(bytes, 16)};
  if (body >= bodies_ || !out.point_in_body.allFinite() || !out.force_in_world.allFinite())
    return std::nullopt;
  return out;
}

std::string LivePush::take(const void* viewer, const BodyPush& push, double now_s) {
  constexpr double kMost_n = motion::OnlineTracker::kLargestPush_n;
  const double force_n = push.force_in_world.norm();
  const std::scoped_lock lock(mutex_);
  const bool is_free = !push_ || viewer_ == viewer || now_s - said_s_ > kSaidAgain_s;
  if (force_n == 0.0) {
    if (viewer_ == viewer) push_.reset();
    return {};
  }
  if (!is_free) return "another page is pushing the body; wait until it lets go";
  if (force_n > kMost_n)
    return fmt::format("the body is pushed by at most {:g} N; {:.0f} N were not applied", kMost_n, force_n);
  push_ = push;
  viewer_ = viewer;
  said_s_ = now_s;
  return {};
}

void LivePush::let_go(const void* viewer) {
  const std::scoped_lock lock(mutex_);
  if (viewer_ != viewer) return;
  push_.reset();
  viewer_ = nullptr;
}

std::optional<BodyPush> LivePush::now(double now_s) {
  const std::scoped_lock lock(mutex_);
  if (push_ && now_s - said_s_ > kSaidAgain_s) push_.reset();
  return push_;
}

PushedAngles::PushedAngles(std::unique_ptr<workflow::LiveAngles> angles, std::shared_ptr<LivePush> push,
                           std::shared_ptr<LiveClock> clock)
    : angles_(std::move(angles)), push_(std::move(push)), clock_(std::move(clock)) {}

Status PushedAngles::push(const stream::Frame& frame) {
  const auto wish = push_->now(clock_->now_s());
  if (wish || acts_) {
    const BodyPush now = wish.value_or(BodyPush());
    if (auto s = angles_->push_body(now.body, now.point_in_body, now.force_in_world); !s) return s;
    acts_ = wish.has_value();
  }
  return angles_->push(frame);
}

BodyPoses::BodyPoses(std::shared_ptr<const model::Model> model) : model_(std::move(model)), w_(*model_) {}

const std::vector<double>& BodyPoses::find(const motion::LivePose& pose) {
  const auto count = model_->bodies().size();
  const auto& q = pose.pushed_q.size() > 0 ? pose.pushed_q : pose.q;
  poses_.assign(kPoseNumbers * count, kNaN);
  if (!q.allFinite()) return poses_;
  model::kinematics(*model_, w_, model::state_from_coordinates(*model_, q));
  for (std::size_t b = 0; b < count; ++b) {
    const Eigen::Quaterniond turn(w_.rotation[b]);
    const auto& x = w_.position[b];
    const double numbers[kPoseNumbers] = {x.x(), x.y(), x.z(), turn.w(), turn.x(), turn.y(), turn.z()};
    std::copy(std::begin(numbers), std::end(numbers),
              poses_.begin() + static_cast<std::ptrdiff_t>(kPoseNumbers * b));
  }
  return poses_;
}

}  // namespace kinemark::server
