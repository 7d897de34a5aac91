// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_viewer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kinemark::server {

void Durations::add(double duration_s) {
  const double steps = std::clamp(duration_s / kStep_s, 0.0, static_cast<double>(bins_.size() - 1));
  ++bins_[static_cast<std::size_t>(steps)];
  ++count_;
  longest_s_ = std::max(longest_s_, duration_s);
}

double Durations::share_ms(double share) const {
  const double wanted = share * static_cast<double>(count_);
  double seen = 0.0;
  for (std::size_t i = 0; i + 1 < bins_.size(); ++i) {
    seen += bins_[i];
    if (seen >= wanted && seen > 0.0)
      return std::min(1e3 * kStep_s * static_cast<double>(i + 1), longest_ms());
  }
  return longest_ms();
}

LiveViewer::LiveViewer(const LiveLimits& limits, std::shared_ptr<LiveClock> clock)
    : limits_(limits), clock_(std::move(clock)), answer_s_(std::numeric_limits<float>::quiet_NaN()) {}

void LiveViewer::drop_beyond_limit(LiveKind kind) {
  // What people should know is not dropped: there are few of those. Each kind has room of its own, so that
  // angles, which come late, do not push out the newest markers.
  if (kind == LiveKind::sentence) return;
  const auto is_that = [kind](const Waiting& one) { return one.kind == kind; };
  if (std::cmp_less_equal(std::ranges::count_if(waiting_, is_that), limits_.waiting)) return;
  ++dropped_[static_cast<std::size_t>(kind)];
  waiting_.erase(std::ranges::find_if(waiting_, is_that));
}

void LiveViewer::offer(std::shared_ptr<const std::string> message, LiveKind kind, double due_s) {
  const std::scoped_lock lock(mutex_);
  if (gone_ || finished_) return;
  waiting_.push_back({std::move(message), kind, due_s});
  drop_beyond_limit(kind);
  if (wake_) wake_();
}

void LiveViewer::finish(std::string sentence) {
  const std::scoped_lock lock(mutex_);
  if (!finished_) finished_ = std::move(sentence);
  if (wake_) wake_();
}

bool LiveViewer::gone() const {
  const std::scoped_lock lock(mutex_);
  return gone_;
}

LiveViewerState LiveViewer::state() const {
  const std::scoped_lock lock(mutex_);
  return {.sent = sent_,
          .dropped = dropped_[static_cast<std::size_t>(LiveKind::markers)],
          .dropped_angles = dropped_[static_cast<std::size_t>(LiveKind::angles)],
          .half_ms = to_socket_.share_ms(0.5),
          .most_ms = to_socket_.share_ms(0.99),
          .longest_ms = to_socket_.longest_ms()};
}

void LiveViewer::opened(std::function<void()> wake) {
  const std::scoped_lock lock(mutex_);
  wake_ = std::move(wake);
}

std::size_t LiveViewer::most_under_way(double now_s) {
  while (!drawn_lately_.empty() && now_s - drawn_lately_.front().time_s > limits_.ahead_s)
    drawn_lately_.pop_front();
  std::size_t drawn = 0;
  for (const auto& one : drawn_lately_) drawn += one.count;
  return std::min(limits_.under_way, limits_.at_first + drawn + drawn / 4);
}

bool LiveViewer::is_behind() {
  const double now_s = clock_->now_s();
  return under_way_.size() >= most_under_way(now_s) ||
         (!under_way_.empty() && now_s - under_way_.front().given_s > limits_.ahead_s);
}

std::shared_ptr<const std::string> LiveViewer::next() {
  const std::scoped_lock lock(mutex_);
  if (waiting_.empty() || is_behind()) return nullptr;
  auto [message, kind, due_s] = std::move(waiting_.front());
  waiting_.pop_front();
  // Angles come late by design, which is no delay of the connection.
  saying_due_s_ = kind == LiveKind::markers ? due_s : std::numeric_limits<double>::quiet_NaN();
  under_way_.push_back({.due_s = saying_due_s_, .given_s = clock_->now_s()});
  auto own = std::make_shared<std::string>(*message);
  set_viewer_fields(*own, dropped_[static_cast<std::size_t>(kind)], answer_s_);
  return own;
}

void LiveViewer::sent() {
  const double now_s = clock_->now_s();
  const std::scoped_lock lock(mutex_);
  ++sent_;
  if (!std::isnan(saying_due_s_)) to_socket_.add(now_s - saying_due_s_);
}

std::optional<SocketEnd> LiveViewer::end() {
  const std::scoped_lock lock(mutex_);
  if (!finished_ || !waiting_.empty() || !under_way_.empty()) return std::nullopt;
  return SocketEnd{.code = 1000, .reason = finished_->substr(0, 120)};
}

bool LiveViewer::heard(std::string_view bytes) {
  const double now_s = clock_->now_s();
  const auto drawn = drawn_count(bytes);
  const std::scoped_lock lock(mutex_);
  if (!drawn || *drawn < drawn_ || *drawn - drawn_ > under_way_.size()) return false;
  if (*drawn > drawn_)
    drawn_lately_.push_back({.time_s = now_s, .count = static_cast<std::size_t>(*drawn - drawn_)});
  for (; drawn_ < *drawn; ++drawn_) {
    const double due_s = under_way_.front().due_s;
    if (!std::isnan(due_s)) answer_s_ = static_cast<float>(now_s - due_s);
    under_way_.pop_front();
  }
  return true;
}

void LiveViewer::closed() {
  const std::scoped_lock lock(mutex_);
  gone_ = true;
  wake_ = nullptr;
  waiting_.clear();
}

}  // namespace kinemark::server
