// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/recorder.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <thread>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/pipeline/acquire/recorder_notes.h"
#include "kinemark/stream/block_ring.h"

namespace kinemark::pipeline {
namespace {

using std::chrono::milliseconds;
using stream::Block;
using stream::BlockRing;
using stream::ReadResult;
using stream::RingBlock;

constexpr milliseconds kLook{100};  ///< how long a device is waited for before it is seen whether all is over
constexpr std::int64_t kMostNumber = 0xFFFFFFFF;
constexpr auto kNever_ns = std::numeric_limits<std::int64_t>::max();
constexpr int kMostGapsNoted = 1000;
constexpr double kFewestInRing = 1024;
constexpr double kSilence_s = 2.0, kSilence_frames = 3.0;  ///< after both of which a device is looked for

/// A thread that follows, with blocks that wait for it.
struct Follower {
  Follower(std::shared_ptr<BlockFollower> who, std::int64_t most_frames)
      : ring(most_frames), thread([this, who = std::move(who)] {
          RingBlock block;
          while (ring.pop(block)) who->take(block.block);
        }) {}
  ~Follower() { ring.close(); }
  BlockRing ring;
  std::jthread thread;
};

}  // namespace

std::string_view to_string(RecorderEnd end) {
  return end == RecorderEnd::complete ? "complete" : end == RecorderEnd::stopped ? "stopped" : "failed";
}

struct Recorder::State {
  State(stream::Device& device_to_read, const stream::GrantedPlan& granted, RecorderOptions asked)
      : device(device_to_read),
        plan(granted),
        options(std::move(asked)),
        speed(device_to_read.capabilities().speed),
        rate_hz(granted.layout.time.rate_hz),
        most_waiting(std::llround(std::max(kFewestInRing, options.ring_s * rate_hz * std::max(speed, 1.0)))),
        silence_ns(device_to_read.capabilities().pauses || speed == 0.0
                       ? kNever_ns
                       : std::llround(1e9 * std::max(kSilence_s, kSilence_frames / (rate_hz * speed)))),
        ring(most_waiting),
        clock_fit(rate_hz * (speed > 0.0 ? speed : 1.0)),
        levels(granted.layout),
        crosstalk(granted.layout) {}

  ~State() {
    stopping = true;
    if (reader.joinable()) reader.join();
    if (writer_thread.joinable()) writer_thread.join();
  }

  stream::Device& device;
  const stream::GrantedPlan plan;
  const RecorderOptions options;
  const double speed, rate_hz;
  const std::int64_t most_waiting, silence_ns;
  BlockRing ring;
  std::vector<std::unique_ptr<Follower>> followers;
  std::optional<io::CountsWriter> writer;

  // Of the thread that reads.
  stream::ClockFit clock_fit;
  std::int64_t first = 0;                 ///< number of the device's frame that is the recording's frame 0
  std::int64_t expected = 0;              ///< next number of the device
  RingBlock passed;                       ///< being taken in
  std::optional<std::int64_t> heard_ns;   ///< when frames came or it was found again; nothing: none came yet
  std::optional<std::int64_t> missed_ns;  ///< since when it is looked for without a frame
  std::int64_t pending_by_device = 0, pending_here = 0;  ///< lost since the last block that went on

  // Of the thread that writes.
  stream::CountCheck levels;
  stream::SlotCrosstalk crosstalk;
  int gaps_noted = 0;

  std::atomic<std::int64_t> frames = 0, received = 0, acknowledged = 0, by_device = 0, here = 0, missed = 0;
  std::atomic<int> reopened = 0;
  std::atomic<bool> stopping = false, away = false, begun = true, disk_failed = false;

  std::mutex mutex;  ///< of what follows
  std::condition_variable changed;
  bool reader_ended = false;
  RecorderEnd end = RecorderEnd::complete;
  std::optional<Error> error;
  std::string not_stopped;  ///< why the device did not stop; empty: it did

  std::thread reader, writer_thread;

  void fail_with(const Error& why) {
    const std::scoped_lock lock(mutex);
    end = RecorderEnd::failed;
    if (!error) error = why;
  }

  void read_all() {
    Block block;
    while (true) {
      if (stopping) {
        const std::scoped_lock lock(mutex);
        if (end != RecorderEnd::failed) end = RecorderEnd::stopped;
        break;
      }
      const auto result = device.read(block, kLook);
      if (!result || is_silent(*result)) {
        if (!find_again(result ? silent() : result.error())) break;
      } else if (*result == ReadResult::ended || (*result == ReadResult::block && !take(block))) {
        break;
      }
    }
    const auto stopped = device.stop();
    ring.close();
    const std::scoped_lock lock(mutex);
    if (!stopped) not_stopped = stopped.error().message;  // all frames are here: a note
    reader_ended = true;
    changed.notify_all();
  }

