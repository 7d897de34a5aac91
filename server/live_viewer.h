// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What waits for one viewer of a live source: messages as bytes, little end first, which the viewer reads in
// live/message.ts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/model/model.h"
#include "kinemark/workflow/live/live.h"
#include "server/live_clock.h"
#include "server/live_push.h"
#include "server/socket_peer.h"

namespace kinemark::server {

/// What a message holds behind its head.
enum class LiveKind : std::uint8_t {
  markers = 1,   ///< float32 x[count][3] in m, NaN where there is none; uint8 state[count]
  angles = 2,    ///< float32 value[count], float32 sd[count] in deg or mm; uint8 determined[count]; with
                 ///< bodies: float32 pose[bodies][7], origin in m and quaternion w x y z, float32
                 ///< goal[goals][3] in m, NaN where there is none, float32 pushed_mm, NaN: nobody pushes. The
                 ///< angles are those of the tracked body; the poses those of the pushed one while there is
                 ///< one
  sentence = 3,  ///< count bytes of UTF-8
};

/// Bytes of the head: uint8 kind, uint8 version (1), uint16 count, uint32 dropped, float64 frame, float64
/// time_s, float64 due_s, float32 answer_s, uint16 bodies, uint16 goals (of angles, else 0). `dropped`:
/// messages of this kind that this viewer did not get so far; `due_s`: when the frame was due, by the steady
/// clock of the server's machine; `answer_s`: how long after its due time the last message was known to be
/// drawn, NaN where that is not known.
inline constexpr std::size_t kLiveHeadBytes = 40;

/// A frame of markers. @param x M x 3, m  @param state M
[[nodiscard]] std::string markers_message(std::int64_t frame, double time_s, double due_s,
                                          std::span<const double> x,
                                          std::span<const data::SampleState> state);
/// By what each coordinate of a model is multiplied in messages: degrees of a radian, millimetres of a metre.
[[nodiscard]] std::vector<double> message_units(const model::Model& model);
/// Angles of a frame. @param pose  of workflow::live()  @param units  of its coordinates
/// @param body_poses  7 numbers of each body, as LiveKind::angles; empty: they are not shown
[[nodiscard]] std::string angles_message(const motion::LivePose& pose, std::span<const double> units,
                                         double due_s, std::span<const double> body_poses = {});
/// Something that people should know; more than 65,535 bytes are cut off.
[[nodiscard]] std::string sentence_message(std::string_view sentence, double due_s);

/// Write into a message what differs between viewers.
void set_viewer_fields(std::string& message, std::uint32_t dropped, float answer_s);

/// What a viewer says: how many messages of this connection it has drawn, a float64; nothing for anything
/// else.
[[nodiscard]] std::optional<std::uint64_t> drawn_count(std::string_view bytes);

/// What one viewer can hold back.
struct LiveLimits {
  std::size_t waiting =
      16;  ///< messages of a kind that wait for it: beyond, the oldest is dropped and counted
  std::size_t under_way = 64;  ///< messages that were sent and not yet drawn: beyond, none is sent
  double ahead_s = 0.3;        ///< none is sent either while one that was given so long ago is not drawn
  std::size_t at_first = 4;    ///< messages under way of who has drawn none for that long
};

/// How often each duration occurred, in steps of 50 us up to 100 ms; all that is longer is one.
class Durations {
 public:
  void add(double duration_s);  ///< one more
  [[nodiscard]] double share_ms(
      double share) const;  ///< ms within which that share was, rounded up; 0 of none
  [[nodiscard]] double longest_ms() const { return 1e3 * longest_s_; }  ///< 0 of none
  [[nodiscard]] std::int64_t count() const { return count_; }           ///< how many

 private:
  static constexpr double kStep_s = 50e-6;
  std::array<std::uint32_t, 2001> bins_{};
  std::int64_t count_ = 0;
  double longest_s_ = 0.0;
};

/// How a viewer fares.
struct LiveViewerState {
  std::int64_t sent = 0;            ///< messages that are with the system
  std::int64_t dropped = 0;         ///< frames of markers that it did not get
  std::int64_t dropped_angles = 0;  ///< frames of angles that it did not get
  /// From when a frame of markers is due until the system has it: 50 %, 99 %, all.
  double half_ms = 0.0, most_ms = 0.0, longest_ms = 0.0;
};

/// One viewer of a live source: messages wait here until its connection takes them. Who is slow loses the
/// oldest ones, and holds nobody else back. Threads may call at once.
class LiveViewer final : public SocketPeer {
 public:
  /// @param push  what it may push; nullptr: there is no body
  LiveViewer(const LiveLimits& limits, std::shared_ptr<LiveClock> clock,
             std::shared_ptr<LivePush> push = nullptr);

  /// A message, of which this viewer gets its own head. Never waits.
  void offer(std::shared_ptr<const std::string> message, LiveKind kind, double due_s);
  /// No more messages come; when all are drawn the connection ends with that sentence.
  void finish(std::string sentence);
  [[nodiscard]] bool gone() const;              ///< whether its connection is over
  [[nodiscard]] LiveViewerState state() const;  ///< how it fares

  void opened(std::function<void()> wake) override;
  [[nodiscard]] std::shared_ptr<const std::string> next() override;
  void sent() override;
  [[nodiscard]] std::optional<SocketEnd> end() override;
  [[nodiscard]] bool heard(std::string_view bytes) override;
  void closed() override;

 private:
  struct Waiting {
    std::shared_ptr<const std::string> message;
    LiveKind kind;
    double due_s;
  };
  /// A message that was given to the connection and is not drawn; due_s is NaN of what is no frame of
  /// markers.
  struct UnderWay {
    double due_s, given_s;
  };
  void drop_beyond_limit(LiveKind kind);
  /// A wish to push, and its answer: a sentence where it is refused. Called with mutex_ held.
  void wish(const BodyPush& push);
  [[nodiscard]] bool is_behind();
  /// Messages that may be under way: a quarter more than were drawn within ahead_s. So many wait in the
  /// network for a viewer as it takes in that time, however slow it is.
  [[nodiscard]] std::size_t most_under_way(double now_s);

  LiveLimits limits_;
  std::shared_ptr<LiveClock> clock_;
  mutable std::mutex mutex_;
  std::function<void()> wake_;
  std::deque<Waiting> waiting_;
  std::deque<UnderWay> under_way_;
  double saying_due_s_ = 0.0;
  /// How many were drawn, and when; of the last ahead_s.
  struct Drawn {
    double time_s;
    std::size_t count;
  };
  std::deque<Drawn> drawn_lately_;
  std::uint64_t drawn_ = 0;
  std::int64_t sent_ = 0;
  std::shared_ptr<LivePush> push_;
  std::array<std::uint32_t, 4> dropped_{};  ///< by kind
  float answer_s_;
  Durations to_socket_;
  std::optional<std::string> finished_;
  bool gone_ = false;
};

}  // namespace kinemark::server
