// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/desk_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/utf8.h"

namespace kinemark::server {
namespace {

using Json = nlohmann::ordered_json;
using pipeline::DeskStep;

constexpr EnumNames<DeskAction::discard> kActions{"look",   "open",          "leave_source", "start",
                                                  "set_up", "restart_guide", "intensity",    "record",
                                                  "stop",   "keep",          "discard"};
constexpr std::size_t kMostSpots = 30;   // of an LED in a camera
constexpr std::size_t kMostRates = 64;   // LEDs whose highest rate is told
constexpr std::size_t kMostText = 1000;  // bytes of a text

// Rounded, so that a state is short.
Json rounded(double value, double per_unit) {
  return std::isfinite(value) ? Json(std::round(value * per_unit) / per_unit) : Json();
}

Json device_json(const stream::DeviceCapabilities& device) {
  Json rates = Json::array();
  for (std::size_t leds = 1; leds <= kMostRates; ++leds)
    rates.push_back(rounded(device.fastest.highest_rate_hz(static_cast<int>(leds), device.cameras), 10.0));
  return {{"name", device.name},
          {"most_leds", device.most_leds},
          {"cameras", device.cameras},
          {"bits", device.bits},
          {"sets_intensity", device.sets_intensity},
          {"slot_us", rounded(1e6 * device.fastest.slot_s(device.cameras), 1.0)},
          {"highest_rates_hz", rates}};
}

Json seen_json(const workflow::LedInCamera& seen, const std::vector<Eigen::Vector2d>& spots) {
  Json points = Json::array();
  // From the newest back, so that it is among them.
  const std::size_t step = std::max<std::size_t>(1, (spots.size() + kMostSpots - 1) / kMostSpots);
  for (std::size_t age = 0; age < spots.size(); age += step) {
    const auto& spot = spots[spots.size() - 1 - age];
    if (spot.allFinite()) points.push_back({rounded(spot.x(), 1e4), rounded(spot.y(), 1e4)});
  }
  return {{"light_counts", rounded(seen.light_counts, 10.0)},
          {"highest_share", rounded(seen.highest_share, 1e4)},
          {"noise_counts", rounded(seen.noise_counts, 100.0)},
          {"occluded_share", rounded(seen.occluded_share, 1e4)},
          {"saturated_share", rounded(seen.saturated_share, 1e4)},
          {"spots", points}};
}

// Of each LED, of each camera; once the device runs.
Json seen_json(const pipeline::DeskState& state) {
  const auto& [scan, layout, facts] = state.granted;
  const std::size_t cameras = scan.cameras.size();
  Json leds = Json::array();
  for (std::size_t l = 0; l < scan.leds.size() && (l + 1) * cameras <= state.live.seen.size(); ++l) {
    leds.push_back(Json::array());
    for (std::size_t o = l * cameras; o < (l + 1) * cameras; ++o)
      leds.back().push_back(seen_json(state.live.seen[o], o < state.live.spots.size()
                                                              ? state.live.spots[o]
                                                              : decltype(state.live.spots[o]){}));
  }
  return leds;
}

Json live_json(const pipeline::DeskState& state) {
  const auto& live = state.live;
  return {{"frames", live.frames},
          {"acknowledged", live.acknowledged},
          {"dropped_by_device", live.dropped_by_device},
          {"dropped_here", live.dropped_here},
          {"recorded_s", rounded(live.recorded_s, 1e3)},
          {"guide", live.guide},
          {"seen", seen_json(state)}};
}

Json granted_json(const stream::ScanPlan& plan) {
  Json intensity = Json::array();
  for (const double one : plan.intensity) intensity.push_back(rounded(one, 1e3));
  return {
      {"leds", plan.leds}, {"cameras", plan.cameras}, {"rate_hz", plan.rate_hz}, {"intensity", intensity}};
}

std::unexpected<Error> unfit(const std::string& sentence) { return fail(Code::bad_input, sentence); }

bool holds_control(const std::string& text) {
  return std::ranges::any_of(text, [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7F;
  });
}

// A text, or a number as a text; nothing where it is not told.
Status take_line(const Json& json, const char* name, std::string& out) {
  if (!json.contains(name)) return {};
  const auto& value = json[name];
  if (!value.is_string() && !value.is_number())
    return unfit(fmt::format("\"{}\" is a text or a number", name));
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (holds_control(text)) return unfit(fmt::format("\"{}\" holds a control character", name));
  if (text.size() > kMostText) return unfit(fmt::format("\"{}\" is longer than {} bytes", name, kMostText));
  out = std::move(text);
  return {};
}

Status take_uri(const Json& json, std::string& uri) {
  if (!json.contains("uri") || !json["uri"].is_string())
    return unfit(R"("open" needs the address of a device, "uri")");
  if (auto s = take_line(json, "uri", uri); !s) return s;
  for (const char* scheme : {"sim:", "serial:", "comedi:"})
    if (uri.starts_with(scheme)) return {};
  return unfit(
      fmt::format("{}: is the address of no device that is attached; those begin with sim:, serial: or "
                  "comedi:",
                  printable(uri, 200)));
}

Status take_intensity(const Json& json, DeskRequest& request) {
  if (!json.contains("led") || !json["led"].is_number_unsigned() ||
      json["led"].get<std::uint64_t>() >= kMostRates)
    return unfit(R"("intensity" needs the number of an LED, "led", from 0)");
  if (!json.contains("value") || !json["value"].is_number())
    return unfit(R"("intensity" needs a "value" from 0.1 to 1)");
  request.led = json["led"].get<int>();
  request.intensity = json["value"].get<double>();
  return {};
}

Status take_lines(const Json& json, pipeline::Wanted& lines) {
  for (const auto& [name, text] : {std::pair{"leds", &lines.leds},
                                   {"rate_hz", &lines.rate_hz},
                                   {"duration_s", &lines.duration_s},
                                   {"subject", &lines.subject},
                                   {"trial", &lines.trial}})
    if (auto s = take_line(json, name, *text); !s) return s;
  return {};
}

std::vector<std::string_view> members_of(DeskAction action) {
  if (action == DeskAction::open) return {"do", "uri"};
  if (action == DeskAction::intensity) return {"do", "led", "value"};
  if (action == DeskAction::start) return {"do", "leds", "rate_hz", "duration_s", "subject", "trial"};
  return {"do"};
}

}  // namespace

Json desk_json(const pipeline::DeskState& state) {
  Json sources = Json::array(), check = Json::array();
  for (const auto& [uri, name, why] : state.sources)
    sources.push_back({{"uri", uri}, {"name", name}, {"state", why}});
  for (const auto& [text, good] : state.check) check.push_back({{"good", good}, {"text", text}});
  const bool is_open = state.step != DeskStep::source && state.step != DeskStep::ended;
  const bool runs = is_open && state.step != DeskStep::plan;
  const auto& wanted = state.wanted;
  return {{"step", to_string(state.step)},
          {"message", printable_sentence(state.message)},
          {"sources", sources},
          {"device", is_open ? device_json(state.device) : Json()},
          {"wanted",
           {{"source", wanted.source},
            {"leds", wanted.leds},
            {"rate_hz", wanted.rate_hz},
            {"duration_s", wanted.duration_s},
            {"subject", wanted.subject},
            {"trial", wanted.trial}}},
          {"granted", runs ? granted_json(state.granted.plan) : Json()},
          {"duration_s", state.duration_s},
          {"live", runs ? live_json(state) : Json()},
          {"check", check},
          {"kept", state.kept}};
}

Result<DeskRequest> parse_desk_request(std::string_view body, const pipeline::Wanted& now) {
  const auto json = Json::parse(body, nullptr, false);
  if (!json.is_object() || !json.contains("do") || !json["do"].is_string())
    return unfit(R"(need {"do": "record"} or the like as JSON)");
  const auto action = kActions.parse(json["do"].get<std::string>(), "action", Code::bad_input);
  if (!action) return std::unexpected(action.error());
  const auto known = members_of(*action);
  for (const auto& [name, value] : json.items())
    if (std::ranges::find(known, name) == known.end())
      return unfit(fmt::format("\"{}\" is no member of \"{}\"", printable(name, 60), kActions[*action]));
  DeskRequest request{.action = *action, .lines = now};
  Status taken;
  if (*action == DeskAction::open) taken = take_uri(json, request.uri);
  if (*action == DeskAction::intensity) taken = take_intensity(json, request);
  if (*action == DeskAction::start) taken = take_lines(json, request.lines);
  if (!taken) return std::unexpected(taken.error());
  return request;
}

void ask_desk(const DeskRequest& request, pipeline::DeskSession& session) {
  switch (request.action) {
    case DeskAction::look:
      return session.look_for_sources();
    case DeskAction::open:
      return session.open(request.uri);
    case DeskAction::leave_source:
      return session.leave_source();
    case DeskAction::start:
      return session.start(request.lines);
    case DeskAction::set_up:
      return session.set_up();
    case DeskAction::restart_guide:
      return session.restart_guide();
    case DeskAction::intensity:
      return session.set_intensity(request.led, request.intensity);
    case DeskAction::record:
      return session.record();
    case DeskAction::stop:
      return session.stop();
    case DeskAction::keep:
      return session.keep();
    case DeskAction::discard:
      return session.discard();
  }
}

}  // namespace kinemark::server
