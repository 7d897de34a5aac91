// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/many_inputs.h"
#include "cli/motion_arguments.h"
#include "cli/orientation_options.h"
#include "kinemark/pipeline/motion/ik_job.h"

namespace kinemark::cli {
namespace {

/// One line for all coordinates that some frames do not determine, or nothing.
std::string coordinates_partly_determined(const report::IkSummary& summary, std::int64_t frames) {
  std::string list;
  for (const auto& c : summary.coordinates) {
    if (c.locked || c.determined_frames == 0 || c.determined_frames == frames) continue;
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", c.name, frames - c.determined_frames);
  }
  if (list.empty()) return {};
  return fmt::format("note: Not determined by the visible markers in so many of {} frames: {}", frames, list);
}

void print_ik_outcome(const CommonOptions& common, const pipeline::IkOutcome& outcome) {
  const auto& result = outcome.result;
  const auto& motion = result.motion;
  const auto& summary = outcome.summary;
  say(common,
      fmt::format("{} frames at {:g} Hz, {} markers, {} coordinates; solved in {:.3f} s ({:.0f} frames/s).",
                  motion.frames(), motion.time.rate_hz, result.fit.markers.size(), motion.size(),
                  result.solve_seconds, static_cast<double>(motion.frames()) / result.solve_seconds));
  say(common,
      fmt::format("Marker error {:.2f} mm RMS, {:.1f} mm at most; {:.1f} % of the coordinates determined.",
                  1e3 * result.fit.rms_error_m, 1e3 * result.fit.max_error_m,
                  100.0 * summary.determined_fraction));
  if (outcome.sensor_fit) say_sensors(common, *outcome.sensor_fit);
  const auto partly = coordinates_partly_determined(summary, motion.frames());
  if (!partly.empty()) say(common, partly);
  print_motion(common, outcome);
}

struct IkArguments {
  pipeline::IkJob job;
  MotionArguments motion;
  ManyArguments many;
  OrientationArguments orientations;
  std::vector<std::string> coordinate_weights;
  double loss_scale_mm = 20.0;
};

int run_command(const CommonOptions& common, IkArguments& arguments) {
  auto& job = arguments.job;
  if (auto status = apply(arguments.motion, job); !status) return report_error(status.error());
  if (arguments.orientations.any()) {
    if (arguments.motion.recordings.empty())
      return run_orientation_command(common, arguments.orientations, job);
    if (auto status = add_sensors(arguments.orientations, job); !status) return report_error(status.error());
  }
  for (const auto& text : arguments.coordinate_weights) {
    const auto weight = parse_pair(text, "WEIGHT");
    if (!weight) return report_error(weight.error());
    job.options.coordinate_tasks.push_back({.coordinate = weight->first, .weight = weight->second});
  }
  job.options.loss_scale_m = 1e-3 * arguments.loss_scale_mm;
  auto& many = arguments.many;
  many.inputs = arguments.motion.recordings;
  many.output = job.output;
  const bool is_one = many.inputs.empty() || !many.are_many();
  if (auto s = is_one ? many.check_single() : Status(); !s) return report_error(s.error());
  if (is_one) return run_job(common, "frames", job, pipeline::run_ik, print_ik_outcome);
  if (auto s = pipeline::check_for_several(job); !s) return report_error(s.error());
  if (arguments.orientations.any())
    return report_error(
        fail(Code::usage, "--orientations are of one recording; give one marker file").error());
  many.pages = job.report;
  const auto solve_one = [&job](const std::filesystem::path& input, const std::filesystem::path& output,
                                const std::filesystem::path& page,
                                const pipeline::JobSettings& settings) -> Result<pipeline::JobOutcome> {
    pipeline::IkJob one = job;
    static_cast<pipeline::JobSettings&>(one) = settings;
    one.markers = input;
    drop_what_it_states(one, input);
    one.output = output;
    one.report = page;
    return pipeline::run_ik(one);
  };
  return run_each(common, many, ".mot", "_report.json", solve_one);
}

}  // namespace

void add_ik(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand(
      "ik", "Joint angles from markers by least squares, each with its standard deviation");
  command->footer(
      "Writes Q.mot (degrees, metres) and beside it Q_sd.sto (standard deviations), Q_marker_errors.sto "
      "(metres, NaN where\n"
      "not seen) and Q_report.json. Exit status 1: the files are there, but a quality gate was missed.\n"
      "Several marker files, or a folder of them: --output is a folder; what is there already is not done "
      "again.\n"
      "With --orientations, of inertial sensors: Q_orientation_errors.sto (degrees), beside "
      "Q_marker_errors.sto "
      "where there are markers.");
  const auto arguments = std::make_shared<IkArguments>();
  auto& job = arguments->job;
  auto& options = job.options;
  add_motion_options(*command, job, arguments->motion);
  add_many_options(*command, arguments->many);
  add_orientation_options(*command, arguments->orientations);
  command
      ->add_option("--setup", job.setup, "OpenSim InverseKinematicsTool setup; other options take precedence")
      ->group("Input");
  command->add_option("--tasks", job.tasks, "OpenSim IKTaskSet: marker and coordinate weights")
      ->group("Input");
  command
      ->add_option("--report", job.report,
                   "Also write the page that shows the result, R.html; a folder for several recordings")
      ->group("Output");
  command
      ->add_option("--coordinate-weight", arguments->coordinate_weights,
                   "Coordinate task towards 0 with a weight, NAME=W (OpenSim's convention). Repeatable.")
      ->group("Estimate");
  command
      ->add_option_function<std::string>(
          "--loss",
          [&options](const std::string& name) {
            const std::map<std::string, motion::Loss> losses{{"square", motion::Loss::square},
                                                             {"huber", motion::Loss::huber},
                                                             {"cauchy", motion::Loss::cauchy}};
            const auto loss = losses.find(name);
            if (loss == losses.end())
              throw CLI::ValidationError("--loss", fmt::format("'{}' is not square, huber or cauchy", name));
            options.loss = loss->second;
          },
          "Loss of large residuals: square, huber or cauchy")
      ->default_str("square")
      ->group("Estimate");
  command
      ->add_option_function<std::string>(
          "--estimator",
          [&job](const std::string& name) {
            if (name == "smoother")
              job.estimator = workflow::Estimator::smoother;
            else if (name != "least-squares")
              throw CLI::ValidationError("--estimator",
                                         fmt::format("'{}' is not least-squares or smoother", name));
          },
          "least-squares (frame by frame) or smoother (the whole recording at once)")
      ->default_str("least-squares")
      ->group("Estimate");
  command
      ->add_flag("--locations", job.marker_locations,
                 "Also write Q_marker_locations.sto: where the model's markers are, m")
      ->group("Output");
  command
      ->add_flag("--torques", job.torques,
                 "Also write Q_tau.sto and Q_tau_sd.sto (N m, N); --forces implies it")
      ->group("Estimate");
  command->add_option("--loss-scale", arguments->loss_scale_mm, "Threshold of huber, scale of cauchy, mm")
      ->capture_default_str()
      ->group("Estimate");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
