// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/counts_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/recording/internal/counts_layout.h"

namespace kinemark::io {

Result<CountsReader> CountsReader::open(const std::filesystem::path& path) {
  auto reader = RecordingReader::open(path, {.skip_damage = true});
  if (!reader) return std::unexpected(reader.error());
  CountsReader out(std::move(*reader));
  RecordingMessage message;
  const auto more = out.reader_.next(message);
  if (!more) return std::unexpected(more.error());
  if (*more) out.first_ = message;
  const auto& channels = out.reader_.channels();
  const auto at = std::ranges::find_if(channels, carries_counts);
  if (at == channels.end())
    return fail(Code::bad_input, fmt::format("{}: is a recording without counts", out.reader_.name()));
  auto layout = internal::counts_like(*at);
  if (!layout) return fail_at(out.reader_.name(), layout.error());
  out.layout_ = std::move(*layout);
  out.channel_ = static_cast<std::uint16_t>(at - channels.begin());
  return out;
}

bool CountsReader::take(const RecordingMessage& message, ReadCounts& frame) {
  if (message.channel != channel_ || message.data.size() != internal::frame_bytes(layout_)) return false;
  if (last_number_ && message.sequence <= *last_number_) return false;
  last_number_ = frame.number = message.sequence;
  const std::size_t observations = layout_.leds.size() * layout_.cameras.size();
  frame.counts.resize(4 * observations);
  frame.flags.resize(observations);
  frame.dark.resize(layout_.dark_time_s.size());
  [[maybe_unused]] const int flagged_lost = internal::decode_frame(message.data, layout_, frame.counts.data(),
                                                                   frame.dark.data(), frame.flags.data());
  return true;
}

Result<bool> CountsReader::next(ReadCounts& frame) {
  if (first_ && take(*std::exchange(first_, std::nullopt), frame)) return true;
  RecordingMessage message;
  while (true) {
    const auto more = reader_.next(message);
    if (!more) return std::unexpected(more.error());
    if (!*more) return false;
    if (take(message, frame)) return true;
  }
}

}  // namespace kinemark::io
