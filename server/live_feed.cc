// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_feed.h"

#include <fmt/core.h>

#include <chrono>
#include <utility>

#include "kinemark/core/counted.h"

namespace kinemark::server {
namespace {

constexpr double kPatience_s = 0.5;  // for the tracker: what waits longer is given up

}  // namespace

void LiveQueue::push(std::int64_t frame) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(frame);
    if (most_ > 0 && waiting_.size() > most_) {
      waiting_.pop_front();
      ++dropped_;
    }
  }
  changed_.notify_one();
}

void LiveQueue::finish() {
  {
    const std::scoped_lock lock(mutex_);
    finished_ = true;
  }
  changed_.notify_all();
}

std::optional<std::int64_t> LiveQueue::pop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return finished_ || !waiting_.empty(); });
  if (waiting_.empty()) return std::nullopt;
  const auto frame = waiting_.front();
  waiting_.pop_front();
  return frame;
}

std::int64_t LiveQueue::dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

Result<std::unique_ptr<LiveFeed>> LiveFeed::create(LiveFeedOptions options) {
  std::optional<pipeline::LiveAngles> angles;
  if (options.source.model) {
    auto made = pipeline::LiveAngles::create(options.source);
    if (!made) return std::unexpected(made.error());
    angles.emplace(std::move(*made));
  }
  std::optional<io::MarkersWriter> writer;
  if (!options.record.empty()) {
    const auto& markers = options.source.markers;
    auto made = io::MarkersWriter::create(options.record,
                                          {.names = markers.names,
                                           .rate_hz = markers.time.rate_hz,
                                           .t0_s = markers.time.t0_s,
                                           .source = options.source.name},
                                          {.force = options.force});
    if (!made) return std::unexpected(made.error());
    writer.emplace(std::move(*made));
  }
  return std::unique_ptr<LiveFeed>(new LiveFeed(std::move(options), std::move(writer), std::move(angles)));
}

LiveFeed::LiveFeed(LiveFeedOptions options, std::optional<io::MarkersWriter> writer,
                   std::optional<pipeline::LiveAngles> angles)
    : options_(std::move(options)),
      writer_(std::move(writer)),
      angles_(std::move(angles)),
      to_follow_(1 + static_cast<std::size_t>(kPatience_s * options_.source.markers.time.rate_hz)) {}

LiveFeed::~LiveFeed() {
  options_.clock->stop();
  wait();
  finish_viewers("the server ends");
}

void LiveFeed::start() {
  start_s_ = options_.clock->now_s();
  start_ns_ = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                             std::chrono::system_clock::now().time_since_epoch())
                                             .count());
  if (writer_) recorder_ = std::thread([this] { record(); });
  if (angles_) follower_ = std::thread([this] { follow(); });
  feeder_ = std::thread([this] { feed(); });
}

void LiveFeed::wait() {
  for (auto* thread : {&feeder_, &recorder_, &follower_})
    if (thread->joinable()) thread->join();
}

std::span<const double> LiveFeed::x_of(std::int64_t frame) const {
  const auto& markers = options_.source.markers;
  return std::span(markers.x_in_world).subspan(3 * markers.index(frame, 0), 3 * markers.names.size());
}

std::span<const data::SampleState> LiveFeed::state_of(std::int64_t frame) const {
  const auto& markers = options_.source.markers;
  return std::span(markers.state).subspan(markers.index(frame, 0), markers.names.size());
}

double LiveFeed::due_s(std::int64_t frame) const {
  return start_s_ + static_cast<double>(frame) / options_.source.markers.time.rate_hz;
}

