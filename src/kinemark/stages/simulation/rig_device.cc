// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/rig_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"

namespace kinemark::simulation {
namespace {

using stream::ReadResult;

constexpr std::int64_t kEndless = std::int64_t{1} << 32;  ///< frames that a recording can number
constexpr std::int64_t kMostInBlock = 256;
constexpr double kBright = 30.0, kNoisy_counts = 20.0;
constexpr std::uint64_t kNoisyStream = std::uint64_t{1} << 40;  ///< of the fault's noise, far from all others
constexpr std::uint64_t kGlowStream = kNoisyStream + (std::uint64_t{1} << 40);  // likewise, of an afterglow

Status check_intensities(const std::vector<double>& intensity) {
  for (const double i : intensity)
    if (!(i > 0.0 && i <= 1.0))
      return fail(Code::usage, fmt::format("an LED of intensity {}; need above 0, at most 1", i));
  return {};
}

}  // namespace

Status RigDeviceOptions::check() const {
  const auto not_negative = [](double x) { return x >= 0.0 && std::isfinite(x); };
  if (!not_negative(rate_hz) || !not_negative(duration_s) || !not_negative(speed) ||
      !not_negative(unplug_at_s) || !not_negative(unplug_for_s))
    return fail(Code::usage, "rate, duration, speed and times of a simulated device cannot be negative");
  if (!(std::abs(clock_ppm) < 1e5))
    return fail(Code::usage, fmt::format("a clock that is {} ppm fast; need less than 100000", clock_ppm));
  if (!(buffer_s > 0.0 && buffer_s <= 3600.0))
    return fail(Code::usage, fmt::format("a buffer of {} s; need above 0, at most 3600", buffer_s));
  return {};
}

Result<std::unique_ptr<RigDevice>> RigDevice::create(PhysicalRig rig, RigScene scene,
                                                     const RigDeviceOptions& options,
                                                     std::shared_ptr<stream::HostClock> clock) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  kinemark::check(clock != nullptr && static_cast<bool>(scene.led), "a device has a clock and a scene");
  return std::unique_ptr<RigDevice>(
      new RigDevice(std::move(rig), std::move(scene), options, std::move(clock)));
}

RigDevice::RigDevice(PhysicalRig rig, RigScene scene, const RigDeviceOptions& options,
                     std::shared_ptr<stream::HostClock> clock)
    : rig_(std::move(rig)), scene_(std::move(scene)), options_(options), clock_(std::move(clock)) {
  capabilities_.name = "simulated rig";
  capabilities_.leds = scene_.leds;
  capabilities_.most_leds = static_cast<int>(scene_.leds.size());
  capabilities_.cameras = rig_.rig.camera_count();
  for (const auto& camera : rig_.rig.cameras) capabilities_.camera_names.push_back(camera.name);
  capabilities_.bits = rig_.rig.electronics.bits;
  capabilities_.fastest = rig_.rig.timing;
  capabilities_.lowest_rate_hz = 0.01;
  capabilities_.sets_intensity = true;
  capabilities_.has_dark_slot = rig_.rig.timing.dark_slot;
  capabilities_.fastest = rig_.rig.timing;
  capabilities_.triggers = {stream::Trigger::at_once};
  capabilities_.speed = options_.speed;
}

Result<RigRecordingOptions> RigDevice::grant(stream::ScanPlan& plan) const {
  plan = stream::with_names(std::move(plan), capabilities_);
  const int leds = static_cast<int>(plan.leds.size());
  if (leds > capabilities_.most_leds)
    return fail(Code::usage, fmt::format("{} LEDs were asked for; the simulated scene has {}", leds,
                                         capabilities_.most_leds));
  if (static_cast<int>(plan.cameras.size()) != capabilities_.cameras)
    return fail(Code::usage, fmt::format("{} cameras were asked for; the simulated rig has {}",
                                         plan.cameras.size(), capabilities_.cameras));
  if (plan.trigger != stream::Trigger::at_once)
    return fail(Code::usage, "the simulated rig has no digital line to wait for");
  if (auto s = check_intensities(plan.intensity); !s) return std::unexpected(s.error());
  plan.timing = rig_.rig.timing;
  if (plan.rate_hz == 0.0) plan.rate_hz = options_.rate_hz;
  if (plan.rate_hz == 0.0) plan.rate_hz = plan.timing.highest_rate_hz(leds, capabilities_.cameras);
  RigRecordingOptions out{.rate_hz = plan.rate_hz,
                          .frames = 1,
                          .intensity = plan.intensity,
                          .seed = options_.seed,
                          .stream = options_.stream};
  if (auto s = out.check(rig_.rig, leds); !s) return std::unexpected(s.error());
  const double frames = options_.duration_s * plan.rate_hz;
  out.frames = frames > 0.0 && frames < static_cast<double>(kEndless)
                   ? std::max<std::int64_t>(1, std::llround(frames))
                   : kEndless;
  return out;
}

