// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/rig_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kinemark::stream {
namespace {

constexpr std::int64_t kProtocol = 1;

/// Ticks of a time, at most those of an hour so that they can be written.
std::int64_t ticks(double seconds, const SerialRigFacts& facts) {
  return std::llround(std::clamp(seconds, 0.0, 3600.0) * facts.clock_hz);
}

bool is_light(double intensity) { return intensity > 0.0 && intensity <= 1.0; }

Status check_plan(const ScanPlan& plan, const SerialRigFacts& facts) {
  const auto leds = static_cast<int>(plan.leds.size()), cameras = static_cast<int>(plan.cameras.size());
  if (leds < 1 || leds > facts.leds)
    return fail(Code::usage,
                fmt::format("{} lights 1 to {} LEDs; {} are asked for", facts.name, facts.leds, leds));
  if (cameras != facts.cameras)
    return fail(Code::usage,
                fmt::format("{} has {} cameras; {} are named", facts.name, facts.cameras, cameras));
  if (!(plan.rate_hz >= 0.0 && std::isfinite(plan.rate_hz)))
    return fail(Code::usage,
                fmt::format("a rate of {} Hz; need a positive number, or 0 for the highest", plan.rate_hz));
  if (!plan.intensity.empty() && plan.intensity.size() != plan.leds.size())
    return fail(Code::usage, fmt::format("{} intensities of {} LEDs", plan.intensity.size(), leds));
  if (!std::ranges::all_of(plan.intensity, is_light))
    return fail(Code::usage, "an intensity is a share of full light: above 0, up to 1");
  if (plan.timing.dark_slot && !facts.has_dark)
    return fail(Code::usage, fmt::format("{} has no dark slot", facts.name));
  if (plan.trigger == Trigger::digital_line && !facts.trigger)
    return fail(Code::usage, fmt::format("{} has no line that starts it", facts.name));
  return {};
}

std::unexpected<Error> refusal(const ScanPlan& wanted, const RigAnswer& answer, const SerialRigFacts& facts) {
  const auto least = answer.number("least"), most = answer.number("most");
  if (answer.text("why") != "period" || !least || !most || *least < 1 || *most < 1)
    return fail(Code::device, fmt::format("{} refuses the plan: {}", facts.name, answer.text("why")));
  const double highest = facts.clock_hz / static_cast<double>(*least),
               lowest = facts.clock_hz / static_cast<double>(*most);
  if (highest < lowest)
    return fail(Code::usage,
                fmt::format("{} LEDs with slots that long do not fit into the longest frame, {:.6g} s",
                            wanted.leds.size(), 1.0 / lowest));
  if (wanted.rate_hz < lowest && wanted.rate_hz > 0.0)
    return fail(Code::usage, fmt::format("{:.6g} Hz is too slow for {}: the lowest rate is {:.6g} Hz",
                                         wanted.rate_hz, facts.name, lowest));
  // Rounded down, so that what is named can be had.
  return fail(Code::usage, fmt::format("{} LED{} at {:.6g} Hz do not fit: the highest rate is {:.1f} Hz",
                                       wanted.leds.size(), wanted.leds.size() == 1 ? "" : "s", wanted.rate_hz,
                                       std::floor(10.0 * highest) / 10.0));
}

/// "255,128": L numbers in [1, levels] as shares of full light; empty when they are not.
std::vector<double> intensities(std::string_view text, std::size_t leds, int levels) {
  std::vector<double> out;
  while (!text.empty()) {
    const auto word = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    int level = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), level);
    if (error != std::errc() || end != word.data() + word.size() || level < 1 || level > levels) return {};
    out.push_back(static_cast<double>(level) / levels);
  }
  return out.size() == leds ? out : std::vector<double>();
}

data::Counts layout(const ScanPlan& plan, int bits) {
  auto out = data::Counts::zeros(plan.leds, plan.cameras, {.rate_hz = plan.rate_hz, .frames = 0},
                                 plan.timing.dark_slot);
  out.highest_code = static_cast<std::int16_t>((1 << bits) - 1);
  const auto leds = static_cast<int>(plan.leds.size()), cameras = static_cast<int>(plan.cameras.size());
  std::size_t at = 0;
  for (int l = 0; l < leds; ++l)
    for (int c = 0; c < cameras; ++c)
      for (int k = 0; k < 4; ++k)
        out.conversion_time_s[at++] = plan.timing.conversion_offset_s(l, c, k, cameras);
  if (!plan.timing.dark_slot) return out;
  at = 0;
  for (int c = 0; c < cameras; ++c)
    for (int k = 0; k < 4; ++k) out.dark_time_s[at++] = plan.timing.conversion_offset_s(leds, c, k, cameras);
  return out;
}

}  // namespace

