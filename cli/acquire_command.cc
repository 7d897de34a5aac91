// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/screens/screens.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/core/number.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/acquire/acquire_job.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "kinemark/pipeline/acquire/plan_figure.h"
#include "kinemark/pipeline/desk/acquire_desk.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {
namespace {

constexpr EnumNames<io::SyncPolicy::always> kSync{"never", "background", "always"};

struct AcquireArguments {
  pipeline::AcquireJob job;
  std::string begin, sync = "background";
  std::vector<std::string> intensity;
  std::filesystem::path plan;  ///< figure of what the device grants; empty: none
  bool list = false;
};

Status take_intensity(const std::vector<std::string>& given, pipeline::AcquireJob& job) {
  for (const auto& text : given) {
    const auto equals = text.rfind('=');
    const auto value = parse_number(equals == std::string::npos ? text : text.substr(equals + 1));
    if (!value)
      return fail(Code::usage, fmt::format("--intensity: '{}' is neither a number nor LED=NUMBER", text));
    job.intensity.emplace_back(equals == std::string::npos ? "" : text.substr(0, equals), *value);
  }
  return {};
}

Status complete(AcquireArguments& arguments) {
  auto& job = arguments.job;
  if (job.source.empty())
    return fail(Code::usage, "no device is given; 'kinemark acquire --list' shows those that are there");
  if (job.output.empty() && job.session.empty() && !job.check_up)
    return fail(Code::usage, "no recording is given; need --output FILE.mcap, --session FOLDER, or --check");
  if (!job.session.empty() && job.trial.empty()) job.trial = pipeline::Wanted().trial;
  const auto sync = kSync.parse(arguments.sync, "--sync");
  if (!sync) return std::unexpected(sync.error());
  job.sync = *sync;
  if (!arguments.begin.empty()) {
    const auto begin = pipeline::parse_begin(arguments.begin);
    if (!begin) return std::unexpected(begin.error());
    job.begin = *begin;
  }
  return take_intensity(arguments.intensity, job);
}

int list_devices(const CommonOptions& common) {
  const auto devices = pipeline::enumerate_devices();
  if (common.json) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& device : devices)
      list.push_back({{"uri", device.uri}, {"name", device.name}, {"state", device.state}});
    print_result(pipeline::json_text(list) + "\n");
    return 0;
  }
  for (const auto& device : devices)
    print_result(fmt::format("{:<28} {}{}{}\n", device.uri, device.name, device.state.empty() ? "" : ": ",
                             device.state));
  return 0;
}

/// Until a line comes on standard input; false: a signal, or the end of it.
bool wait_for_key(const CommonOptions& common) {
  say(common, "press Enter to begin");
  while (signal_that_came() == 0) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&input, 1, 100);
    if (ready < 0 && errno != EINTR) return false;
    if (ready <= 0) continue;
    char byte = 0;
    if (::read(STDIN_FILENO, &byte, 1) != 1) return false;
    if (byte == '\n') return true;
  }
  return false;
}

void print_progress(const CommonOptions& common, const pipeline::RecorderProgress& progress) {
  if (common.json) {
    print_result(pipeline::progress_json(progress).dump() + "\n");
    (void)std::fflush(stdout);
    return;
  }
  say(common, fmt::format("{} frames, {} kept, {} lost by the device, {} dropped here", progress.frames,
                          progress.acknowledged, progress.dropped_by_device, progress.dropped_here));
}

int finish(const CommonOptions& common, const pipeline::AcquireOutcome& outcome) {
  for (const auto& note : outcome.notes) say(common, (note.good ? "" : "! ") + note.text);
  say_written(common, outcome);
  if (common.json) print_result(pipeline::acquire_json(outcome).dump() + "\n");
  if (outcome.recorded.error) return report_error(*outcome.recorded.error);
  if (const int number = signal_that_came(); number != 0) return 128 + number;
  return outcome.exit_status();
}

