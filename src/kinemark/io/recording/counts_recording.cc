// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/counts_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/number.h"
#include "kinemark/io/file.h"
#include "kinemark/io/recording/clock_watch.h"
#include "kinemark/io/recording/encoder.h"
#include "kinemark/io/recording/internal/counts_layout.h"
#include "kinemark/io/recording/internal/mcap.h"
#include "kinemark/io/recording/survey.h"

namespace kinemark::io {
namespace {

using namespace internal;

constexpr std::size_t kFlushBytes = 1U << 20;
constexpr std::size_t kFrameOverheadBytes = kRecordHead + kMessageHead + kCheckBytes;

template <class T>
void put_all(Bytes& out, std::span<const T> values) {
  const std::size_t at = out.size();
  out.resize(at + sizeof(T) * values.size());
  std::byte* to = out.data() + at;
  for (const T value : values)
    for (std::size_t i = 0; i < sizeof(T); ++i)
      *to++ = static_cast<std::byte>(static_cast<std::uint16_t>(value) >> (8 * i));
}

RecordingMessage encode_frame(const CountsFrame& frame, double epoch_s, Bytes& bytes) {
  bytes.clear();
  put_all(bytes, frame.counts);
  put_all(bytes, frame.dark);
  put_all(bytes, frame.flags);
  // A clock that runs back beyond its epoch is clamped there: the frame is kept and the jump is reported.
  const double ns = std::clamp(1e9 * (frame.time_s - epoch_s), 0.0, 9e18);
  RecordingMessage message;
  message.sequence = static_cast<std::uint32_t>(frame.frame);
  message.log_time_ns = message.publish_time_ns = static_cast<std::uint64_t>(std::llround(ns));
  message.data = bytes;
  return message;
}

Status check_layout(const data::Counts& like) {
  if (like.led_count() < 1 || like.camera_count() < 1)
    return fail(Code::usage, fmt::format("counts of {} LEDs and {} cameras; need one of each or more",
                                         like.led_count(), like.camera_count()));
  if (frame_bytes(like) > kMaxGroupBytes / 2)
    return fail(Code::usage, fmt::format("a frame of {} LEDs and {} cameras is too large to record",
                                         like.led_count(), like.camera_count()));
  return {};
}

/// Builds counts from the messages of one channel.
class Assembly {
 public:
  Assembly(CountsRecording& out, std::uint64_t file_bytes)
      : counts_(out.counts),
        warnings_(out.warnings),
        clock_(counts_.time.rate_hz),
        observations_(counts_.leds.size() * counts_.cameras.size()),
        dark_size_(counts_.dark_time_s.size()),
        message_bytes_(frame_bytes(counts_)),
        // A wrong message number must not claim more memory than the file size justifies.
        frames_allowed_(static_cast<std::int64_t>((16 * file_bytes + (64U << 20)) / message_bytes_)) {
    // As many as fit into the file: growing step by step costs several times the memory and the time.
    const std::size_t frames = file_bytes / (message_bytes_ + kFrameOverheadBytes);
    counts_.counts.reserve(4 * frames * observations_);
    counts_.flags.reserve(frames * observations_);
    counts_.dark.reserve(frames * dark_size_);
  }

  /// False when the rest of the file cannot be used.
  bool add(const RecordingMessage& message) {
    if (message.data.size() != message_bytes_) return ++wrong_size_, true;
    const std::int64_t frame = counts_.time.frames + steps_between(next_, message.sequence);
    if (frame < counts_.time.frames) return ++repeated_, true;
    if (frame >= frames_allowed_) {
      warnings_.push_back(fmt::format("frame {} follows frame {}: an implausible step; the rest was left out",
                                      frame, counts_.time.frames - 1));
      return false;
    }
    if (const auto jump_s = clock_.observe(message.sequence, message.log_time_ns)) {
      if (jumps_++ == 0) first_jump_ = fmt::format("{:+.6g} s before frame {}", *jump_s, frame);
    }
    lost_ += frame - counts_.time.frames;
    grow(frame + 1);
    take(frame, message.data);
    next_ = message.sequence + 1;
    return true;
  }

  void finish() {
    const auto warn = [this](std::int64_t count, const std::string& sentence) {
      if (count > 0) warnings_.push_back(sentence);
    };
    warn(lost_, fmt::format("{} frames are missing in between", lost_));
    warn(repeated_, fmt::format("{} frames repeat or go back in number and were left out", repeated_));
    warn(wrong_size_,
         fmt::format("{} messages are not {} bytes long and were left out", wrong_size_, message_bytes_));
    warn(impossible_, fmt::format("{} observations have counts outside 0 to {} and were left out",
                                  impossible_, counts_.highest_code));
    warn(jumps_, fmt::format("the clock jumps {} times, first by {}; frames are taken to be evenly spaced",
                             jumps_, first_jump_));
  }

 private:
  /// Frames up to `frames`, the new ones lost.
  void grow(std::int64_t frames) {
    counts_.time.frames = frames;
    const auto n = static_cast<std::size_t>(frames);
    counts_.counts.resize(4 * n * observations_, 0);
    counts_.flags.resize(n * observations_, data::kCountLost);
    counts_.dark.resize(n * dark_size_, 0);
  }

  void take(std::int64_t frame, std::span<const std::byte> data) {
    const auto f = static_cast<std::size_t>(frame);
    impossible_ +=
        decode_frame(data, counts_, counts_.counts.data() + 4 * f * observations_,
                     counts_.dark.data() + f * dark_size_, counts_.flags.data() + f * observations_);
  }

