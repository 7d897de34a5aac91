// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/replay_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/io/rate.h"

namespace kinemark::pipeline {
namespace {

using stream::ReadResult;

constexpr std::int64_t kMostInBlock = 256;

/// The same slots at another rate.
void stretch(data::Counts& layout, double rate_hz) {
  const double factor = layout.time.rate_hz / rate_hz;
  for (auto* times : {&layout.conversion_time_s, &layout.dark_time_s})
    for (double& time_s : *times) time_s *= factor;
  layout.time.rate_hz = rate_hz;
}

}  // namespace

ReplayDevice::ReplayDevice(std::filesystem::path file, io::CountsReader reader,
                           std::shared_ptr<stream::HostClock> clock)
    : file_(std::move(file)),
      reader_(std::move(reader)),
      clock_(std::move(clock)),
      layout_(reader_.layout()) {}

Result<std::unique_ptr<stream::Device>> ReplayDevice::open(AddressSettings settings,
                                                           std::shared_ptr<stream::HostClock> clock) {
  std::error_code ignored;
  if (std::filesystem::exists(settings.uri().substr(settings.scheme().size() + 1), ignored))
    settings.take_all_as_name();
  const double rate_hz = settings.number("rate", 0.0, io::kSlowest_hz, 1e5);
  const bool fast = settings.flag("fast");
  if (auto s = settings.check(); !s) return std::unexpected(s.error());
  if (settings.what().empty()) return fail(Code::usage, "replay: names no file; need replay:FILE.mcap");
  const std::filesystem::path file(settings.what());
  auto reader = io::CountsReader::open(file);
  if (!reader) return std::unexpected(reader.error());
  std::unique_ptr<ReplayDevice> out(new ReplayDevice(file, std::move(*reader), std::move(clock)));
  if (rate_hz > 0.0) stretch(out->layout_, rate_hz);
  const auto& layout = out->layout_;
  out->capabilities_ = {.name = "recording " + file.filename().string(),
                        .most_leds = static_cast<int>(layout.led_count()),
                        .leds = layout.leds,
                        .camera_names = layout.cameras,
                        .cameras = static_cast<int>(layout.camera_count()),
                        .bits = static_cast<int>(std::bit_width(static_cast<unsigned>(layout.highest_code))),
                        .ranges = {},
                        .fastest = {.dark_slot = layout.has_dark_slot()},
                        .lowest_rate_hz = layout.time.rate_hz,
                        .has_dark_slot = layout.has_dark_slot(),
                        .pauses = true,
                        .triggers = {stream::Trigger::at_once},
                        .speed = fast ? 0.0 : 1.0};
  return out;
}

Result<stream::GrantedPlan> ReplayDevice::configure(const stream::ScanPlan& plan) {
  check(!running_, "a device that runs is not configured");
  stream::GrantedPlan out{.plan = stream::with_names(plan, capabilities_), .layout = layout_, .facts = {}};
  auto& granted = out.plan;
  if (granted.leds.size() != layout_.leds.size() || granted.cameras.size() != layout_.cameras.size())
    return fail(Code::usage, fmt::format("{}: holds {} LEDs and {} cameras; all of them are replayed",
                                         file_.string(), layout_.leds.size(), layout_.cameras.size()));
  if (granted.rate_hz != 0.0 && std::abs(granted.rate_hz / layout_.time.rate_hz - 1.0) > 1e-9)
    return fail(Code::usage, fmt::format("{}: was recorded at {:.6g} Hz; another rate needs "
                                         "replay:FILE?rate=HZ",
                                         file_.string(), layout_.time.rate_hz));
  if (!granted.intensity.empty() || granted.trigger != stream::Trigger::at_once)
    return fail(Code::usage,
                fmt::format("{}: is a recording; its LEDs and its beginning cannot be set", file_.string()));
  granted.rate_hz = layout_.time.rate_hz;
  granted.timing.dark_slot = layout_.has_dark_slot();
  out.layout.leds = granted.leds;
  out.layout.cameras = granted.cameras;
  if (auto s = out.layout.validate(); !s) return fail(Code::usage, s.error().message);
  return out;
}

Status ReplayDevice::look_ahead() {
  const auto more = reader_.next(ahead_);
  if (!more) return std::unexpected(more.error());
  has_ahead_ = *more;
  return {};
}

Status ReplayDevice::start() {
  check(!running_, "a device that runs is not started");
  auto reader = io::CountsReader::open(file_);
  if (!reader) return std::unexpected(reader.error());
  reader_ = std::move(*reader);
  if (auto s = look_ahead(); !s) return s;
  running_ = true;
  expected_ = 0;
  start_ns_ = clock_->now_ns();
  return {};
}

std::int64_t ReplayDevice::due_ns(std::int64_t frame) const {
  return start_ns_ +
         static_cast<std::int64_t>(std::ceil(1e9 * static_cast<double>(frame + 1) / layout_.time.rate_hz));
}

void ReplayDevice::take_frame(stream::Block& block) {
  block.counts.insert(block.counts.end(), ahead_.counts.begin(), ahead_.counts.end());
  block.dark.insert(block.dark.end(), ahead_.dark.begin(), ahead_.dark.end());
  block.flags.insert(block.flags.end(), ahead_.flags.begin(), ahead_.flags.end());
  expected_ = ahead_.number + 1;
  ++block.frames;
}

Result<ReadResult> ReplayDevice::read(stream::Block& block, std::chrono::milliseconds timeout) {
  check(running_, "a device is read once it is started");
  block.host_before_ns = clock_->now_ns();
  if (!has_ahead_) return ReadResult::ended;
  const bool waits = capabilities_.speed > 0.0;
  if (waits) {
    const auto until = block.host_before_ns + std::chrono::nanoseconds(timeout).count();
    const bool in_time = due_ns(ahead_.number) <= until;
    clock_->sleep_until(in_time ? due_ns(ahead_.number) : until);
    if (!in_time) return ReadResult::timeout;
  }
  block.host_after_ns = clock_->now_ns();
  block.first_frame = ahead_.number;
  block.gap = ahead_.number != expected_;
  block.overflow = false;
  block.frames = 0;
  block.counts.clear();
  block.dark.clear();
  block.flags.clear();
  do {
    take_frame(block);
    if (auto s = look_ahead(); !s) return std::unexpected(s.error());
  } while (has_ahead_ && ahead_.number == expected_ && block.frames < kMostInBlock &&
           (!waits || due_ns(expected_) <= block.host_after_ns));
  block.saturated =
      std::ranges::any_of(block.flags, [](std::uint8_t f) { return (f & data::kCountSaturated) != 0; });
  return ReadResult::block;
}

Status ReplayDevice::stop() {
  running_ = false;
  return {};
}

Status ReplayDevice::reopen() { return {}; }

Status ReplayDevice::write_analog(int channel, double /*volts*/) {
  return fail(Code::usage, fmt::format("a recording has no analog output {}", channel));
}

Status ReplayDevice::write_digital(int line, bool /*high*/) {
  return fail(Code::usage, fmt::format("a recording has no digital output {}", line));
}

}  // namespace kinemark::pipeline