/// What the device grants, drawn.
int draw_plan(const CommonOptions& common, AcquireArguments& arguments) {
  auto& job = arguments.job;
  if (!job.output.empty() || !job.session.empty() || job.check_up)
    return report_error(
        {Code::usage, "--plan draws and records nothing; leave --output, --session and --check away"});
  if (job.source.empty()) return report_error({Code::usage, "--plan: no device is given"});
  if (auto s = take_intensity(arguments.intensity, job); !s) return report_error(s.error());
  settle(common, "frames", job);
  const auto outcome = pipeline::run_plan(job, arguments.plan);
  if (!outcome) return report_error(outcome.error());
  say(common, pipeline::plan_sentence(outcome->granted));
  say_written(common, *outcome);
  if (common.json) print_result(pipeline::plan_json(*outcome).dump() + "\n");
  return 0;
}

/// An option that the menus have no use for.
Status check_by_hand(const CommonOptions& common, const AcquireArguments& arguments) {
  const char* of_files = !arguments.begin.empty()       ? "trigger"
                         : !arguments.intensity.empty() ? "intensity"
                         : arguments.job.frames > 0     ? "frames"
                         : common.force                 ? "force"
                                                        : "";
  if (*of_files == '\0') return {};
  return fail(
      Code::usage,
      fmt::format("--{} is for a recording that --output names; without one the menus are shown", of_files));
}

/// The rig that the cameras are aligned with, and the session that trials are part of.
Status open_session(const CommonOptions& common, const pipeline::AcquireJob& job,
                    pipeline::TrialFiles& files) {
  if (!job.rig.empty()) {
    auto rig = io::read_rig(job.rig);
    if (!rig) return std::unexpected(rig.error());
    files.wanted_rig = std::move(*rig);
  }
  if (job.session.empty()) return {};
  auto session = pipeline::Session::open(job.session, {.subject = job.subject, .rig = job.rig});
  if (!session) return std::unexpected(session.error());
  for (const auto& note : session->notes()) say(common, note);
  files.session = std::move(*session);
  return {};
}

/// The menus: a person chooses what the options say otherwise.
int acquire_by_hand(const CommonOptions& common, const AcquireArguments& arguments) {
  if (const auto s = check_by_hand(common, arguments); !s) return report_error(s.error());
  const auto sync = kSync.parse(arguments.sync, "--sync");
  if (!sync) return report_error(sync.error());
  pipeline::TrialFiles files{.folder = ".", .seed = common.seed, .recording = {.sync = *sync}};
  pipeline::Wanted wanted;
  wanted.source = arguments.job.source;
  wanted.subject = arguments.job.subject;
  if (const auto s = open_session(common, arguments.job, files); !s) return report_error(s.error());
  if (files.session) wanted.subject = files.session->subject();
  pipeline::AcquireDesk desk(std::move(files));
  wanted.leds = arguments.job.leds;
  if (!arguments.job.trial.empty()) wanted.trial = arguments.job.trial;
  if (arguments.job.rate_hz > 0.0) wanted.rate_hz = format_number(arguments.job.rate_hz);
  if (arguments.job.duration_s > 0.0) wanted.duration_s = format_number(arguments.job.duration_s);
  end_gently();
  const auto kept = screens::acquire_by_hand(desk, wanted, [] { return signal_that_came() != 0; });
  for (const auto& file : kept) say(common, "wrote " + file);
  if (signal_that_came() != 0) return 128 + signal_that_came();
  return desk.failure() ? report_error(*desk.failure()) : 0;
}

/// No recording is named, and somebody can be asked.
bool wants_menus(const CommonOptions& common, const pipeline::AcquireJob& job) {
  if (job.check_up || common.json || !job.output.empty()) return false;
  const bool names_trial = !job.session.empty() && !job.trial.empty();
  const bool at_terminal = isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0;
  return job.source.empty() || (at_terminal && !names_trial);
}

