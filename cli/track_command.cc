// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/level_arguments.h"
#include "cli/many_inputs.h"
#include "cli/motion_arguments.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/pipeline/motion/track_job.h"

namespace kinemark::cli {
namespace {

struct TrackArguments {
  pipeline::TrackJob job;
  MotionArguments motion;
  ManyArguments many;
  std::vector<std::string> levels, rest, posture;
  std::string accuracy;
  double step_ms = 0.0, level_bound_mm = 0.0;
  bool no_feed_forward = false, no_lock = false;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

Status apply(const TrackArguments& arguments, pipeline::TrackJob& job) {
  auto& options = job.options;
  if (auto s = take_levels(arguments.levels, options); !s) return s;
  for (const auto& text : arguments.rest) {
    const auto value = parse_pair(text, "VALUE");
    if (!value) return std::unexpected(value.error());
    options.rest_pose.push_back({.coordinate = value->first, .value = value->second});
  }
  if (!arguments.posture.empty()) {
    const auto parts = split(arguments.posture.front(), ',');
    const auto kp = parse_number(parts.front());
    const auto kd = parts.size() == 2 ? parse_number(parts.back()) : std::nullopt;
    if (!kp || !kd) return fail(Code::usage, fmt::format("'{}' is not KP,KD", arguments.posture.front()));
    options.posture_kp = *kp;
    options.posture_kd = *kd;
  }
  if (!arguments.accuracy.empty()) {
    const bool has_unit = arguments.accuracy.ends_with("deg");
    const auto number = parse_number(
        std::string_view(arguments.accuracy).substr(0, arguments.accuracy.size() - (has_unit ? 3 : 0)));
    if (!number || !(*number > 0.0))
      return fail(Code::usage,
                  fmt::format("accuracy '{}' is no angle above 0, as 0.5deg", arguments.accuracy));
    options.accuracy_rad = kRadPerDeg * *number;
  }
  options.step_s = 1e-3 * arguments.step_ms;
  options.level_bound_m = 1e-3 * arguments.level_bound_mm;
  if (options.level_bound_m > 0.0 && !options.strict)
    return fail(Code::usage, "--level-bound is for strict levels; --strict is not given");
  options.feed_forward = !arguments.no_feed_forward;
  options.lock = arguments.no_lock ? motion::LockMode::off : motion::LockMode::automatic;
  return {};
}

void print_adapted(const CommonOptions& common, const motion::AdaptResult& adapted) {
  say(common, fmt::format("Sizes from {} frames: marker error {:.2f} mm RMS at the best fit.", adapted.frames,
                          1e3 * adapted.rms_after_m));
  std::vector<std::string> open;
  for (const auto& size : adapted.parameters)
    if (size.kind == motion::ParameterKind::body_scale && size.determined)
      say(common, fmt::format("  {:16} x {:.4f} +- {:.4f}", size.name, size.value, size.sd));
  for (const auto& length : adapted.lengths)
    if (length.determined)
      say(common, fmt::format("  {}: {:.1f} +- {:.1f} mm, {:.1f} before", length.name, 1e3 * length.length_m,
                              1e3 * length.sd_m, 1e3 * length.initial_m));
    else
      open.push_back(length.name);
  if (!open.empty())
    say(common, fmt::format("note: Lengths that these markers do not determine: {}", join(open)));
}

void print_track_outcome(const CommonOptions& common, const pipeline::TrackOutcome& outcome) {
  const auto& result = outcome.result;
  const auto& motion = result.motion;
  say(common,
      fmt::format("{} frames at {:g} Hz, {} markers, {} coordinates; {} steps of {:.3g} ms in {:.3f} s.",
                  motion.frames(), motion.time.rate_hz, result.fit.markers.size(), motion.size(),
                  result.steps, 1e3 * result.step_s, result.solve_seconds));
  say(common,
      fmt::format("Marker error {:.2f} mm RMS against the recording, {:.2f} mm against the goals; rank "
                  "{} to {} of {}.",
                  1e3 * result.fit.rms_error_m, 1e3 * result.rms_goal_error_m,
                  *std::min_element(result.rank.begin(), result.rank.end()),
                  *std::max_element(result.rank.begin(), result.rank.end()), result.free_speeds));
  if (result.accuracy) {
    const auto& a = *result.accuracy;
    say(common,
        fmt::format("Expected error of the angles for this model: {:.2g} deg RMS ({:g} wanted), by a cut-off "
                    "of {:g} Hz and "
                    "omega {:.3g} rad/s; from {:.2g} deg in {} to {:.2g} deg in {}.",
                    kDegPerRad * a.predicted_rad, kDegPerRad * a.wanted_rad, a.cutoff_hz, a.omega_rad_s,
                    kDegPerRad * a.smallest_rad, a.smallest, kDegPerRad * a.largest_rad, a.largest));
  }
  if (result.proposed)
    say(common, fmt::format("Levels proposed: {}", pipeline::describe_proposal(*result.proposed)));
  for (std::size_t i = 0; i < result.levels.size(); ++i) {
    const auto& level = result.levels[i];
    say(common,
        fmt::format(
            "Level {}: {}, {:.2f} mm RMS from its goals, {:.2f} mm in its worst frame; {} rows for {} "
            "directions that are left{}.",
            i + 1,
            std::isnan(level.weight) ? fmt::format("strict, bound {:.1f} mm", 1e3 * level.bound_m)
                                     : fmt::format("weight {:.3g}", level.weight),
            1e3 * level.rms_error_m, 1e3 * level.max_error_m, level.rows, level.directions_left,
            level.rows > level.directions_left ? " (a compromise)" : ""));
  }
  if (outcome.adapted) print_adapted(common, *outcome.adapted);
  for (const auto& task : result.tasks)
    say(common, fmt::format("Task {}: {}.", task.text, pipeline::describe_task(task)));
  if (!result.locked_coordinates.empty())
    say(common, fmt::format("note: Held at rest because no tracked marker moves them: {}",
                            join(result.locked_coordinates)));
  if (!result.undetermined_coordinates.empty())
    say(common, fmt::format("note: Determined in fewer than 95 % of the frames: {}",
                            join(result.undetermined_coordinates)));
  print_motion(common, outcome);
}

int run_command(const CommonOptions& common, const TrackArguments& arguments) {
  pipeline::TrackJob job = arguments.job;
  if (auto status = apply(arguments.motion, job); !status) return report_error(status.error());
  if (auto status = apply(arguments, job); !status) return report_error(status.error());
  ManyArguments many = arguments.many;
  many.inputs = arguments.motion.recordings;
  many.output = job.output;
  many.pages = job.report;
  const bool is_one = many.inputs.empty() || !many.are_many();
  if (auto s = is_one ? many.check_single() : Status(); !s) return report_error(s.error());
  if (is_one) return run_job(common, "frames", job, pipeline::run_track, print_track_outcome);
  if (auto s = pipeline::check_for_several(job); !s) return report_error(s.error());
  const auto track_one = [&job](const std::filesystem::path& input, const std::filesystem::path& output,
                                const std::filesystem::path& page,
                                const pipeline::JobSettings& settings) -> Result<pipeline::JobOutcome> {
    pipeline::TrackJob one = job;
    static_cast<pipeline::JobSettings&>(one) = settings;
    one.markers = input;
    drop_what_it_states(one, input);
    one.output = output;
    one.report = page;
    return pipeline::run_track(one);
  };
  return run_each(common, many, ".mot", "_report.json", track_one);
}

}  // namespace

void add_track(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "track", "Joint angles and torques from markers by direct marker control, with bounds");
  command->footer(
      "Writes Q.mot (degrees, metres) and beside it Q_sd.sto (standard deviations), Q_bound.sto (bounds on "
      "the error,\nNaN where the markers do not determine the coordinate), Q_tau.sto and "
      "Q_tau_sd.sto (N m, N), Q_rank.sto (directions that the\nlevels fix), Q_marker_errors.sto and "
      "Q_report.json. Exit status 1: the files are there, but a quality gate was missed.\n"
      "Several marker files, or a folder of them: --output is a folder; what is there already is not done "
      "again.");
  const auto arguments = std::make_shared<TrackArguments>();
  auto& a = *arguments;
  auto& options = a.job.options;
  add_motion_options(*command, a.job, a.motion);
  command
      ->add_option("--report", a.job.report,
                   "Also write the page that shows the result, R.html; a folder for several")
      ->group("Output");
  add_many_options(*command, a.many);
  auto* level =
      command
          ->add_option(
              "--level", a.levels,
              "Markers and tasks of one level, A,B,...; '*' takes the markers that are left; tasks are "
              "orientation:BODY, distance:A-B, coordinate:NAME=VALUE (deg, rad, m, mm, or `rest`), "
              "com:AXIS=VALUE. Repeat: each level's squared errors are weighted by 1 / variance of its "
              "markers. None: one level of all markers")
          ->group("Tasks");
  command
      ->add_flag("--propose-levels", options.propose_levels,
                 "Levels such as the body allows, from a first run: markers that are independent and "
                 "decoupled, and all others; printed as --level options")
      ->excludes(level)
      ->group("Tasks");
  command
      ->add_flag("--strict", options.strict,
                 "Levels are strict priorities, the highest first; one beyond its bound is a finding")
      ->group("Tasks");
  command
      ->add_option("--level-bound", a.level_bound_mm,
                   "Largest RMS distance of a strict level to its goals, mm; 0: from a first run")
      ->capture_default_str()
      ->group("Tasks");
  command
      ->add_flag("--adapt", a.job.adapt,
                 "Adapt sizes of segments and places of markers to these markers first; also writes "
                 "Q_model.osim, with the lengths and their deviations in the report")
      ->group("Tasks");
  command->add_option("--lock", options.locked, "Coordinate to hold at the rest pose. Repeatable.")
      ->group("Tasks");
  command->add_option("--rest", a.rest, "Rest pose of a coordinate NAME=VALUE (rad, m). Repeatable.")
      ->group("Tasks");
  command->add_flag("--no-lock", a.no_lock, "Leave coordinates that no marker moves to the posture task")
      ->group("Tasks");
  auto* omega = command->add_option("--omega", options.omega_rad_s, "Stiffness of the tracking, rad/s")
                    ->capture_default_str()
                    ->group("Control");
  auto* step = command->add_option("--step", a.step_ms, "Largest step, ms; 0: omega x step = 0.5 or less")
                   ->capture_default_str()
                   ->group("Control");
  command->add_option("--damping", options.damping, "Of directions that hardly move the markers, kg^-1/2")
      ->capture_default_str()
      ->group("Control");
  command->add_option("--posture", a.posture, "Gains of the posture task KP,KD, 1/s^2 and 1/s (100,20)")
      ->expected(1)
      ->group("Control");
  auto* cutoff = command->add_option("--cutoff", options.cutoff_hz, "Low-pass of the goals, Hz; 0: none")
                     ->capture_default_str()
                     ->group("Control");
  command
      ->add_option(
          "--accuracy", a.accuracy,
          "RMS error of the angles of joints that is wanted, as 0.5deg: chooses cut-off, step and omega, "
          "or says what it would take")
      ->excludes(omega)
      ->excludes(step)
      ->excludes(cutoff)
      ->group("Control");
  command
      ->add_flag(
          "--settle", options.settle,
          "Bring the pose of every frame to the best fit of its goals by inverse kinematics; one level only")
      ->group("Control");
  command->add_flag("--no-feed-forward", a.no_feed_forward, "Use positions only, not their rates")
      ->group("Control");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
