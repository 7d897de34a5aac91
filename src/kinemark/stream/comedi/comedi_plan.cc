// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/comedi/comedi_plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "kinemark/core/check.h"

namespace kinemark::stream {
namespace {

constexpr int kMostBits = 15;  // of data::Counts
constexpr double kNs = 1e9;
constexpr double kLongestScan_s = 4.0;  // comedi's nanoseconds have 32 bits

int converter_bits(const BoardFacts& facts) { return std::bit_width(facts.highest_code); }

Status check_plan(const ScanPlan& plan, const BoardFacts& facts) {
  const auto cameras = static_cast<int>(plan.cameras.size());
  if (plan.leds.empty()) return fail(Code::usage, "a plan has one LED or more");
  if (cameras < 1 || 4 * cameras > facts.channels)
    return fail(Code::usage, fmt::format("{} has inputs for {} cameras, {} channels; {} are named",
                                         facts.name, facts.channels / 4, facts.channels, cameras));
  if (!(plan.rate_hz >= 0.0 && std::isfinite(plan.rate_hz)))
    return fail(Code::usage,
                fmt::format("a rate of {} Hz; need a positive number, or 0 for the highest", plan.rate_hz));
  if (!(plan.timing.conversion_s >= 0.0 && plan.timing.conversion_s < 1.0))
    return fail(Code::usage,
                fmt::format("conversions of {:.6g} s; need less than 1 s", plan.timing.conversion_s));
  if (plan.timing.dark_slot) return fail(Code::usage, fmt::format("{} has no dark slot", facts.name));
  if (std::ranges::any_of(plan.intensity, [](double i) { return i != 1.0; }))
    return fail(Code::usage, fmt::format("{} lights no LEDs: their light cannot be set", facts.name));
  if (plan.trigger != Trigger::at_once)
    return fail(Code::usage, fmt::format("{} has no line that starts it", facts.name));
  return {};
}

}  // namespace

int count_bits(const BoardFacts& facts) { return std::min(kMostBits, converter_bits(facts)); }

DeviceCapabilities board_capabilities(const BoardFacts& facts) {
  DeviceCapabilities out;
  out.name = facts.name;
  out.cameras = facts.channels / 4;
  out.bits = count_bits(facts);
  out.ranges = facts.ranges;
  out.fastest = {
      .settle_s = 0.0, .conversion_s = static_cast<double>(facts.conversion_ns) / kNs, .off_s = 0.0};
  out.lowest_rate_hz = 1.0 / kLongestScan_s;
  out.analog_outputs = facts.analog_outputs;
  out.digital_outputs = facts.digital_outputs;
  out.triggers = {Trigger::at_once};
  return out;
}

Result<ScanClock> scan_clock(const ScanPlan& plan, const BoardFacts& facts) {
  if (auto s = check_plan(plan, facts); !s) return std::unexpected(s.error());
  const auto leds = static_cast<double>(plan.leds.size());
  const auto channels = 4 * static_cast<std::int64_t>(plan.cameras.size());
  ScanClock out;
  out.conversion_ns =
      std::max<std::int64_t>(facts.conversion_ns, std::llround(plan.timing.conversion_s * kNs));
  const auto shortest = channels * out.conversion_ns;
  out.scan_ns = shortest;
  if (plan.rate_hz == 0.0) return out;
  const double scan_ns = kNs / (plan.rate_hz * leds);
  if (scan_ns > kLongestScan_s * kNs)
    return fail(Code::usage, fmt::format("{:.6g} Hz is too slow: the lowest rate is {:.6g} Hz", plan.rate_hz,
                                         1.0 / (kLongestScan_s * leds)));
  out.scan_ns = std::llround(scan_ns);
  if (out.scan_ns < shortest)
    return fail(Code::usage,
                fmt::format("{} LED{} at {:.6g} Hz do not fit: the highest rate is {:.1f} Hz",
                            plan.leds.size(), plan.leds.size() == 1 ? "" : "s", plan.rate_hz,
                            std::floor(10.0 * kNs / (leds * static_cast<double>(shortest))) / 10.0));
  return out;
}

GrantedPlan granted_scans(const ScanPlan& plan, const ScanClock& granted, const BoardFacts& facts) {
  const auto leds = static_cast<int>(plan.leds.size()), cameras = static_cast<int>(plan.cameras.size());
  GrantedPlan out{.plan = plan, .layout = {}};
  const double scan_s = static_cast<double>(granted.scan_ns) / kNs;
  auto& timing = out.plan.timing;
  out.plan.rate_hz = 1.0 / (scan_s * leds);
  timing.settle_s = 0.0;
  timing.conversion_s = static_cast<double>(granted.conversion_ns) / kNs;
  timing.off_s = std::max(0.0, scan_s - 4 * cameras * timing.conversion_s);
  out.plan.intensity.assign(plan.leds.size(), 1.0);
  out.layout =
      data::Counts::zeros(plan.leds, plan.cameras, {.rate_hz = out.plan.rate_hz, .frames = 0}, false);
  out.layout.highest_code = static_cast<std::int16_t>((1 << count_bits(facts)) - 1);
  std::size_t at = 0;
  for (int l = 0; l < leds; ++l)
    for (int k = 0; k < 4 * cameras; ++k)
      out.layout.conversion_time_s[at++] = l * scan_s + k * timing.conversion_s;
  return out;
}

void append_counts(std::span<const std::byte> samples, std::size_t sample_bytes, const BoardFacts& facts,
                   std::vector<std::int16_t>& counts) {
  check(sample_bytes == 2 || sample_bytes == 4, "a sample has 2 or 4 bytes");
  check(samples.size() % sample_bytes == 0, "samples are whole");
  const int surplus = converter_bits(facts) - count_bits(facts);
  for (std::size_t i = 0; i < samples.size(); i += sample_bytes) {
    std::uint32_t code = 0;
    std::memcpy(&code, samples.data() + i, sample_bytes);
    counts.push_back(static_cast<std::int16_t>(std::min(code, facts.highest_code) >> surplus));
  }
}

}  // namespace kinemark::stream