  /// Whether it should have given a frame by now: a board that was reset holds its line open.
  bool is_silent(ReadResult result) {
    if (result == ReadResult::timeout) return heard_ns && options.clock->now_ns() - *heard_ns > silence_ns;
    missed_ns.reset();
    heard_ns = options.clock->now_ns();
    return false;
  }

  [[nodiscard]] Error silent() const {
    return fail(Code::device,
                fmt::format("{}: gives no frames any more; look at its plug, or pull it and put it in again",
                            device.capabilities().name))
        .error();
  }

  /// Look for a device that failed. false: it is given up, or nobody wants it any more.
  bool find_again(const Error& why) {
    if (why.code != Code::device) return fail_with(why), false;
    away = true;
    if (!missed_ns) missed_ns = options.clock->now_ns();
    const auto give_up_ns = *missed_ns + std::llround(1e9 * options.give_up_s);
    const auto step_ns = std::chrono::nanoseconds(options.look_every).count();
    while (!stopping) {
      if (options.clock->now_ns() >= give_up_ns) return fail_with(why), false;
      if (device.reopen()) {
        ++reopened;
        away = false;
        clock_fit.restart();
        if (heard_ns)
          heard_ns = options.clock->now_ns();
        else
          missed_ns.reset();  // it waits for its trigger
        return true;
      }
      options.clock->sleep_until(options.clock->now_ns() + step_ns);
    }
    return true;
  }

  /// false: that was the last one.
  bool take(const Block& block) {
    if (!begun && !begins_in(block)) return true;
    passed.block = block;
    trim_front();
    const auto limit = first + (options.frames > 0 ? options.frames : kMostNumber + 1);
    const auto from = passed.block.first_frame;
    if (from > expected) lose_by_device(std::min(from, limit) - expected);
    if (from >= limit) return advance(limit), false;
    shorten(std::min(passed.block.frames, limit - from));
    advance(from + passed.block.frames);
    received += passed.block.frames;
    if (block.renumbered) clock_fit.restart();
    if (speed > 0.0) clock_fit.add(expected, block.host_after_ns);
    passed.block.first_frame -= first;
    hand_on();
    return expected < limit && !disk_failed;
  }

  void advance(std::int64_t to) {
    expected = to;
    frames = to - first;
  }

  void lose_by_device(std::int64_t lost) {
    by_device += lost;
    pending_by_device += lost;
  }

  /// Whether the LED that begins it lights up in the block; sets where.
  bool begins_in(const Block& block) {
    const auto C = plan.layout.cameras.size(), L = plan.layout.leds.size();
    const auto led = static_cast<std::size_t>(options.begin->led);
    for (std::int64_t f = 0; f < block.frames; ++f)
      for (std::size_t c = 0; c < C; ++c) {
        const auto* four = block.counts.data() + 4 * ((static_cast<std::size_t>(f) * L + led) * C + c);
        if (std::accumulate(four, four + 4, 0.0) < options.begin->counts) continue;
        first = expected = block.first_frame + f;
        begun = true;
        return true;
      }
    return false;
  }

  /// Frames before the first one are nobody's.
  void trim_front() {
    auto& block = passed.block;
    const auto skip = first - block.first_frame;
    if (skip <= 0) return;
    const auto n = static_cast<std::size_t>(skip), O = plan.layout.leds.size() * plan.layout.cameras.size();
    block.counts.erase(block.counts.begin(), block.counts.begin() + static_cast<std::ptrdiff_t>(4 * n * O));
    block.flags.erase(block.flags.begin(), block.flags.begin() + static_cast<std::ptrdiff_t>(n * O));
    block.dark.erase(block.dark.begin(),
                     block.dark.begin() + static_cast<std::ptrdiff_t>(n * plan.layout.dark_time_s.size()));
    block.first_frame += skip;
    block.frames -= skip;
  }

  void shorten(std::int64_t to) {
    const auto n = static_cast<std::size_t>(to), O = plan.layout.leds.size() * plan.layout.cameras.size();
    passed.block.frames = to;
    passed.block.counts.resize(4 * n * O);
    passed.block.flags.resize(n * O);
    passed.block.dark.resize(n * plan.layout.dark_time_s.size());
  }

  void hand_on() {
    passed.lost_by_device = pending_by_device;
    passed.lost_here = pending_here;
    passed.block.gap = pending_by_device + pending_here > 0;
    if (speed == 0.0 ? ring.push(passed) : ring.try_push(passed)) {
      pending_by_device = pending_here = 0;
    } else {
      here += passed.block.frames;
      pending_here += passed.block.frames;
    }
    for (const auto& follower : followers)
      if (!follower->ring.try_push(passed)) missed += passed.block.frames;
  }