Result<SerialRigFacts> serial_facts(const RigAnswer& answer) {
  if (answer.kind != "rig" || answer.number("protocol") != kProtocol)
    return fail(Code::device, fmt::format("speaks protocol '{}' of a rig; this program knows {}",
                                          answer.text("protocol"), kProtocol));
  const auto number = [&answer](std::string_view name) { return answer.number(name).value_or(0); };
  SerialRigFacts out;
  out.name = answer.text("name");
  out.version = answer.text("version");
  out.leds = static_cast<int>(std::clamp<std::int64_t>(number("leds"), 0, 254));
  out.cameras = static_cast<int>(std::clamp<std::int64_t>(number("cameras"), 0, 255));
  out.bits = static_cast<int>(std::clamp<std::int64_t>(number("bits"), 0, 15));
  out.clock_hz = static_cast<double>(number("clock"));
  out.settle = number("settle");
  out.conversion = number("conversion");
  out.off = number("off");
  out.longest = number("longest");
  out.period = number("period");
  out.hold = number("hold");
  out.levels = static_cast<int>(std::clamp<std::int64_t>(number("levels"), 0, 65'535));
  out.outputs = static_cast<int>(std::clamp<std::int64_t>(number("outputs"), 0, 64));
  out.has_dark = number("dark") != 0;
  out.trigger = number("trigger") != 0;
  out.highest_v = static_cast<double>(number("millivolts")) / 1000.0;
  const bool whole = out.leds > 0 && out.cameras > 0 && out.bits == kSerialBits && out.clock_hz >= 1.0 &&
                     out.settle > 0 && out.conversion > 0 && out.off > 0 && out.period > 0 && out.hold >= 0;
  if (!whole) return fail(Code::device, "says of itself what no rig can be");
  return out;
}

DeviceCapabilities serial_capabilities(const SerialRigFacts& facts) {
  DeviceCapabilities out;
  out.name = facts.name + " " + facts.version;
  out.most_leds = facts.leds;
  out.cameras = facts.cameras;
  out.bits = facts.bits;
  if (facts.highest_v > 0.0) out.ranges = {{.lowest_v = 0.0, .highest_v = facts.highest_v}};
  const auto seconds = [&](std::int64_t t) { return static_cast<double>(t) / facts.clock_hz; };
  out.fastest = {.settle_s = seconds(facts.settle + facts.hold),
                 .conversion_s = seconds(facts.conversion),
                 .off_s = seconds(facts.off - facts.hold)};
  out.lowest_rate_hz = facts.clock_hz / static_cast<double>(facts.period);
  out.sets_intensity = facts.levels > 1;
  out.has_dark_slot = facts.has_dark;
  out.digital_outputs = facts.outputs;
  out.triggers = {Trigger::at_once};
  if (facts.trigger) out.triggers.push_back(Trigger::digital_line);
  return out;
}

Result<std::string> plan_command(const ScanPlan& plan, const SerialRigFacts& facts) {
  if (auto s = check_plan(plan, facts); !s) return std::unexpected(s.error());
  // A conversion is of its sample, which follows its start: the rig is told when to start.
  const auto& timing = plan.timing;
  const auto hold = facts.hold;
  std::string out = fmt::format("plan {} {} {} {} {} {} {}", plan.leds.size(), timing.dark_slot ? 1 : 0,
                                plan.rate_hz > 0.0 ? ticks(1.0 / plan.rate_hz, facts) : 0,
                                std::max<std::int64_t>(0, ticks(timing.settle_s, facts) - hold),
                                ticks(timing.conversion_s, facts), ticks(timing.off_s, facts) + hold,
                                plan.trigger == Trigger::digital_line ? 1 : 0);
  if (facts.levels > 1)
    for (const double intensity : plan.intensity)
      out += fmt::format(" {}", std::max<std::int64_t>(1, std::llround(intensity * facts.levels)));
  return out;
}

Result<GrantedPlan> granted_plan(const ScanPlan& wanted, const RigAnswer& answer,
                                 const SerialRigFacts& facts) {
  if (answer.kind == "no") return refusal(wanted, answer, facts);
  const auto period = answer.number("period"), settle = answer.number("settle"),
             conversion = answer.number("conversion"), off = answer.number("off");
  const bool same = answer.kind == "plan" &&
                    answer.number("leds") == static_cast<std::int64_t>(wanted.leds.size()) &&
                    answer.number("dark") == (wanted.timing.dark_slot ? 1 : 0);
  if (!same || !period || !settle || !conversion || !off || *period < 1 || *settle < 1 || *conversion < 1 ||
      *off < 1)
    return fail(Code::device, fmt::format("{} grants a plan that was not asked for", facts.name));
  const auto seconds = [&](std::int64_t t) { return static_cast<double>(t) / facts.clock_hz; };
  GrantedPlan out;
  out.plan = wanted;
  out.plan.rate_hz = facts.clock_hz / static_cast<double>(*period);
  out.plan.timing.settle_s = seconds(*settle + facts.hold);
  out.plan.timing.conversion_s = seconds(*conversion);
  out.plan.timing.off_s = seconds(*off - facts.hold);
  out.plan.intensity = facts.levels > 1 ? intensities(answer.text("level"), wanted.leds.size(), facts.levels)
                                        : std::vector<double>(wanted.leds.size(), 1.0);
  if (!(frame_shape(wanted).slots * out.plan.timing.slot_s(facts.cameras) <= 1.000001 / out.plan.rate_hz))
    return fail(Code::device, fmt::format("{} grants slots that are longer than its frames", facts.name));
  if (out.plan.intensity.empty())
    return fail(Code::device, fmt::format("{} grants intensities that were not asked for", facts.name));
  out.layout = layout(out.plan, facts.bits);
  return out;
}

FrameShape frame_shape(const ScanPlan& plan) {
  return {.slots = static_cast<int>(plan.leds.size()) + (plan.timing.dark_slot ? 1 : 0),
          .cameras = static_cast<int>(plan.cameras.size())};
}

}  // namespace kinemark::stream