Result<stream::GrantedPlan> RigDevice::configure(const stream::ScanPlan& plan) {
  kinemark::check(!running_, "a device that runs is not configured");
  stream::GrantedPlan out{.plan = plan, .layout = {}, .facts = {}};
  auto recording = grant(out.plan);
  if (!recording) return std::unexpected(recording.error());
  recording_ = std::move(*recording);
  plant_faults(out.plan.leds.size());
  layout_ = internal::layout_of(rig_, out.plan.leds, {.rate_hz = recording_.rate_hz, .t0_s = 0.0});
  layout_.cameras = out.plan.cameras;
  if (auto s = layout_.validate(); !s) return fail(Code::usage, s.error().message);
  configured_ = true;
  out.layout = layout_;
  out.facts = {{"seed", fmt::format("{}", options_.seed)}};
  return out;
}

void RigDevice::plant_faults(std::size_t leds) {
  auto& intensity = recording_.intensity;
  if (intensity.empty()) intensity.assign(leds, 1.0);
  const auto times = [&](int led, double factor) {
    if (led > 0 && static_cast<std::size_t>(led) <= leds)
      intensity[static_cast<std::size_t>(led) - 1] *= factor;
  };
  times(options_.dark_led, 0.0);
  times(options_.bright_led, kBright);
}

// The noise that the fault adds to one channel, in every slot.
void RigDevice::disturb(std::int64_t frame, std::int16_t* counts, std::int16_t* dark) const {
  Random random(options_.seed, kNoisyStream + static_cast<std::uint64_t>(frame));
  const auto add = [&](std::int16_t& count) {
    const long noisy = std::lround(count + kNoisy_counts * random.gaussian());
    count = static_cast<std::int16_t>(std::clamp(noisy, 0L, static_cast<long>(layout_.highest_code)));
  };
  const auto channels = 4 * layout_.cameras.size(),
             which = static_cast<std::size_t>(options_.noisy_channel) - 1;
  for (std::size_t led = 0; led < layout_.leds.size(); ++led) add(counts[led * channels + which]);
  if (layout_.has_dark_slot()) add(dark[which]);
}

// The last LED's slot comes before the dark one. Counts are whole already, so that what is added is rounded
// at random: its mean is right.
void RigDevice::glow_on(std::int64_t frame, const std::int16_t* counts, std::int16_t* dark) const {
  Random random(options_.seed, kGlowStream + static_cast<std::uint64_t>(frame));
  const auto channels = 4 * layout_.cameras.size();
  const std::int16_t* last = counts + (layout_.leds.size() - 1) * channels;
  for (std::size_t k = 0; k < channels; ++k) {
    const auto glowing = static_cast<long>(dark[k] + options_.afterglow * last[k] + random.uniform());
    dark[k] = static_cast<std::int16_t>(std::min(glowing, static_cast<long>(layout_.highest_code)));
  }
}

Status RigDevice::start() {
  kinemark::check(configured_ && !running_, "a device is started once it is configured");
  running_ = true;
  unplugged_ = was_unplugged_ = gap_ = false;
  next_ = 0;
  start_ns_ = clock_->now_ns();
  return {};
}

std::int64_t RigDevice::due_ns(std::int64_t frame) const {
  const double rate_hz = recording_.rate_hz * options_.speed * (1.0 + 1e-6 * options_.clock_ppm);
  return start_ns_ + static_cast<std::int64_t>(std::ceil(1e9 * static_cast<double>(frame + 1) / rate_hz));
}

std::int64_t RigDevice::ended_frames(std::int64_t now_ns) const {
  if (options_.speed == 0.0) return std::min(next_ + kMostInBlock, recording_.frames);
  const double rate_hz = recording_.rate_hz * options_.speed * (1.0 + 1e-6 * options_.clock_ppm);
  auto frames = static_cast<std::int64_t>(1e-9 * static_cast<double>(now_ns - start_ns_) * rate_hz);
  while (due_ns(frames) <= now_ns) ++frames;
  while (frames > 0 && due_ns(frames - 1) > now_ns) --frames;
  return std::min(frames, recording_.frames);
}