  void write_all() {
    RingBlock block;
    while (ring.pop(block)) {
      const auto before = acknowledged.load();
      if (!disk_failed) {
        if (const auto s = write(block); !s) {
          fail_with(s.error());
          disk_failed = stopping = true;
        }
      }
      here += block.block.frames - (acknowledged - before);  // none, but for a disk that failed
      if (!disk_failed) {
        levels.add(block.block);
        crosstalk.add(block.block);
      }
    }
  }

  Status write(const RingBlock& block) {
    if (!writer) return acknowledged += block.block.frames, Status();
    if (auto s = note_gap(block); !s) return s;
    const auto O = plan.layout.leds.size() * plan.layout.cameras.size(), D = plan.layout.dark_time_s.size();
    const std::span counts(block.block.counts);
    const std::span flags(block.block.flags);
    const std::span dark(block.block.dark);
    for (std::int64_t f = 0; f < block.block.frames; ++f) {
      const auto i = static_cast<std::size_t>(f);
      const auto number = block.block.first_frame + f;
      if (auto s = writer->push({.frame = number,
                                 .time_s = plan.layout.time.time_s(number),
                                 .counts = counts.subspan(4 * i * O, 4 * O),
                                 .flags = flags.subspan(i * O, O),
                                 .dark = dark.subspan(i * D, D)});
          !s)
        return s;
      acknowledged = writer->acknowledged();
    }
    return {};
  }

  Status note_gap(const RingBlock& block) {
    const auto lost = block.lost_by_device + block.lost_here;
    if (lost == 0 || gaps_noted == kMostGapsNoted) return {};
    ++gaps_noted;
    return writer->add_metadata(
        gap_note(block.block.first_frame - lost, block.lost_by_device, block.lost_here));
  }

  RecorderProgress progress() const {
    return {.frames = frames,
            .received = received,
            .acknowledged = acknowledged,
            .dropped_by_device = by_device,
            .dropped_here = here,
            .missed_by_followers = missed,
            .reopened = reopened,
            .fullest_ring = static_cast<double>(ring.fullest()) / static_cast<double>(most_waiting),
            .away = away,
            .begun = begun};
  }
};

Recorder::Recorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Recorder::~Recorder() = default;

Result<std::unique_ptr<Recorder>> Recorder::start(stream::Device& device, const stream::GrantedPlan& plan,
                                                  RecorderOptions options) {
  check(options.ring_s > 0.0 && options.frames >= 0,
        "a recorder has a ring, and no negative number of frames");
  if (!options.clock) options.clock = std::make_shared<stream::SteadyHostClock>();
  auto state = std::make_unique<State>(device, plan, std::move(options));
  const auto& asked = state->options;
  check(!asked.begin || (asked.begin->led >= 0 && asked.begin->led < plan.layout.led_count()),
        "an LED of the plan begins it");
  state->begun = !asked.begin;
  if (auto s = device.start(); !s) return std::unexpected(s.error());
  if (!asked.file.empty()) {
    auto writer = io::CountsWriter::create(asked.file, plan.layout, asked.metadata, asked.recording);
    if (!writer) {
      (void)device.stop();
      return std::unexpected(writer.error());
    }
    state->writer.emplace(std::move(*writer));
  }
  for (const auto& follower : asked.followers)
    state->followers.push_back(std::make_unique<Follower>(follower, state->most_waiting));
  state->writer_thread = std::thread([s = state.get()] { s->write_all(); });
  state->reader = std::thread([s = state.get()] { s->read_all(); });
  return std::unique_ptr<Recorder>(new Recorder(std::move(state)));
}

RecorderProgress Recorder::progress() const { return state_->progress(); }

void Recorder::stop() { state_->stopping = true; }

bool Recorder::wait_for(milliseconds time) {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, time, [this] { return state_->reader_ended; });
}

Recorded Recorder::finish() {
  auto& s = *state_;
  check(s.reader.joinable(), "a recorder is finished once");
  s.reader.join();
  s.writer_thread.join();
  s.followers.clear();
  Recorded out{.progress = s.progress(),
               .end = s.end,
               .error = s.error,
               .lit = s.levels.lit(),
               .dark = s.levels.dark(),
               .crosstalk = s.crosstalk.found(),
               .crosstalk_led = s.crosstalk.led()};
  if (s.speed > 0.0) out.clock = s.clock_fit.rate();
  if (!s.writer) return out;
  auto closed = s.disk_failed ? Status() : s.writer->add_metadata(end_note(out, s.not_stopped));
  if (closed && !s.disk_failed) closed = s.writer->close();
  if (!closed) {
    out.end = RecorderEnd::failed;
    out.error = closed.error();
  }
  s.writer.reset();
  return out;
}

}  // namespace kinemark::pipeline
