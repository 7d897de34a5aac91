// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_viewer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"

namespace kinemark::server {
namespace {

constexpr std::uint8_t kLiveVersion = 1;
constexpr std::size_t kDroppedAt = 4, kAnswerAt = 32;
constexpr double kMmPerM = 1e3;
constexpr double kMostCounted = 9e15;  // whole numbers that a float64 holds

template <class Bits>
void set_bits(std::string& out, std::size_t at, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) out[at + i] = static_cast<char>(bits >> (8 * i) & 0xFFU);
}

template <class Bits>
void put_bits(std::string& out, Bits bits) {
  out.resize(out.size() + sizeof(Bits));
  set_bits(out, out.size() - sizeof(Bits), bits);
}

void put(std::string& out, double value) { put_bits(out, std::bit_cast<std::uint64_t>(value)); }
void put(std::string& out, float value) { put_bits(out, std::bit_cast<std::uint32_t>(value)); }

std::string head(LiveKind kind, std::size_t count, double frame, double time_s, double due_s,
                 std::size_t body_bytes, std::uint32_t more = 0) {
  std::string out{static_cast<char>(kind), static_cast<char>(kLiveVersion)};
  out.reserve(kLiveHeadBytes + body_bytes);
  put_bits(out, static_cast<std::uint16_t>(count));
  put_bits(out, std::uint32_t{0});
  put(out, frame);
  put(out, time_s);
  put(out, due_s);
  put(out, std::numeric_limits<float>::quiet_NaN());
  put_bits(out, more);
  return out;
}

}  // namespace

std::string markers_message(std::int64_t frame, double time_s, double due_s, std::span<const double> x,
                            std::span<const data::SampleState> state) {
  auto out = head(LiveKind::markers, state.size(), static_cast<double>(frame), time_s, due_s,
                  4 * x.size() + state.size());
  for (const double value : x) put(out, static_cast<float>(value));
  for (const auto one : state) out += static_cast<char>(one);
  return out;
}

std::vector<double> message_units(const model::Model& model) {
  std::vector<double> out;
  for (const auto& coordinate : model.description().coordinates)
    out.push_back(coordinate.is_rotation ? kDegPerRad : kMmPerM);
  return out;
}

std::string angles_message(const motion::LivePose& pose, std::span<const double> units, double due_s,
                           std::span<const double> body_poses) {
  const auto count = units.size(), bodies = body_poses.size() / kPoseNumbers;
  const auto goals = body_poses.empty() ? 0 : static_cast<std::size_t>(pose.goal.cols());
  check(std::cmp_equal(pose.q.size(), count) && pose.q_sd.size() == pose.q.size() &&
            pose.determined.size() == count,
        "angles and their deviations, one of each coordinate");
  const auto more = static_cast<std::uint32_t>(bodies | goals << 16);
  auto out = head(LiveKind::angles, count, static_cast<double>(pose.frame), pose.time_s, due_s,
                  9 * count + 4 * (body_poses.size() + 3 * goals + 1), more);
  for (const auto* numbers : {&pose.q, &pose.q_sd})
    for (std::size_t c = 0; c < count; ++c)
      put(out, static_cast<float>(units[c] * (*numbers)[static_cast<Eigen::Index>(c)]));
  for (const auto one : pose.determined) out += static_cast<char>(one);
  if (body_poses.empty()) return out;
  for (const double value : body_poses) put(out, static_cast<float>(value));
  for (std::size_t i = 0; i < 3 * goals; ++i) put(out, static_cast<float>(pose.goal.data()[i]));
  put(out, static_cast<float>(pose.pushed_q.size() > 0 ? kMmPerM * pose.pushed_m : kNaN));
  return out;
}

std::string sentence_message(std::string_view sentence, double due_s) {
  sentence = sentence.substr(0, std::numeric_limits<std::uint16_t>::max());
  return head(LiveKind::sentence, sentence.size(), 0.0, 0.0, due_s, sentence.size()).append(sentence);
}

void set_viewer_fields(std::string& message, std::uint32_t dropped, float answer_s) {
  set_bits(message, kDroppedAt, dropped);
  set_bits(message, kAnswerAt, std::bit_cast<std::uint32_t>(answer_s));
}

std::optional<std::uint64_t> drawn_count(std::string_view bytes) {
  if (bytes.size() != sizeof(double)) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  const auto count = std::bit_cast<double>(bits);
  if (!(count >= 0.0 && count <= kMostCounted)) return std::nullopt;
  const auto whole = static_cast<std::uint64_t>(count);
  if (static_cast<double>(whole) != count) return std::nullopt;
  return whole;
}

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

LiveViewer::LiveViewer(const LiveLimits& limits, std::shared_ptr<LiveClock> clock,
                       std::shared_ptr<LivePush> push)
    : limits_(limits),
      clock_(std::move(clock)),
      push_(std::move(push)),
      answer_s_(std::numeric_limits<float>::quiet_NaN()) {}

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

// One sentence waits at a time: who is refused often hears it no more often than it can take.
void LiveViewer::wish(const BodyPush& push) {
  const auto refused = push_->take(this, push, clock_->now_s());
  if (refused.empty() || gone_ || finished_) return;
  if (std::ranges::any_of(waiting_, [](const auto& one) { return one.kind == LiveKind::sentence; })) return;
  waiting_.push_back({std::make_shared<const std::string>(sentence_message(refused, clock_->now_s())),
                      LiveKind::sentence, clock_->now_s()});
  if (wake_) wake_();
}

bool LiveViewer::heard(std::string_view bytes) {
  const double now_s = clock_->now_s();
  if (bytes.size() == kPushBytes) {
    const auto push = push_ ? push_->read(bytes) : std::nullopt;
    const std::scoped_lock lock(mutex_);
    if (push) wish(*push);
    return push.has_value();
  }
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
  if (push_) push_->let_go(this);
  wake_ = nullptr;
  waiting_.clear();
}

}  // namespace kinemark::server
