// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
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
#include "server/sink_thread.h"

namespace kinemark::server {

/// What is fed, and what becomes of it.
struct LiveFeedOptions {
  std::unique_ptr<stream::Source> source;     ///< never nullptr
  std::shared_ptr<const model::Model> model;  ///< whose angles are wanted; may be absent
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
  std::thread feeder_;
};

}  // namespace kinemark::server
