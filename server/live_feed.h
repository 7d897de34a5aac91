// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/live/live_recorder.h"
#include "kinemark/stream/stream.h"
#include "server/live_clock.h"
#include "server/live_viewer.h"

namespace kinemark::server {

/// Frames on their way from one thread to another, in order.
class FrameQueue {
 public:
  using FramePtr = std::shared_ptr<const stream::Frame>;
  /// @param most  that wait; beyond, the oldest is dropped and counted. 0: none is ever dropped
  explicit FrameQueue(std::size_t most) : most_(most) {}
  void push(FramePtr frame);                   ///< never waits
  void finish();                               ///< no more come
  [[nodiscard]] FramePtr pop();                ///< waits; nullptr: that was all
  [[nodiscard]] std::int64_t dropped() const;  ///< how many

 private:
  std::size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FramePtr> waiting_;
  std::int64_t dropped_ = 0;
  bool finished_ = false;
};

/// A sink that takes its frames on a thread of its own, so that it holds nobody back. A failure is said once,
/// and frames that come after it are passed over.
class SinkThread {
 public:
  /// @param most  as of FrameQueue  @param failed  gets the error, on that thread
  SinkThread(std::unique_ptr<stream::Sink> sink, std::size_t most, std::function<void(const Error&)> failed);
  ~SinkThread();                          ///< what was pushed is taken before it returns
  void push(FrameQueue::FramePtr frame);  ///< never waits; not after finish()
  void finish();                          ///< no more frames come; what waits is taken still
  void join();                            ///< waits until all is taken, after finish()
  [[nodiscard]] std::int64_t dropped() const { return queue_.dropped(); }  ///< frames that it did not get

 private:
  void run();
  std::unique_ptr<stream::Sink> sink_;
  FrameQueue queue_;
  std::function<void(const Error&)> failed_;
  std::thread thread_;
};

/// What is fed, and what becomes of it.
struct LiveFeedOptions {
  std::unique_ptr<stream::Source> source;     ///< never nullptr
  std::shared_ptr<const model::Model> model;  ///< whose angles are wanted; may be absent
  motion::TrackOptions track;                 ///< how it follows: its levels and its stiffness
  std::filesystem::path record;               ///< file that keeps every frame; empty: none
  bool force = false;                         ///< replace that file
  LiveLimits limits;                          ///< of each viewer
  std::size_t most_viewers = 16;              ///< at once
  std::shared_ptr<LiveClock> clock;           ///< by which frames come
  std::function<void(std::string_view)> say;  ///< what people should know; called by threads of the feed
};

/// How it goes.
struct LiveState {
  std::int64_t frames = 0;                ///< that came so far
  std::optional<std::int64_t> of_frames;  ///< that the source has; nothing: nobody knows
  bool ended = false;                     ///< no more come
  std::int64_t recorded = 0;              ///< frames that a stop of this program cannot lose
  std::int64_t unsolved = 0;              ///< frames whose angles were given up, as there was no time
  std::vector<LiveViewerState> viewers;   ///< those of this moment
};

/// Frames of a source when they are due, to whoever views them, on a thread of its own. Another thread
/// records, and never leaves a frame out; a third follows the model. Neither they nor viewers hold frames
/// back. Memory: the frames that wait.
class LiveFeed {
 public:
  /// Make the recording and the tracker. Fails as LiveRecorder::create() and workflow::live().
  [[nodiscard]] static Result<std::unique_ptr<LiveFeed>> create(LiveFeedOptions options);
  LiveFeed(const LiveFeed&) = delete;
  LiveFeed& operator=(const LiveFeed&) = delete;
  /// Ends the feed: what came is recorded, viewers are sent home.
  ~LiveFeed();

  /// The first frame is due now. To be called once.
  void start();
  /// From here on it gets messages; nullptr when there are too many viewers.
  [[nodiscard]] std::shared_ptr<LiveViewer> add_viewer();
  [[nodiscard]] LiveState state();
  /// Until no more frames come and all are recorded and followed.
  void wait();

 private:
  explicit LiveFeed(LiveFeedOptions options) : options_(std::move(options)) {}
  /// A sink whose failure viewers hear of: "WHAT: error".
  [[nodiscard]] std::unique_ptr<SinkThread> on_thread(std::unique_ptr<stream::Sink> sink, std::size_t most,
                                                      std::string what);
  void feed();
  /// Frames one by one until the last (why it ends), or until the server ends (nothing).
  [[nodiscard]] std::optional<std::string> feed_all();
  void finish_sinks();
  void send(std::string message, LiveKind kind, double due_s);
  void tell(const std::string& sentence);
  void finish_viewers(const std::string& sentence);
  /// Those that are there, called with mutex_ held.
  [[nodiscard]] std::vector<std::shared_ptr<LiveViewer>> living();
  [[nodiscard]] double due_s(std::int64_t frame) const;

  LiveFeedOptions options_;
  double start_s_ = 0.0;
  std::uint64_t start_ns_ = 0;  ///< since 1970
  std::atomic<std::int64_t> frames_ = 0;
  std::mutex mutex_;                                ///< of what follows
  std::vector<std::weak_ptr<LiveViewer>> viewers_;  ///< their connections hold them
  std::optional<std::string> ended_;
  // The threads last: they end before what they use does.
  pipeline::LiveRecorder* kept_by_ = nullptr;  ///< the sink of recorder_
  std::unique_ptr<SinkThread> recorder_, follower_;
  std::shared_ptr<LivePush> push_;  ///< of the model's body; nullptr without one
  std::thread feeder_;
};

}  // namespace kinemark::server
