// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/markers_recording.h"
#include "kinemark/pipeline/live/live_angles.h"
#include "kinemark/pipeline/live/live_source.h"
#include "server/live_clock.h"
#include "server/live_viewer.h"

namespace kinemark::server {

/// Frames on their way from one thread to another, by number; the numbers are handed out in order.
class LiveQueue {
 public:
  /// @param most  that wait; beyond, the oldest is dropped and counted. 0: none is ever dropped
  explicit LiveQueue(std::size_t most) : most_(most) {}
  void push(std::int64_t frame);                    ///< never waits
  void finish();                                    ///< no more come
  [[nodiscard]] std::optional<std::int64_t> pop();  ///< waits; nothing: that was all
  [[nodiscard]] std::int64_t dropped() const;       ///< how many

 private:
  std::size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::int64_t> waiting_;
  std::int64_t dropped_ = 0;
  bool finished_ = false;
};

/// What is fed, and what becomes of it.
struct LiveFeedOptions {
  pipeline::LiveSource source;
  std::filesystem::path record;               ///< file that keeps every frame; empty: none
  bool force = false;                         ///< replace that file
  LiveLimits limits;                          ///< of each viewer
  std::size_t most_viewers = 16;              ///< at once
  std::shared_ptr<LiveClock> clock;           ///< by which frames come
  std::function<void(std::string_view)> say;  ///< what people should know; called by threads of the feed
};

/// How it goes.
struct LiveState {
  std::int64_t frames = 0;               ///< that came so far
  std::int64_t of_frames = 0;            ///< that the source has
  bool ended = false;                    ///< no more come
  std::int64_t recorded = 0;             ///< frames that a stop of this program cannot lose
  std::int64_t unsolved = 0;             ///< frames whose angles were given up, as there was no time
  std::vector<LiveViewerState> viewers;  ///< those of this moment
};

/// Frames of a source when they are due, to whoever views them, on a thread of its own. Another thread
/// records, and never leaves a frame out; a third follows the model. Neither they nor viewers hold frames
/// back.
class LiveFeed {
 public:
  /// Make the recording and the tracker. Fails as MarkersWriter::create() and LiveAngles::create().
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
  LiveFeed(LiveFeedOptions options, std::optional<io::MarkersWriter> writer,
           std::optional<pipeline::LiveAngles> angles);
  void feed();
  void record();
  void follow();
  void send(std::string message, LiveKind kind, double due_s);
  void tell(const std::string& sentence);
  void finish_viewers(const std::string& sentence);
  /// Those that are there, called with mutex_ held.
  [[nodiscard]] std::vector<std::shared_ptr<LiveViewer>> living();
  [[nodiscard]] std::span<const double> x_of(std::int64_t frame) const;
  [[nodiscard]] std::span<const data::SampleState> state_of(std::int64_t frame) const;
  [[nodiscard]] double due_s(std::int64_t frame) const;

  LiveFeedOptions options_;
  std::optional<io::MarkersWriter> writer_;
  std::optional<pipeline::LiveAngles> angles_;
  double start_s_ = 0.0;
  std::uint64_t start_ns_ = 0;  ///< since 1970
  std::atomic<std::int64_t> frames_ = 0, recorded_ = 0;
  LiveQueue to_record_{0}, to_follow_;
  std::mutex mutex_;                                ///< of what follows
  std::vector<std::weak_ptr<LiveViewer>> viewers_;  ///< their connections hold them
  std::optional<std::string> ended_;
  std::thread feeder_, recorder_, follower_;
};

}  // namespace kinemark::server