bool RigDevice::is_unplugged(std::int64_t now_ns) const {
  if (options_.unplug_at_s == 0.0 || was_unplugged_) return false;
  if (options_.speed == 0.0) return static_cast<double>(next_) >= options_.unplug_at_s * recording_.rate_hz;
  return 1e-9 * static_cast<double>(now_ns - start_ns_) * options_.speed >= options_.unplug_at_s;
}

void RigDevice::skip_what_is_lost(std::int64_t ended, stream::Block& block) {
  block.overflow = false;
  if (options_.speed > 0.0) {
    const auto kept =
        std::max<std::int64_t>(1, std::llround(options_.buffer_s * recording_.rate_hz * options_.speed));
    block.overflow = ended - next_ > kept;
    next_ = std::max(next_, ended - kept);
  }
  block.gap = std::exchange(gap_, false) || block.overflow;
}

void RigDevice::fill(std::int64_t frames, stream::Block& block) {
  const auto observations = layout_.leds.size() * layout_.cameras.size();
  const auto n = static_cast<std::size_t>(frames);
  block.first_frame = next_;
  block.frames = frames;
  block.counts.resize(4 * n * observations);
  block.dark.resize(n * layout_.dark_time_s.size());
  block.flags.assign(n * observations, 0);
  const internal::FrameConverter converter(rig_, scene_, recording_, layout_);
  for (std::size_t i = 0; i < n; ++i) {
    std::int16_t* counts = block.counts.data() + 4 * i * observations;
    std::int16_t* dark = block.dark.data() + i * layout_.dark_time_s.size();
    converter.convert(next_,
                      {.counts = counts, .dark = dark, .flags = block.flags.data() + i * observations});
    if (options_.noisy_channel > 0) disturb(next_, counts, dark);
    if (options_.afterglow > 0.0 && layout_.has_dark_slot()) glow_on(next_, counts, dark);
    ++next_;
  }
  block.saturated = std::ranges::any_of(block.flags, [](std::uint8_t f) { return f != 0; });
}

Result<ReadResult> RigDevice::read(stream::Block& block, std::chrono::milliseconds timeout) {
  kinemark::check(running_, "a device is read once it is started");
  block.host_before_ns = clock_->now_ns();
  if (unplugged_ || is_unplugged(block.host_before_ns)) {
    unplugged_ = true;
    return fail(Code::device, "the simulated rig is unplugged; put its plug back");
  }
  if (next_ >= recording_.frames) return ReadResult::ended;
  if (options_.speed > 0.0) {
    const auto until = block.host_before_ns + std::chrono::nanoseconds(timeout).count();
    const bool in_time = due_ns(next_) <= until;
    clock_->sleep_until(in_time ? due_ns(next_) : until);
    if (!in_time) return ReadResult::timeout;
  }
  block.host_after_ns = clock_->now_ns();
  const auto ended = ended_frames(block.host_after_ns);
  skip_what_is_lost(ended, block);
  fill(std::min(ended - next_, kMostInBlock), block);
  return ReadResult::block;
}

Status RigDevice::stop() {
  running_ = false;
  return {};
}

Status RigDevice::reopen() {
  if (!unplugged_) return {};
  const auto now_ns = clock_->now_ns();
  const double away_s = options_.unplug_at_s + options_.unplug_for_s;
  if (options_.speed == 0.0) {
    next_ += std::llround(options_.unplug_for_s * recording_.rate_hz);
  } else if (1e-9 * static_cast<double>(now_ns - start_ns_) * options_.speed < away_s) {
    return fail(Code::device, "the simulated rig is still unplugged; put its plug back");
  } else {
    next_ = ended_frames(now_ns);
  }
  unplugged_ = false;
  was_unplugged_ = gap_ = true;
  return {};
}

Status RigDevice::write_analog(int channel, double /*volts*/) {
  return fail(Code::usage, fmt::format("the simulated rig has no analog output {}", channel));
}

Status RigDevice::write_digital(int line, bool /*high*/) {
  return fail(Code::usage, fmt::format("the simulated rig has no digital output {}", line));
}

}  // namespace kinemark::simulation
