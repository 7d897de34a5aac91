// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/stream_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/motion/internal/start.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kFirstLesson_s = 0.5, kWindow_s = 4.0;
constexpr std::int64_t kFewest = 30;           // frames, to learn from
constexpr std::int64_t kStreamHeldFrames = 3;  // as in recordings
constexpr double kStreamHeldTravel_m = 2e-3;

Problem with_frames(Problem problem, std::int64_t frames) {
  problem.first_frame = 0;
  problem.frames = frames;
  return problem;
}

}  // namespace

StreamJudge::StreamJudge(const Problem& problem, const IkOptions& options, double rate_hz)
    : problem_(with_frames(problem, 0)),
      options_(options),
      rate_hz_(rate_hz),
      capacity_(std::max<std::int64_t>(2 * kFewest, std::llround(kWindow_s * rate_hz))),
      learn_at_(std::max<std::int64_t>(kFewest, std::llround(kFirstLesson_s * rate_hz))),
      solver_(problem_, options),
      x_(problem.model.default_state()) {
  const int M = problem.model.marker_count();
  window_.states.setZero(problem.model.state_count(), capacity_);
  window_.positions.assign(at(3 * capacity_ * M), std::numeric_limits<float>::quiet_NaN());
  window_.status.assign(at(capacity_), data::FrameStatus::no_markers);
  window_.cost.assign(at(capacity_), 0.0);
  position_.assign(at(3 * M), std::numeric_limits<float>::quiet_NaN());
  out_.assign(at(M), 0);
  held_.setConstant(3, M, kNaN);
  begun_.setZero(3, M);
  repeats_.assign(at(M), 0);
}

void StreamJudge::keep_frame(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, double cost,
                             bool converged) {
  const auto& w = solver_.workspace();
  const Eigen::Index M = weight.size();
  const std::int64_t column = frames_ % capacity_;
  for (Eigen::Index m = 0; m < M; ++m) {
    Eigen::Map<Eigen::Vector3f> position(position_.data() + 3 * m);
    const int body = problem_.model.markers()[at(m)].body;
    if (weight[m] == 0.0)
      position.setConstant(std::numeric_limits<float>::quiet_NaN());
    else if (body < 0)
      position = y.col(m).cast<float>();
    else
      position = (w.rotation[at(body)].transpose() * (y.col(m) - w.position[at(body)])).cast<float>();
  }
  std::ranges::copy(position_, window_.positions.data() + 3 * column * M);
  window_.states.col(column) = x_;
  window_.cost[at(column)] = cost;
  window_.status[at(column)] = !(weight.maxCoeff() > 0.0) ? data::FrameStatus::no_markers
                               : converged                ? data::FrameStatus::converged
                                                          : data::FrameStatus::not_converged;
  ++frames_;
}

void StreamJudge::learn() {
  const Eigen::Index M = problem_.model.marker_count();
  const std::int64_t count = std::min(frames_, capacity_);
  problem_.frames = count;
  ordered_.states.resize(window_.states.rows(), count);
  ordered_.positions.resize(at(3 * count * M));
  ordered_.status.resize(at(count));
  ordered_.cost.resize(at(count));
  for (std::int64_t f = 0; f < count; ++f) {
    const std::int64_t column = (frames_ - count + f) % capacity_;
    ordered_.states.col(f) = window_.states.col(column);
    std::copy_n(window_.positions.data() + 3 * column * M, 3 * M, ordered_.positions.data() + 3 * f * M);
    ordered_.status[at(f)] = window_.status[at(column)];
    ordered_.cost[at(f)] = window_.cost[at(column)];
  }
  scale_.emplace(problem_, ordered_);
  scale_->learn_growth();
}

void StreamJudge::drop_held(const Eigen::Matrix3Xd& y, Eigen::VectorXd& weight) {
  const auto& marker = solver_.workspace().marker;  // in the frame before
  for (Eigen::Index m = 0; m < weight.size(); ++m) {
    if (weight[m] == 0.0 || y.col(m) != held_.col(m)) {
      held_.col(m) =
          weight[m] == 0.0 ? Eigen::Vector3d(Eigen::Vector3d::Constant(kNaN)) : Eigen::Vector3d(y.col(m));
      repeats_[at(m)] = 1;
      continue;
    }
    if (++repeats_[at(m)] == 2) begun_.col(m) = marker.col(m);
    if (repeats_[at(m)] < kStreamHeldFrames || (marker.col(m) - begun_.col(m)).norm() <= kStreamHeldTravel_m)
      continue;
    weight[m] = 0.0;
    out_[at(m)] = 1;
  }
}

void StreamJudge::judge(Eigen::Matrix3Xd& y, Eigen::VectorXd& weight) {
  std::ranges::fill(out_, std::uint8_t{0});
  if (frames_ > 0) drop_held(y, weight);
  before_ = x_;
  FrameSolver::Outcome outcome;
  if (weight.maxCoeff() > 0.0) {
    outcome = frames_ == 0 ? find_start(problem_, options_, solver_, y, weight, 0, options_.starts, x_)
                           : solver_.solve(y, weight, 0, x_);
    solver_.square_cost(y, weight, 0, x_);  // the workspace holds x_
  }
  const JudgedFrame frame{
      .index = frames_, .y = &y, .seen = &weight, .state = x_.data(), .position = position_.data()};
  keep_frame(y, weight, outcome.cost, outcome.converged);
  if (judge_) {
    judge_->judge(frame);
    judge_->forget();
    bool any = false;
    for (Eigen::Index m = 0; m < weight.size(); ++m) {
      if (!judge_->out()[at(m)]) continue;
      y.col(m) = judge_->expected().col(m);
      out_[at(m)] = 1;
      any = true;
    }
    if (any) x_ = judge_->x();
  }
  if (frames_ < learn_at_) return;
  learn_at_ = std::min(2 * learn_at_, learn_at_ + capacity_);
  learn();
  if (judge_) return;
  judge_.emplace(problem_, options_, rate_hz_, *scale_);
  judge_->begin(frame, frame.index > 0 ? &before_ : nullptr, 1);
}

}  // namespace kinemark::motion::internal