void LiveFeed::feed() {
  const auto& markers = options_.source.markers;
  std::int64_t f = 0;
  for (; f < markers.frames() && options_.clock->sleep_until(due_s(f)); ++f) {
    if (writer_) to_record_.push(f);
    if (angles_) to_follow_.push(f);
    send(markers_message(f, markers.time.time_s(f), due_s(f), x_of(f), state_of(f)), LiveKind::markers,
         due_s(f));
    frames_ = f + 1;
  }
  to_record_.finish();
  to_follow_.finish();
  if (f < markers.frames()) return;  // the server ends
  if (recorder_.joinable()) recorder_.join();
  if (follower_.joinable()) follower_.join();
  const auto sentence = fmt::format("the source has ended after {}", counted(f, "frame"));
  options_.say(
      writer_ ? fmt::format("{}; {} recorded in {}", sentence, recorded_.load(), options_.record.string())
              : sentence);
  finish_viewers(sentence);
}

void LiveFeed::record() {
  const double ns_per_frame = 1e9 / options_.source.markers.time.rate_hz;
  Status status;
  while (const auto f = to_record_.pop()) {
    if (!status) continue;
    const auto ns = start_ns_ + static_cast<std::uint64_t>(ns_per_frame * static_cast<double>(*f));
    status = writer_->push({.frame = *f, .log_time_ns = ns, .x_in_world = x_of(*f), .state = state_of(*f)});
    recorded_ = writer_->acknowledged();
    if (!status) tell(fmt::format("the recording ends: {}", status.error().message));
  }
  if (!status) return;
  if (auto s = writer_->close(); !s) tell(fmt::format("the recording is not closed: {}", s.error().message));
}

void LiveFeed::follow() {
  const auto& time = options_.source.markers.time;
  Status status;
  const auto send_ready = [this, &status] {
    while (status) {
      const auto angles = angles_->next();
      if (!angles) status = std::unexpected(angles.error());
      if (!angles || *angles == nullptr) return;
      const double when_s = due_s((*angles)->frame);
      send(angles_message(**angles, when_s), LiveKind::angles, when_s);
    }
  };
  while (const auto f = to_follow_.pop()) {
    if (!status) continue;
    status = angles_->push(time.time_s(*f), x_of(*f));
    send_ready();
    if (!status) tell(fmt::format("angles end: {}", status.error().message));
  }
  if (!status) return;
  angles_->finish();
  send_ready();
}

void LiveFeed::send(std::string message, LiveKind kind, double due_s) {
  const auto shared = std::make_shared<const std::string>(std::move(message));
  const std::scoped_lock lock(mutex_);
  for (const auto& viewer : living()) viewer->offer(shared, kind, due_s);
}

void LiveFeed::tell(const std::string& sentence) {
  options_.say(sentence);
  send(sentence_message(sentence, options_.clock->now_s()), LiveKind::sentence, options_.clock->now_s());
}

void LiveFeed::finish_viewers(const std::string& sentence) {
  const std::scoped_lock lock(mutex_);
  if (!ended_) ended_ = sentence;
  for (const auto& viewer : living()) viewer->finish(sentence);
}

std::vector<std::shared_ptr<LiveViewer>> LiveFeed::living() {
  std::vector<std::shared_ptr<LiveViewer>> out;
  std::erase_if(viewers_, [&out](const auto& one) {
    auto viewer = one.lock();
    if (!viewer || viewer->gone()) return true;
    out.push_back(std::move(viewer));
    return false;
  });
  return out;
}

std::shared_ptr<LiveViewer> LiveFeed::add_viewer() {
  const std::scoped_lock lock(mutex_);
  if (living().size() >= options_.most_viewers) return nullptr;
  auto viewer = std::make_shared<LiveViewer>(options_.limits, options_.clock);
  if (ended_) viewer->finish(*ended_);
  viewers_.push_back(viewer);
  return viewer;
}

LiveState LiveFeed::state() {
  LiveState out{.frames = frames_,
                .of_frames = options_.source.markers.frames(),
                .recorded = recorded_,
                .unsolved = to_follow_.dropped()};
  const std::scoped_lock lock(mutex_);
  out.ended = ended_.has_value();
  for (const auto& viewer : living()) out.viewers.push_back(viewer->state());
  return out;
}

}  // namespace kinemark::server
