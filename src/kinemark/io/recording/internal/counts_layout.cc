// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/internal/counts_layout.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "kinemark/core/number.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

using Json = nlohmann::json;

constexpr const char* kTopic = "/counts";
constexpr const char* kSchemaName = "kinemark.Counts";
constexpr const char* kSchemaText =
    "One frame, little end first, without gaps: int16 counts[led][camera][4] of the electrodes +x, -x, +y, "
    "-y; "
    "int16 dark[camera][4], only where the layout has dark_time_s; uint8 flags[led][camera], bits 1 "
    "saturated, 2 "
    "occluded, 4 lost. The channel's metadata 'layout' is JSON: names, rate, times of the conversions in s "
    "after "
    "the frame's time.";

Result<std::vector<std::string>> names(const Json& layout, const char* key) {
  const auto at = layout.find(key);
  std::vector<std::string> out;
  if (at != layout.end() && at->is_array())
    for (const Json& name : *at)
      if (name.is_string()) out.push_back(name.get<std::string>());
  if (out.empty() || out.size() != at->size())
    return fail(Code::bad_input, fmt::format("the layout of the counts: '{}' is not a list of names", key));
  return out;
}

Result<double> number(const Json& layout, const char* key) {
  const auto at = layout.find(key);
  if (at == layout.end() || !at->is_number() || !std::isfinite(at->get<double>()))
    return fail(Code::bad_input, fmt::format("the layout of the counts: '{}' is not a number", key));
  return at->get<double>();
}

Result<Array<double>> numbers(const Json& layout, const char* key) {
  const auto at = layout.find(key);
  Array<double> out;
  if (at == layout.end()) return out;
  if (at->is_array())
    for (const Json& value : *at)
      if (value.is_number()) out.push_back(value.get<double>());
  if (!at->is_array() || out.size() != at->size())
    return fail(Code::bad_input, fmt::format("the layout of the counts: '{}' is not a list of numbers", key));
  return out;
}

}  // namespace

RecordingChannel channel_of(const data::Counts& like) {
  Json layout{{"rig_id", like.rig_id},
              {"leds", like.leds},
              {"cameras", like.cameras},
              {"rate_hz", like.time.rate_hz},
              {"t0_s", like.time.t0_s},
              {"highest_code", like.highest_code},
              {"conversion_time_s", like.conversion_time_s}};
  if (like.has_dark_slot()) layout["dark_time_s"] = like.dark_time_s;
  return {.topic = kTopic,
          .message_encoding = "x-kinemark-counts",
          .schema_name = kSchemaName,
          .schema_encoding = "x-text",
          .schema_text = kSchemaText,
          .metadata = {{"layout", layout.dump(-1, ' ', false, Json::error_handler_t::replace)},
                       {"rate_hz", format_number(like.time.rate_hz)}}};
}

bool is_counts(const RecordingChannel& channel) {
  return channel.topic == kTopic && channel.schema_name == kSchemaName;
}

Result<data::Counts> counts_like(const RecordingChannel& channel) {
  const auto text = channel.metadata.find("layout");
  const Json layout = text == channel.metadata.end()
                          ? Json()
                          : Json::parse(text->second, nullptr, /*allow_exceptions=*/false);
  if (!layout.is_object()) return fail(Code::bad_input, "the layout of the counts is not a JSON object");
  const auto leds = names(layout, "leds");
  if (!leds) return std::unexpected(leds.error());
  const auto cameras = names(layout, "cameras");
  if (!cameras) return std::unexpected(cameras.error());
  const auto rate_hz = number(layout, "rate_hz");
  if (!rate_hz) return std::unexpected(rate_hz.error());
  if (auto s = check_rate(*rate_hz, "the layout of the counts: rate_hz"); !s)
    return std::unexpected(s.error());
  const auto t0_s = number(layout, "t0_s");
  if (!t0_s) return std::unexpected(t0_s.error());
  const auto highest = number(layout, "highest_code");
  if (!highest) return std::unexpected(highest.error());
  if (!(*highest >= 1.0 && *highest <= 32767.0))
    return fail(Code::bad_input,
                fmt::format("the layout of the counts: highest_code is {}; need 1 to 32767", *highest));
  auto conversions = numbers(layout, "conversion_time_s");
  if (!conversions) return std::unexpected(conversions.error());
  auto dark = numbers(layout, "dark_time_s");
  if (!dark) return std::unexpected(dark.error());
  data::Counts out;
  if (const auto rig = layout.find("rig_id"); rig != layout.end() && rig->is_string())
    out.rig_id = rig->get<std::string>();
  out.leds = *leds;
  out.cameras = *cameras;
  out.time = {.rate_hz = *rate_hz, .t0_s = *t0_s, .frames = 0};
  out.highest_code = static_cast<std::int16_t>(*highest);
  out.conversion_time_s = std::move(*conversions);
  out.dark_time_s = std::move(*dark);
  if (auto s = out.validate(); !s) return std::unexpected(s.error());
  return out;
}

std::size_t frame_bytes(const data::Counts& like) {
  const std::size_t observations = like.leds.size() * like.cameras.size();
  return 9 * observations + 2 * like.dark_time_s.size();
}

int decode_frame(std::span<const std::byte> data, const data::Counts& like, std::int16_t* counts,
                 std::int16_t* dark, std::uint8_t* flags) {
  const std::size_t observations = like.leds.size() * like.cameras.size(),
                    dark_size = like.dark_time_s.size();
  const auto possible = [&like](std::int16_t code) { return code >= 0 && code <= like.highest_code; };
  const auto code_at = [data](std::size_t i) {
    return static_cast<std::int16_t>(std::to_integer<unsigned>(data[2 * i]) |
                                     std::to_integer<unsigned>(data[2 * i + 1]) << 8U);
  };
  bool good = true;
  for (std::size_t i = 0; i < 4 * observations; ++i) good = possible(counts[i] = code_at(i)) && good;
  for (std::size_t i = 0; i < dark_size; ++i)
    good = possible(dark[i] = code_at(4 * observations + i)) && good;
  const std::size_t flags_at = 2 * (4 * observations + dark_size);
  for (std::size_t i = 0; i < observations; ++i) flags[i] = std::to_integer<std::uint8_t>(data[flags_at + i]);
  if (good) return 0;
  int impossible = 0;
  for (std::size_t s = 0; s < observations; ++s) {
    if (std::all_of(counts + 4 * s, counts + 4 * s + 4, possible)) continue;
    std::fill_n(counts + 4 * s, 4, std::int16_t{0});
    flags[s] = static_cast<std::uint8_t>(flags[s] | data::kCountLost);
    ++impossible;
  }
  for (std::size_t i = 0; i < dark_size; ++i)
    if (!possible(dark[i])) dark[i] = 0;
  return impossible;
}

double epoch_s_of(const data::Counts& like) { return std::min(0.0, like.time.t0_s); }

}  // namespace kinemark::io::internal
