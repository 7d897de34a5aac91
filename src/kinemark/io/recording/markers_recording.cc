// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/markers_recording.h"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/counted.h"
#include "kinemark/core/number.h"
#include "kinemark/io/rate.h"
#include "kinemark/io/recording/clock_watch.h"
#include "kinemark/io/recording/survey.h"

namespace kinemark::io {
namespace {

using Json = nlohmann::json;

constexpr const char* kMarkersTopic = "/markers";
constexpr const char* kMarkersSchema = "kinemark.Markers";
constexpr const char* kMarkersSchemaText =
    "One frame, little end first, without gaps: float64 x_in_world[marker][3] in m, NaN where there is none; "
    "uint8 state[marker]: 0 missing, 1 measured, 2 interpolated, 3 model-filled, 4 upsampled, 5 rejected. "
    "The "
    "channel's metadata 'layout' is JSON: names, rate, time of frame 0.";
constexpr std::size_t kBytesPerMarker = 3 * sizeof(double) + 1;
constexpr auto kStates = static_cast<std::uint8_t>(data::SampleState::rejected) + 1;

RecordingChannel channel_of_markers(const MarkersLayout& layout) {
  const Json json{
      {"names", layout.names}, {"rate_hz", layout.rate_hz}, {"t0_s", layout.t0_s}, {"source", layout.source}};
  return {.topic = kMarkersTopic,
          .message_encoding = "x-kinemark-markers",
          .schema_name = kMarkersSchema,
          .schema_encoding = "x-text",
          .schema_text = kMarkersSchemaText,
          .metadata = {{"layout", json.dump(-1, ' ', false, Json::error_handler_t::replace)},
                       {"rate_hz", format_number(layout.rate_hz)}}};
}

Status check_markers_layout(const MarkersLayout& layout) {
  if (auto s = check_rate(layout.rate_hz, "the layout of the markers: rate_hz"); !s) return s;
  if (!std::isfinite(layout.t0_s))
    return fail(Code::bad_input, "the layout of the markers: t0_s is not a number");
  if (layout.names.size() * kBytesPerMarker > kMaxGroupBytes / 2)
    return fail(Code::bad_input,
                fmt::format("a frame of {} markers is too large to record", layout.names.size()));
  return data::Trajectories::all_missing(layout.names, {.rate_hz = layout.rate_hz, .t0_s = 0.0, .frames = 0})
      .validate();
}

Result<MarkersLayout> layout_of(const RecordingChannel& channel) {
  const auto text = channel.metadata.find("layout");
  const Json json = text == channel.metadata.end()
                        ? Json()
                        : Json::parse(text->second, nullptr, /*allow_exceptions=*/false);
  MarkersLayout layout;
  const auto number = [&json](const char* key) {
    const auto at = json.find(key);
    return at != json.end() && at->is_number() ? at->get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  const auto names = json.is_object() ? json.find("names") : json.end();
  if (!json.is_object() || names == json.end() || !names->is_array())
    return fail(Code::bad_input, "the layout of the markers is not a JSON object with a list of names");
  for (const Json& name : *names) {
    if (!name.is_string()) return fail(Code::bad_input, "the layout of the markers: a name is not a text");
    layout.names.push_back(name.get<std::string>());
  }
  layout.rate_hz = number("rate_hz");
  layout.t0_s = number("t0_s");
  if (const auto at = json.find("source"); at != json.end() && at->is_string())
    layout.source = at->get<std::string>();
  if (auto s = check_markers_layout(layout); !s) return std::unexpected(s.error());
  return layout;
}

void put_double(Bytes& out, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int shift = 0; shift < 64; shift += 8) out.push_back(static_cast<std::byte>(bits >> shift & 0xFFU));
}

double double_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) bits |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  return std::bit_cast<double>(bits);
}

/// Builds trajectories from the messages of one channel.
class MarkersAssembly {
 public:
  MarkersAssembly(MarkersLayout layout, std::uint64_t file_bytes)
      : message_bytes_(layout.names.size() * kBytesPerMarker),
        // A wrong message number must not claim more memory than the file size justifies.
        frames_allowed_(static_cast<std::int64_t>((16 * file_bytes + (64U << 20)) / (message_bytes_ + 1))),
        markers_(data::Trajectories::all_missing(
            std::move(layout.names), {.rate_hz = layout.rate_hz, .t0_s = layout.t0_s, .frames = 0})) {}

  /// False when the rest of the file cannot be used.
  bool add(const RecordingMessage& message, std::vector<std::string>& warnings) {
    if (message.data.size() != message_bytes_) return ++wrong_size_, true;
    const std::int64_t frame = markers_.time.frames + steps_between(next_, message.sequence);
    if (frame < markers_.time.frames) return ++repeated_, true;
    if (frame >= frames_allowed_) {
      warnings.push_back(fmt::format("frame {} follows frame {}: an implausible step; the rest was left out",
                                     frame, markers_.time.frames - 1));
      return false;
    }
    lost_ += frame - markers_.time.frames;
    markers_.time.frames = frame + 1;
    const auto samples = static_cast<std::size_t>(frame + 1) * markers_.names.size();
    markers_.x_in_world.resize(3 * samples, std::numeric_limits<double>::quiet_NaN());
    markers_.state.resize(samples, data::SampleState::missing);
    take(frame, message.data);
    next_ = message.sequence + 1;
    return true;
  }