  data::Counts& counts_;
  std::vector<std::string>& warnings_;
  ClockWatch clock_;
  std::size_t observations_, dark_size_, message_bytes_;
  std::int64_t frames_allowed_;
  std::uint32_t next_ = 0;
  std::int64_t lost_ = 0, repeated_ = 0, wrong_size_ = 0, impossible_ = 0, jumps_ = 0;
  std::string first_jump_;
};

}  // namespace

Status write_counts(const std::filesystem::path& path, const data::Counts& counts,
                    std::span<const RecordingMetadata> metadata, bool force) {
  if (auto s = counts.validate(); !s) return fail(Code::usage, s.error().message);
  if (auto s = check_layout(counts); !s) return s;
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  RecordingEncoder encoder;
  Bytes bytes, frame_data;
  encoder.begin(bytes);
  for (const RecordingMetadata& one : metadata)
    if (auto s = encoder.add_metadata(one, bytes); !s) return s;
  const auto channel = encoder.add_channel(channel_of(counts), bytes);
  if (!channel) return std::unexpected(channel.error());
  const std::size_t observations = counts.leds.size() * counts.cameras.size();
  const std::size_t dark_size = counts.dark_time_s.size();
  for (std::int64_t f = 0; f < counts.frames(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    const CountsFrame frame{
        .frame = f,
        .time_s = counts.time.time_s(f),
        .counts = std::span(counts.counts).subspan(4 * i * observations, 4 * observations),
        .flags = std::span(counts.flags).subspan(i * observations, observations),
        .dark = std::span(counts.dark).subspan(i * dark_size, dark_size)};
    const RecordingMessage message = encode_frame(frame, epoch_s_of(counts), frame_data);
    if (auto s = encoder.add_messages({&message, 1}, bytes); !s) return s;
    if (bytes.size() < kFlushBytes) continue;
    if (auto s = file->write(bytes); !s) return s;
    bytes.clear();
  }
  encoder.finish(bytes);
  if (auto s = file->write(bytes); !s) return s;
  return file->commit();
}

bool carries_counts(const RecordingChannel& channel) { return is_counts(channel); }

Result<CountsRecording> read_counts(const std::filesystem::path& path) {
  auto reader = RecordingReader::open(path, {.skip_damage = true});
  if (!reader) return std::unexpected(reader.error());
  return read_counts(std::move(*reader));
}

Result<CountsRecording> read_counts(RecordingReader reader) {
  CountsRecording out;
  std::optional<std::uint16_t> channel;
  std::optional<Assembly> assembly;
  std::size_t looked_at = 0;
  RecordingMessage message;
  bool using_frames = true;
  while (true) {
    const auto more = reader.next(message);
    if (!more) return std::unexpected(more.error());
    for (; !channel && looked_at < reader.channels().size(); ++looked_at) {
      if (!is_counts(reader.channels()[looked_at])) continue;
      auto counts = counts_like(reader.channels()[looked_at]);
      if (!counts) return fail_at(reader.name(), counts.error());
      channel = static_cast<std::uint16_t>(looked_at);
      out.counts = std::move(*counts);
      assembly.emplace(out, reader.size());
    }
    if (!*more) break;
    if (message.channel == channel && using_frames) using_frames = assembly->add(message);
  }
  if (!channel) return fail(Code::bad_input, fmt::format("{}: is a recording without counts", reader.name()));
  out.metadata = reader.metadata();
  out.end = reader.end();
  const auto endings = describe_end(reader);
  out.warnings.insert(out.warnings.begin(), endings.begin(), endings.end());
  assembly->finish();
  if (auto s = out.counts.validate(); !s) return fail_at(reader.name(), s.error());
  return out;
}

CountsWriter::CountsWriter(RecordingWriter writer, const data::Counts& like)
    : writer_(std::move(writer)),
      counts_size_(4 * like.leds.size() * like.cameras.size()),
      flags_size_(like.leds.size() * like.cameras.size()),
      dark_size_(like.dark_time_s.size()),
      epoch_s_(epoch_s_of(like)) {}

Result<CountsWriter> CountsWriter::create(const std::filesystem::path& path, const data::Counts& like,
                                          std::span<const RecordingMetadata> metadata,
                                          const RecordingOptions& options) {
  if (auto s = check_layout(like); !s) return std::unexpected(s.error());
  data::Counts empty = like;
  empty.time.frames = 0;
  empty.counts.clear();
  empty.flags.clear();
  empty.dark.clear();
  if (auto s = empty.validate(); !s) return fail(Code::usage, s.error().message);
  auto writer = RecordingWriter::create(path, options);
  if (!writer) return std::unexpected(writer.error());
  for (const RecordingMetadata& one : metadata)
    if (auto s = writer->add_metadata(one); !s) return std::unexpected(s.error());
  if (auto channel = writer->add_channel(channel_of(empty)); !channel)
    return std::unexpected(channel.error());
  return CountsWriter(std::move(*writer), empty);
}

Status CountsWriter::push(const CountsFrame& frame) {
  check(frame.counts.size() == counts_size_ && frame.flags.size() == flags_size_ &&
            frame.dark.size() == dark_size_,
        "a frame has the shape that the recording was made for");
  check(frame.frame >= 0 && frame.frame <= 0xFFFFFFFFLL && std::isfinite(frame.time_s),
        "a frame has a number of 32 bits and a time");
  return writer_.append(encode_frame(frame, epoch_s_, frame_));
}

}  // namespace kinemark::io
