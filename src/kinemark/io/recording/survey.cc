// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/survey.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/io/recording/clock_watch.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kListedJumps = 100;
constexpr std::size_t kListedDamage = 10;

/// One channel while it is read.
struct Watch {
  ClockWatch clock;
  std::uint32_t sequence = 0;
};

double rate_of(const RecordingChannel& channel) {
  const auto rate = channel.metadata.find("rate_hz");
  return rate == channel.metadata.end() ? 0.0 : parse_number(rate->second).value_or(0.0);
}

void describe_channels(RecordingSurvey& survey) {
  for (std::size_t i = 0; i < survey.channels.size(); ++i) {
    const ChannelSurvey& facts = survey.per_channel[i];
    const std::string& topic = survey.channels[i].topic;
    if (facts.lost > 0)
      survey.warnings.push_back(
          fmt::format("{}: {} messages are missing by their numbers", topic, facts.lost));
    if (facts.out_of_order > 0)
      survey.warnings.push_back(
          fmt::format("{}: {} messages repeat or go back in number", topic, facts.out_of_order));
    if (facts.clock_jumps == 0) continue;
    const auto first =
        std::ranges::find(survey.clock_jumps, static_cast<std::uint16_t>(i), &ClockJump::channel);
    std::string where;
    if (first != survey.clock_jumps.end())
      where = fmt::format("; the first by {:+.6g} s before message {}", first->jump_s, first->sequence);
    survey.warnings.push_back(fmt::format("{}: the clock jumps {} times{}", topic, facts.clock_jumps, where));
  }
}

}  // namespace

std::vector<std::string> describe_end(const RecordingReader& reader) {
  std::vector<std::string> out;
  if (reader.end() == RecordingEnd::open)
    out.push_back(
        "was not closed: the recorder was stopped, or is still recording; all that is there was kept");
  std::uint64_t bytes = 0;
  for (const RecordingDamage& damage : reader.damage()) {
    bytes += damage.bytes;
    if (out.size() < kListedDamage)
      out.push_back(
          fmt::format("byte {}: {}; {} bytes were left out", damage.offset, damage.what, damage.bytes));
  }
  if (reader.damage().size() > kListedDamage)
    out.push_back(fmt::format("{} damaged places in all, {} bytes", reader.damage().size(), bytes));
  return out;
}

Result<RecordingSurvey> survey_recording(const std::filesystem::path& path) {
  auto reader = RecordingReader::open(path, {.skip_damage = true});
  if (!reader) return std::unexpected(reader.error());
  return survey_recording(std::move(*reader));
}

Result<RecordingSurvey> survey_recording(RecordingReader reader) {
  RecordingSurvey survey;
  std::vector<Watch> watches;
  RecordingMessage message;
  while (true) {
    const auto more = reader.next(message);
    if (!more) return std::unexpected(more.error());
    while (watches.size() < reader.channels().size()) {
      watches.push_back({.clock = ClockWatch(rate_of(reader.channels()[watches.size()]))});
      survey.per_channel.emplace_back();
    }
    if (!*more) break;
    Watch& watch = watches[message.channel];
    ChannelSurvey& facts = survey.per_channel[message.channel];
    const double time_s = 1e-9 * static_cast<double>(message.log_time_ns);
    if (const auto jump_s = watch.clock.observe(message.sequence, message.log_time_ns)) {
      ++facts.clock_jumps;
      if (survey.clock_jumps.size() < kListedJumps)
        survey.clock_jumps.push_back({message.channel, message.sequence, time_s, *jump_s});
    }
    if (facts.messages == 0) {
      facts.first_time_s = facts.last_time_s = time_s;
    } else {
      const std::int64_t steps = steps_between(watch.sequence, message.sequence);
      if (steps > 1) facts.lost += steps - 1;
      if (steps < 1) ++facts.out_of_order;
      facts.first_time_s = std::min(facts.first_time_s, time_s);
      facts.last_time_s = std::max(facts.last_time_s, time_s);
    }
    watch.sequence = message.sequence;
    ++facts.messages;
    facts.bytes += static_cast<std::int64_t>(message.data.size());
  }
  survey.bytes = reader.size();
  survey.messages = reader.messages();
  survey.channels = reader.channels();
  survey.metadata = reader.metadata();
  survey.end = reader.end();
  survey.damage = reader.damage();
  survey.warnings = describe_end(reader);
  describe_channels(survey);
  return survey;
}

}  // namespace kinemark::io
