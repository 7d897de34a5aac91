// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/rig/calibrate_job.h"

namespace kinemark::cli {
namespace {

void say_alignment(const Globals& globals, const nlohmann::ordered_json& alignment) {
  for (const auto& c : alignment.at("cameras")) {
    const auto shift = c.at("right_down_forward_mm").get<std::vector<double>>();
    const auto turn = c.at("tilt_pan_roll_deg").get<std::vector<double>>();
    say(globals, fmt::format("camera {}: {:.1f} mm right, {:.1f} mm down, {:.1f} mm forward of the nominal "
                             "position; to be tilted {:.2f}, "
                             "panned {:.2f}, rolled {:.2f} deg",
                             c.at("camera").get<std::string>(), shift[0], shift[1], shift[2], turn[0],
                             turn[1], turn[2]));
  }
  say(globals, "next: " + alignment.at("next").get<std::string>());
}

int run_calibrate(const Globals& globals, pipeline::CalibrateJob& job) {
  job.force = globals.force;
  const auto done = pipeline::calibrate_rig_file(job, show_progress(globals, "steps"));
  if (!done) {
    const int status = report_error(done.error());
    // A model that does not fit the counts is a missed quality gate, not a bad file.
    return done.error().message.starts_with("calibration refused") ? 1 : status;
  }
  for (const auto& warning : done->at("warnings")) say(globals, warning.get<std::string>());
  if (done->contains("chi2_per_dof"))
    say(globals,
        fmt::format("{} poses, chi2/dof {:.2f}, warp of degree {}; tree sides right to {:.2f} mm RMS",
                    done->at("poses").get<int>(), done->at("chi2_per_dof").get<double>(),
                    done->at("warp_degree").get<int>(), done->at("side_rms_mm").get<double>()));
  if (done->contains("alignment")) say_alignment(globals, done->at("alignment"));
  if (done->contains("written")) say(globals, fmt::format("wrote {}", job.output.string()));
  if (globals.json) fmt::print("{}\n", done->dump(2));
  return 0;
}

}  // namespace

void add_calibrate(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand("calibrate", "A rig from recordings of a tree or a grid of known size");
  command->footer(
      "Each recording describes the object that it shows (see 'kinemark simulate rig --grid --tree-poses'). "
      "Exit status 1 "
      "when the\n"
      "model of the cameras does not fit the counts.");
  const auto job = std::make_shared<pipeline::CalibrateJob>();
  const std::map<std::string, pipeline::CalibrateJob::Method> methods{
      {"bundle", pipeline::CalibrateJob::Method::bundle},
      {"grid-lut", pipeline::CalibrateJob::Method::grid_lut},
      {"scan", pipeline::CalibrateJob::Method::scan}};
  command
      ->add_option("INPUT", job->inputs,
                   "Recordings (.mcap) of the tree, of the grid before each camera, or of both")
      ->required();
  command->add_option("--nominal", job->nominal, "Rig as it was set up by hand, rig.toml")->required();
  auto* output = command->add_option("-o,--output", job->output, "Rig to write, rig.toml");
  auto* align = command->add_flag(
      "--align", job->align_only,
      "Only report how far the cameras are from their nominal poses, and the next adjustment");
  output->excludes(align);
  command
      ->add_option("--method", job->method,
                   "bundle: tree and grid, everything at once; scan: an LED on a motor stage; grid-lut: the "
                   "table of 1986")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case))
      ->default_str("bundle");
  command
      ->add_option("--sides", job->sides_m,
                   "Sides of the tree between LEDs 1-2, 1-3 and 2-3, m; as recorded when absent")
      ->expected(3);
  command->add_option("--frames-per-pose", job->frames_per_pose,
                      "Frames of each pose of the tree; as recorded when absent");
  command->add_option("--warp-degree", job->bundle.warp_degree, "Degree of the detector's warp to begin with")
      ->capture_default_str();
  command->add_flag("--no-crosstalk{false},--crosstalk", job->bundle.crosstalk,
                    "Leave terms between electrodes out");
  command->add_flag("--no-escalate{false},--escalate", job->bundle.escalate,
                    "Keep the model as it is, fit or not");
  command->callback([&globals, job, output, align, &run] {
    if (output->count() == 0 && align->count() == 0) throw CLI::RequiredError("--output or --align");
    run = [&globals, job] { return run_calibrate(globals, *job); };
  });
}

}  // namespace kinemark::cli