int acquire(const CommonOptions& common, AcquireArguments& arguments) {
  if (arguments.list) return list_devices(common);
  if (!arguments.plan.empty()) return draw_plan(common, arguments);
  if (wants_menus(common, arguments.job)) return acquire_by_hand(common, arguments);
  if (!arguments.job.rig.empty() && arguments.job.session.empty())
    return report_error({Code::usage,
                         "--rig is for the menus, which come without --output, and for --session; 'kinemark "
                         "calibrate --align' does the same from a recording"});
  if (auto s = complete(arguments); !s) return report_error(s.error());
  auto& job = arguments.job;
  settle(common, "frames", job);
  end_gently();
  job.stop = [] { return signal_that_came() != 0; };
  job.say = [&common](const std::string& line) { say(common, line); };
  job.each_second = [&common](const pipeline::RecorderProgress& p) { print_progress(common, p); };
  const auto outcome = pipeline::run_acquire(job, [&common] { return wait_for_key(common); });
  if (outcome) return finish(common, *outcome);
  const int status = report_error(outcome.error());
  return outcome.error().code == Code::cancelled && signal_that_came() != 0 ? 128 + signal_that_came()
                                                                            : status;
}

void add_plan_options(CLI::App& command, AcquireArguments& arguments) {
  auto& job = arguments.job;
  command.add_option("--leds", job.leds, "How many LEDs to light, or their names with commas between")
      ->type_name("N|NAMES");
  command.add_option("--rate", job.rate_hz,
                     "Frames per second; the highest that device and LEDs allow when absent");
  command
      .add_option("--intensity", arguments.intensity,
                  "Light of an LED, above 0, at most 1: 0.5 for all, hand=0.5 for one; repeat")
      ->allow_extra_args(false);
  command.add_option("--duration", job.duration_s, "Length, s; until Ctrl-C when absent");
  command.add_option("--frames", job.frames, "Length in frames, those that are lost included")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{4'294'967'296}));
  command
      .add_option(
          "--trigger", arguments.begin,
          "Begin with Enter (key), a digital line (digital), in some seconds (time=S), or once an LED "
          "is bright (threshold=LED:COUNTS)")
      ->type_name("WHAT");
}

}  // namespace

void add_acquire(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("acquire", "A trial from a device on the desk, checked as soon as it ends");
  command->footer(
      "Ctrl-C ends the trial and keeps it. Exit status 1 when a frame is missing, 4 when the disk, 5 when "
      "the\n"
      "device failed; what came before is kept. Devices: sim:rig?leds=8&rate=138, replay:FILE.mcap,\n"
      "serial:/dev/ttyACM0, comedi:/dev/comedi0. Without --output, and without --trial of a --session: "
      "menus,\n"
      "or questions in lines.");
  const auto arguments = std::make_shared<AcquireArguments>();
  auto& job = arguments->job;
  command->add_option("SOURCE", job.source, "Address of the device, as --list shows it")->type_name("DEVICE");
  command->add_option("-o,--output", job.output, "Recording to write, .mcap");
  add_plan_options(*command, *arguments);
  command
      ->add_option("--sync", arguments->sync,
                   "When frames are forced to the disk: never, background (every second), always")
      ->type_name("WHEN")
      ->capture_default_str();
  command->add_option("--subject", job.subject, "Who was recorded; kept with the recording")
      ->type_name("NAME");
  command->add_option("--trial", job.trial, "What was recorded; kept with the recording")->type_name("NAME");
  command
      ->add_option("--session", job.session,
                   "Folder of trials that belong together, made or continued: the trial is its "
                   "raw/TRIAL.mcap, a number counted on where that is there")
      ->type_name("FOLDER");
  command->add_option(
      "--rig", job.rig,
      "Rig as it is to stand, rig.toml: the menus say how to turn the cameras, by the tree of "
      "three LEDs held still in four places or more; a session keeps a copy");
  command->add_flag(
      "--check", job.check_up,
      "Look at the device for 10 s, or --duration, and keep nothing: rate, losses, dark level, noise and "
      "each LED, a line each with what to do; exit status 1 where something is wrong");
  command->add_option("--plan", arguments->plan,
                      "Draw when LEDs are lit and channels converted, .svg or .png, and record nothing");
  command->add_flag("--list", arguments->list, "Show the devices that are there, and record nothing");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return acquire(common, *arguments); }; });
}

}  // namespace kinemark::cli
