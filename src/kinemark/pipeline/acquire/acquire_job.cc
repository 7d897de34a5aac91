// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/acquire_job.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <system_error>
#include <thread>

#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/acquire/check_up.h"
#include "kinemark/pipeline/acquire/led_names.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "kinemark/pipeline/acquire/recording_room.h"
#include "kinemark/pipeline/acquire/trial_notes.h"
#include "kinemark/pipeline/files/address_settings.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/session/session.h"
#include "kinemark/pipeline/session/trial_name.h"

namespace kinemark::pipeline {
namespace {

using std::chrono::milliseconds;
using Steady = std::chrono::steady_clock;

constexpr milliseconds kPoll{100};
constexpr double kMostFrames = 4294967295.0;
constexpr double kCheckUp_s = 10.0;

Result<std::vector<double>> intensities(const AcquireJob& job, const std::vector<std::string>& leds) {
  std::vector<double> out;
  if (job.intensity.empty()) return out;
  out.assign(leds.size(), 1.0);
  for (const auto& [name, value] : job.intensity) {
    if (!name.empty() && std::ranges::count(leds, name) == 0)
      return fail(Code::usage, fmt::format("there is no LED '{}'; there are {}", name, join(leds)));
    for (std::size_t l = 0; l < leds.size(); ++l)
      if (name.empty() || leds[l] == name) out[l] = value;
  }
  return out;
}

Result<stream::ScanPlan> wanted(const AcquireJob& job, const stream::DeviceCapabilities& device) {
  auto leds = parse_leds(job.leds, device);
  if (!leds) return fail_at(job.source, leds.error());
  stream::ScanPlan out{
      .leds = std::move(*leds), .rate_hz = job.rate_hz, .timing = stream::usual_timing(device)};
  auto intensity = intensities(job, out.leds);
  if (!intensity) return std::unexpected(intensity.error());
  if (!intensity->empty() && !device.sets_intensity)
    return fail(Code::usage, fmt::format("{}: cannot set the intensity of its LEDs", job.source));
  out.intensity = std::move(*intensity);
  if (job.begin.kind == TrialBegin::Kind::digital) {
    if (std::ranges::count(device.triggers, stream::Trigger::digital_line) == 0)
      return fail(Code::usage, fmt::format("{}: has no digital line to wait for", job.source));
    out.trigger = stream::Trigger::digital_line;
  }
  return out;
}

Result<std::optional<BrightnessTrigger>> brightness(const AcquireJob& job,
                                                    const std::vector<std::string>& leds) {
  if (job.begin.kind != TrialBegin::Kind::threshold) return std::nullopt;
  BrightnessTrigger out{.counts = job.begin.value};
  if (job.begin.led.empty()) return out;
  const auto at = std::ranges::find(leds, job.begin.led);
  if (at == leds.end())
    return fail(Code::usage, fmt::format("there is no LED '{}'; there are {}", job.begin.led, join(leds)));
  out.led = static_cast<int>(at - leds.begin());
  return out;
}

/// Of both lengths the shorter one; 0: neither was given.
double duration_of(const AcquireJob& job) {
  return job.check_up && job.duration_s == 0.0 && job.frames == 0 ? kCheckUp_s : job.duration_s;
}

std::int64_t frames_of(const AcquireJob& job, double rate_hz) {
  const double duration_s =
      job.check_up && job.duration_s == 0.0 && job.frames == 0 ? kCheckUp_s : job.duration_s;
  if (duration_s == 0.0) return job.frames;
  const auto frames = std::max<std::int64_t>(1, std::llround(std::min(duration_s * rate_hz, kMostFrames)));
  return job.frames > 0 ? std::min(frames, job.frames) : frames;
}

bool asked_to_stop(const AcquireJob& job) { return job.stop && job.stop(); }

/// false: it was stopped meanwhile.
bool wait_for_begin(const AcquireJob& job, const std::function<bool()>& wait_for_key) {
  if (job.begin.kind == TrialBegin::Kind::key) return !wait_for_key || wait_for_key();
  if (job.begin.kind != TrialBegin::Kind::time) return true;
  const auto until = Steady::now() + std::chrono::duration<double>(job.begin.value);
  while (Steady::now() < until) {
    if (asked_to_stop(job)) return false;
    std::this_thread::sleep_until(std::min<Steady::time_point>(
        std::chrono::time_point_cast<Steady::duration>(until), Steady::now() + kPoll));
  }
  return true;
}

/// Until the recorder has ended, or is asked to.
void watch(const AcquireJob& job, Recorder& recorder) {
  auto next = Steady::now() + std::chrono::seconds(1);
  bool was_away = false, stopped = false;
  while (!recorder.wait_for(kPoll)) {
    const auto progress = recorder.progress();
    if (job.say && progress.away != was_away)
      job.say(progress.away ? "the device does not answer: look at its plug; what came is kept, Ctrl-C ends"
                            : "the device is back; the recording goes on");
    was_away = progress.away;
    if (!stopped && asked_to_stop(job)) {
      recorder.stop();
      stopped = true;
    }
    if (Steady::now() < next) continue;
    next += std::chrono::seconds(1);
    if (job.each_second) job.each_second(progress);
  }
}

Status check_numbers(const AcquireJob& job) {
  if (!(job.rate_hz >= 0.0) || !std::isfinite(job.rate_hz) || !(job.duration_s >= 0.0) ||
      !std::isfinite(job.duration_s) || job.frames < 0)
    return fail(Code::usage, "rate, duration and frames cannot be negative");
  return {};
}

/// A recording to write, or none for a check-up.
Status check_output(const AcquireJob& job) {
  if (!job.check_up) return check_ending(job.output, {".mcap"}, "a recording");
  if (!job.output.empty())
    return fail(Code::usage, "a check-up keeps nothing; leave --output away, or --check");
  return {};
}

/// What there is to know once the recorder has ended.
void conclude(const AcquireJob& job, AcquireOutcome& out) {
  if (job.check_up) {
    out.notes = check_up(out.recorded, out.plan);
    out.gates = {check_up_gate(out.notes)};
    return;
  }
  out.notes = describe_trial(out.recorded, out.plan.layout);
  out.gates = {missing_gate(out.recorded.progress)};
  if (out.recorded.progress.begun) {
    out.written = {job.output};
    return;
  }
  std::error_code none;
  std::filesystem::remove(job.output, none);  // not a frame is in it
  out.gates.push_back({.name = "begun",
                       .passed = false,
                       .value = 0.0,
                       .bound = 1.0,
                       .unit = "trials",
                       .sentence = out.notes.front().text});
}

Result<AcquireOutcome> record_trial(const AcquireJob& job, const std::function<bool()>& wait_for_key) {
  if (auto s = check_output(job); !s) return std::unexpected(s.error());
  if (auto s = check_apart(job, {job.output}, {AddressSettings(job.source).what()}); !s)
    return std::unexpected(s.error());
  auto device = open_device(job.source, job.seed);
  if (!device) return std::unexpected(device.error());
  const auto& capabilities = (*device)->capabilities();
  const auto plan = wanted(job, capabilities);
  if (!plan) return std::unexpected(plan.error());
  auto granted = (*device)->configure(*plan);
  if (!granted) return std::unexpected(granted.error());
  const auto begin = brightness(job, granted->plan.leds);
  if (!begin) return std::unexpected(begin.error());
  if (auto room = job.check_up ? Status() : check_room(job.output, job.force, *granted, duration_of(job));
      !room)
    return std::unexpected(room.error());
  if (!wait_for_begin(job, wait_for_key)) return fail(Code::cancelled, "stopped before the trial began");
  auto recorder = Recorder::start(**device, *granted,
                                  {.file = job.output,
                                   .recording = {.force = job.force, .sync = job.sync},
                                   .metadata = acquisition_metadata(job, *granted, capabilities),
                                   .frames = frames_of(job, granted->plan.rate_hz),
                                   .begin = *begin});
  if (!recorder) return std::unexpected(recorder.error());
  if (job.say)
    job.say(fmt::format("{} {} LEDs at {} cameras, {:.6g} frames per second",
                        job.check_up ? "looks at" : "records", granted->layout.led_count(),
                        granted->layout.camera_count(), granted->plan.rate_hz));
  watch(job, **recorder);
  AcquireOutcome out;
  out.recorded = (*recorder)->finish();
  out.plan = std::move(*granted);
  conclude(job, out);
  return out;
}

/// The next trial of a session, which it becomes part of once it has ended.
Result<AcquireOutcome> record_in_session(const AcquireJob& asked, const std::function<bool()>& wait_for_key) {
  if (asked.check_up || !asked.output.empty())
    return fail(Code::usage, "--session names the recording by itself; leave --output and --check away");
  if (auto s = check_trial_name(asked.trial); !s) return std::unexpected(s.error());
  auto session = Session::open(asked.session, {.subject = asked.subject, .rig = asked.rig});
  if (!session) return std::unexpected(session.error());
  if (asked.say) std::ranges::for_each(session->notes(), asked.say);
  AcquireJob job = asked;
  job.session.clear();
  job.subject = session->subject();
  job.trial = free_trial(session->raw(), asked.trial);
  job.output = trial_file(session->raw(), job.trial);
  job.force = false;
  auto out = record_trial(job, wait_for_key);
  if (!out || out->written.empty()) return out;
  if (auto s = session->add(job.output); !s && !out->recorded.error) out->recorded.error = s.error();
  return out;
}

}  // namespace

std::vector<io::RecordingMetadata> acquisition_metadata(const AcquireJob& job,
                                                        const stream::GrantedPlan& plan,
                                                        const stream::DeviceCapabilities& device) {
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  std::map<std::string, std::string> values{{"source", job.source},
                                            {"device", device.name},
                                            {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", now)},
                                            {"rate_hz", format_number(plan.plan.rate_hz)},
                                            {"program", std::string("kinemark ") + kVersion},
                                            {"command", job.command_line}};
  if (!job.subject.empty()) values["subject"] = job.subject;
  if (!job.trial.empty()) values["trial"] = job.trial;
  for (std::size_t l = 0; l < plan.plan.intensity.size(); ++l)
    values["intensity " + plan.plan.leds[l]] = format_number(plan.plan.intensity[l]);
  std::vector<io::RecordingMetadata> out{{"acquisition", std::move(values)}};
  if (!plan.facts.empty()) out.push_back({"device", plan.facts});
  return out;
}

Result<TrialBegin> parse_begin(std::string_view text) {
  using Kind = TrialBegin::Kind;
  if (text == "key") return TrialBegin{.kind = Kind::key};
  if (text == "digital") return TrialBegin{.kind = Kind::digital};
  const auto wrong = [&] {
    return fail(Code::usage,
                fmt::format("--trigger: '{}' is none of key, digital, time=S, threshold=COUNTS and "
                            "threshold=LED:COUNTS",
                            text));
  };
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return wrong();
  TrialBegin out{.kind = text.substr(0, equals) == "time" ? Kind::time : Kind::threshold};
  if (out.kind == Kind::threshold && text.substr(0, equals) != "threshold") return wrong();
  auto number = text.substr(equals + 1);
  if (const auto colon = number.rfind(':'); out.kind == Kind::threshold && colon != std::string_view::npos) {
    out.led = number.substr(0, colon);
    number.remove_prefix(colon + 1);
  }
  const auto value = parse_number(number);
  if (!value || !(*value >= 0.0 && *value <= 1e7)) return wrong();
  out.value = *value;
  return out;
}

Result<stream::GrantedPlan> granted_plan(const AcquireJob& job) {
  if (auto s = check_numbers(job); !s) return std::unexpected(s.error());
  auto device = open_device(job.source, job.seed);
  if (!device) return std::unexpected(device.error());
  const auto plan = wanted(job, (*device)->capabilities());
  return plan ? (*device)->configure(*plan) : std::unexpected(plan.error());
}

Result<AcquireOutcome> run_acquire(const AcquireJob& job, const std::function<bool()>& wait_for_key) {
  if (auto s = check_numbers(job); !s) return std::unexpected(s.error());
  return job.session.empty() ? record_trial(job, wait_for_key) : record_in_session(job, wait_for_key);
}

}  // namespace kinemark::pipeline
