// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/choice.h"
#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/rig/calibrate_job.h"

namespace kinemark::cli {
namespace {

void say_alignment(const CommonOptions& common, const calibration::Alignment& alignment) {
  for (const auto& c : alignment.cameras) {
    const Eigen::Vector3d shift_mm = 1e3 * c.shift_m;
    say(common, fmt::format("camera {}: {:.1f} mm right, {:.1f} mm down, {:.1f} mm forward of the nominal "
                            "position; to be tilted {:.2f}, "
                            "panned {:.2f}, rolled {:.2f} deg",
                            c.camera, shift_mm.x(), shift_mm.y(), shift_mm.z(), c.rotation_deg.x(),
                            c.rotation_deg.y(), c.rotation_deg.z()));
  }
  say(common, "next: " + alignment.next);
}

int run_command(const CommonOptions& common, pipeline::CalibrateJob& job) {
  settle(common, "steps", job);
  const auto outcome = pipeline::run_calibrate(job);
  if (!outcome) return report_error(outcome.error());
  if (const int status = outcome->exit_status(); status != 0) {
    say_written(common, *outcome);
    // Nothing was found that could be told: the gate says why.
    (void)report_error({Code::bad_input, outcome->gates.back().sentence});
    return status;
  }
  for (const auto& warning : outcome->warnings) say(common, warning);
  if (const auto& found = outcome->bundle)
    say(common, fmt::format("{} poses, chi2/dof {:.2f}, warp of degree {}; tree sides right to {:.2f} mm RMS",
                            found->poses, found->chi2_per_dof, found->warp_degree, 1e3 * found->side_rms_m));
  if (outcome->alignment) say_alignment(common, *outcome->alignment);
  say_written(common, *outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::calibrate_json(*outcome)) + "\n");
  return 0;
}

}  // namespace

void add_calibrate(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("calibrate", "A rig from recordings of a tree or a grid of known size");
  command->footer(
      "Each recording describes the object that it shows (see 'kinemark simulate rig --grid --tree-poses'). "
      "Exit status 1 "
      "when the\n"
      "model of the cameras does not fit the counts.");
  const auto job = std::make_shared<pipeline::CalibrateJob>();
  using Method = workflow::CalibrateMethod;
  command
      ->add_option("INPUT", job->inputs,
                   "Recordings (.mcap) of the tree, of the grid before each camera, or of both")
      ->required();
  command->add_option("--nominal", job->nominal, "Rig as it was set up by hand, rig.toml")->required();
  auto* output = command->add_option("-o,--output", job->output, "Rig to write, rig.toml");
  command->add_option("--report", job->report, "Also write the page that shows the result, R.html");
  auto* align = command->add_flag(
      "--align", job->options.align_only,
      "Only report how far the cameras are from their nominal poses, and the next adjustment");
  output->excludes(align);
  add_choice<Method>(*command, "--method", job->options.method,
                     {{"bundle", Method::bundle}, {"grid-lut", Method::grid_lut}, {"scan", Method::scan}},
                     "bundle: tree and grid, everything at once; scan: an LED on a motor stage; grid-lut: "
                     "the table of 1986");
  command
      ->add_option("--sides", job->sides_m,
                   "Sides of the tree between LEDs 1-2, 1-3 and 2-3, m; as recorded when absent")
      ->expected(3);
  command->add_option("--frames-per-pose", job->frames_per_pose,
                      "Frames of each pose of the tree; as recorded when absent");
  command
      ->add_option("--warp-degree", job->options.bundle.warp_degree,
                   "Degree of the detector's warp to begin with")
      ->capture_default_str();
  command->add_flag("--no-crosstalk{false},--crosstalk", job->options.bundle.crosstalk,
                    "Leave terms between electrodes out");
  command->add_flag("--no-escalate{false},--escalate", job->options.bundle.escalate,
                    "Keep the model as it is, fit or not");
  command->callback([&common, job, output, align, &run] {
    if (output->count() == 0 && align->count() == 0) throw CLI::RequiredError("--output or --align");
    run = [&common, job] { return run_command(common, *job); };
  });
}

}  // namespace kinemark::cli
