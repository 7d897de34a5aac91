// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/live_feed.h"

#include <fmt/core.h>

#include <chrono>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/workflow/live/live.h"

namespace kinemark::server {
namespace {

constexpr double kPatience_s = 0.5;  // for the tracker: what waits longer is given up

}  // namespace

void FrameQueue::push(FramePtr frame) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(std::move(frame));
    if (most_ > 0 && waiting_.size() > most_) {
      waiting_.pop_front();
      ++dropped_;
    }
  }
  changed_.notify_one();
}

void FrameQueue::finish() {
  {
    const std::scoped_lock lock(mutex_);
    finished_ = true;
  }
  changed_.notify_all();
}

FrameQueue::FramePtr FrameQueue::pop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return finished_ || !waiting_.empty(); });
  if (waiting_.empty()) return nullptr;
  auto frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

std::int64_t FrameQueue::dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

SinkThread::SinkThread(std::unique_ptr<stream::Sink> sink, std::size_t most,
                       std::function<void(const Error&)> failed)
    : sink_(std::move(sink)), queue_(most), failed_(std::move(failed)), thread_([this] { run(); }) {}

SinkThread::~SinkThread() {
  finish();
  join();
}

void SinkThread::push(FrameQueue::FramePtr frame) { queue_.push(std::move(frame)); }

void SinkThread::finish() { queue_.finish(); }

void SinkThread::join() {
  if (thread_.joinable()) thread_.join();
}

void SinkThread::run() {
  Status status;
  while (const auto frame = queue_.pop()) {
    if (!status) continue;
    status = sink_->push(*frame);
    if (!status) failed_(status.error());
  }
  if (!status) return;
  if (auto s = sink_->finish(); !s) failed_(s.error());
}

Result<std::unique_ptr<LiveFeed>> LiveFeed::create(LiveFeedOptions options) {
  std::unique_ptr<LiveFeed> feed(new LiveFeed(std::move(options)));
  const auto& given = feed->options_;
  const auto& facts = given.source->facts();
  std::unique_ptr<stream::Sink> angles;
  if (given.model) {
    const auto to_viewers = [self = feed.get(), units = message_units(*given.model),
                             body_poses = std::make_shared<BodyPoses>(given.model)](const auto& pose) {
      const double when_s = self->due_s(pose.frame);
      self->send(angles_message(pose, units, when_s, body_poses->find(pose)), LiveKind::angles, when_s);
    };
    auto made = workflow::live(*given.model, facts, to_viewers, given.track);
    if (!made) return std::unexpected(made.error());
    feed->push_ = std::make_shared<LivePush>(given.model->bodies().size());
    angles = std::make_unique<PushedAngles>(std::move(*made), feed->push_, given.clock);
  }
  if (!given.record.empty()) {
    auto made = pipeline::LiveRecorder::create(given.record, facts, given.force);
    if (!made) return std::unexpected(made.error());
    feed->kept_by_ = made->get();
    feed->recorder_ = feed->on_thread(std::move(*made), 0, "the recording ends");
  }
  if (angles)
    feed->follower_ = feed->on_thread(
        std::move(angles), 1 + static_cast<std::size_t>(kPatience_s * facts.rate_hz), "angles end");
  return feed;
}

std::unique_ptr<SinkThread> LiveFeed::on_thread(std::unique_ptr<stream::Sink> sink, std::size_t most,
                                                std::string what) {
  return std::make_unique<SinkThread>(std::move(sink), most,
                                      [this, what = std::move(what)](const Error& error) {
                                        tell(fmt::format("{}: {}", what, error.message));
                                      });
}

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
  feeder_ = std::thread([this] { feed(); });
}

void LiveFeed::wait() {
  if (feeder_.joinable()) feeder_.join();
  finish_sinks();
}

void LiveFeed::finish_sinks() {
  for (auto* sink : {recorder_.get(), follower_.get()})
    if (sink != nullptr) sink->finish();
  for (auto* sink : {recorder_.get(), follower_.get()})
    if (sink != nullptr) sink->join();
}

double LiveFeed::due_s(std::int64_t frame) const {
  return start_s_ + static_cast<double>(frame) / options_.source->facts().rate_hz;
}

void LiveFeed::feed() {
  const auto sentence = feed_all();
  finish_sinks();
  if (!sentence) return;
  options_.say(kept_by_ != nullptr ? fmt::format("{}; {} recorded in {}", *sentence, kept_by_->kept(),
                                                 options_.record.string())
                                   : *sentence);
  finish_viewers(*sentence);
}

std::optional<std::string> LiveFeed::feed_all() {
  const double ns_per_frame = 1e9 / options_.source->facts().rate_hz;
  for (;;) {
    const auto frame = std::make_shared<stream::Frame>();
    const auto more = options_.source->next(*frame);
    if (!more)
      return fmt::format("the source has failed after {}: {}", counted(frames_, "frame"),
                         more.error().message);
    if (!*more) return fmt::format("the source has ended after {}", counted(frames_, "frame"));
    const double due = due_s(frame->number);
    if (!options_.clock->sleep_until(due)) return std::nullopt;
    frame->came_ns =
        start_ns_ + static_cast<std::uint64_t>(ns_per_frame * static_cast<double>(frame->number));
    for (auto* sink : {recorder_.get(), follower_.get()})
      if (sink != nullptr) sink->push(frame);
    send(markers_message(frame->number, frame->time_s, due, frame->x_in_world, frame->state),
         LiveKind::markers, due);
    ++frames_;
  }
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
  auto viewer = std::make_shared<LiveViewer>(options_.limits, options_.clock, push_);
  if (ended_) viewer->finish(*ended_);
  viewers_.push_back(viewer);
  return viewer;
}

LiveState LiveFeed::state() {
  LiveState out{.frames = frames_,
                .of_frames = options_.source->facts().frames,
                .recorded = kept_by_ != nullptr ? kept_by_->kept() : 0,
                .unsolved = follower_ ? follower_->dropped() : 0};
  const std::scoped_lock lock(mutex_);
  out.ended = ended_.has_value();
  for (const auto& viewer : living()) out.viewers.push_back(viewer->state());
  return out;
}

}  // namespace kinemark::server