  data::Trajectories finish(std::vector<std::string>& warnings) {
    const auto warn = [&warnings](std::int64_t count, const std::string& sentence) {
      if (count > 0) warnings.push_back(sentence);
    };
    warn(lost_, fmt::format("{} missing in between",
                            lost_ == 1 ? "1 frame is" : fmt::format("{} frames are", lost_)));
    warn(repeated_, fmt::format("{} left out that repeat or go back in number", counted(repeated_, "frame")));
    warn(wrong_size_, fmt::format("{} left out that are not {} bytes long", counted(wrong_size_, "message"),
                                  message_bytes_));
    warn(impossible_,
         fmt::format("{} left out whose state or position makes no sense", counted(impossible_, "sample")));
    return std::move(markers_);
  }

 private:
  void take(std::int64_t frame, std::span<const std::byte> bytes) {
    const std::size_t states_at = 3 * sizeof(double) * markers_.names.size();
    for (std::int64_t m = 0; m < markers_.markers(); ++m) {
      const auto i = static_cast<std::size_t>(m);
      const Eigen::Vector3d x(double_at(bytes, 24 * i), double_at(bytes, 24 * i + 8),
                              double_at(bytes, 24 * i + 16));
      const auto code = std::to_integer<std::uint8_t>(bytes[states_at + i]);
      const auto state = code < kStates ? static_cast<data::SampleState>(code) : data::SampleState::missing;
      const bool absent = state == data::SampleState::missing || state == data::SampleState::rejected;
      if (code >= kStates || (!absent && !x.allFinite())) {
        ++impossible_;
        continue;
      }
      markers_.state[markers_.index(frame, m)] = state;
      if (!absent) markers_.x(frame, m) = x;
    }
  }

  std::size_t message_bytes_;
  std::int64_t frames_allowed_;
  data::Trajectories markers_;
  std::uint32_t next_ = 0;
  std::int64_t lost_ = 0, repeated_ = 0, wrong_size_ = 0, impossible_ = 0;
};

}  // namespace

Result<MarkersWriter> MarkersWriter::create(const std::filesystem::path& path, const MarkersLayout& layout,
                                            const RecordingOptions& options) {
  if (auto s = check_markers_layout(layout); !s) return fail(Code::usage, s.error().message);
  auto writer = RecordingWriter::create(path, options);
  if (!writer) return std::unexpected(writer.error());
  if (auto channel = writer->add_channel(channel_of_markers(layout)); !channel)
    return std::unexpected(channel.error());
  return MarkersWriter(std::move(*writer), layout.names.size());
}

Status MarkersWriter::push(const MarkersFrame& frame) {
  check(frame.x_in_world.size() == 3 * markers_ && frame.state.size() == markers_,
        "a frame has the markers that the recording was made for");
  check(frame.frame >= 0 && frame.frame <= 0xFFFFFFFFLL, "a frame has a number of 32 bits");
  bytes_.clear();
  for (const double value : frame.x_in_world) put_double(bytes_, value);
  for (const auto state : frame.state) bytes_.push_back(static_cast<std::byte>(state));
  return writer_.append(RecordingMessage{.sequence = static_cast<std::uint32_t>(frame.frame),
                                         .log_time_ns = frame.log_time_ns,
                                         .publish_time_ns = frame.log_time_ns,
                                         .data = bytes_});
}

bool carries_markers(const RecordingChannel& channel) {
  return channel.topic == kMarkersTopic && channel.schema_name == kMarkersSchema;
}

Result<data::Trial> read_markers_recording(RecordingReader reader) {
  data::Trial trial{.source = reader.name(), .format = "recording", .units_in_file = "m"};
  std::optional<std::uint16_t> channel;
  std::optional<MarkersAssembly> assembly;
  std::size_t looked_at = 0;
  RecordingMessage message;
  bool usable = true;
  while (true) {
    const auto more = reader.next(message);
    if (!more) return std::unexpected(more.error());
    for (; !channel && looked_at < reader.channels().size(); ++looked_at) {
      if (!carries_markers(reader.channels()[looked_at])) continue;
      auto layout = layout_of(reader.channels()[looked_at]);
      if (!layout) return fail_at(reader.name(), layout.error());
      channel = static_cast<std::uint16_t>(looked_at);
      assembly.emplace(std::move(*layout), reader.size());
    }
    if (!*more) break;
    if (message.channel == channel && usable) usable = assembly->add(message, trial.warnings);
  }
  if (!channel)
    return fail(
        Code::not_supported,
        fmt::format("{}: is a recording of kinemark without positions of markers; of counts of detectors "
                    "kinemark reconstruct makes them",
                    reader.name()));
  for (auto& sentence : describe_end(reader)) trial.warnings.push_back(std::move(sentence));
  trial.markers = assembly->finish(trial.warnings);
  trial.first_frame = 1;
  if (auto s = trial.validate(); !s) return fail_at(reader.name(), s.error());
  return trial;
}

}  // namespace kinemark::io
