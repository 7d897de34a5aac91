// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/recording_options.h"
#include "kinemark/core/text.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/scale/scale_json.h"

namespace kinemark::cli {
namespace {

void print_adapted(const CommonOptions& common, const motion::AdaptResult& result, const char* what) {
  say(common,
      fmt::format("{}: {} frames, {} steps; marker error {:.2f} mm RMS, {:.2f} mm before.", what,
                  result.frames, result.iterations, 1e3 * result.rms_after_m, 1e3 * result.rms_before_m));
  if (!result.converged)
    say(common, "attention: the adaptation did not converge; its numbers are intermediate");
  if (result.tissue_sd_m >= 0.05e-3)  // less is 0.0 as it is printed
    say(common,
        fmt::format("Markers slide on the body with the posture, {:.1f} mm per axis; deviations include it.",
                    1e3 * result.tissue_sd_m));
  for (const auto& p : result.parameters)
    if (p.kind == motion::ParameterKind::body_scale && p.determined)
      say(common, fmt::format("  {:16} x {:.4f} +- {:.4f}", p.name, p.value, p.sd));
  std::vector<std::string> open;
  for (const auto& p : result.parameters)
    if (p.kind != motion::ParameterKind::marker_position && !p.determined) open.push_back(p.name);
  if (!open.empty()) say(common, fmt::format("note: Not determined by these data: {}", join(open)));
  for (const auto& sentence : result.recommendations) say(common, fmt::format("attention: {}", sentence));
}

void print_scale_outcome(const CommonOptions& common, const pipeline::ScaleJob& job,
                         const pipeline::ScaleOutcome& outcome) {
  if (!outcome.clavicles.empty()) say(common, fmt::format("Set free: {}.", join(outcome.clavicles)));
  if (!outcome.joints.empty())
    say(common,
        fmt::format("Joints that may leave the place that sizes give them: {}.", join(outcome.joints)));
  if (outcome.scaled)
    for (const auto& m : outcome.scaled->measurements)
      say(common, fmt::format("measured {:16} x {:.4f}", m.name, m.factor));
  if (outcome.from_static) print_adapted(common, *outcome.from_static, "Static trial");
  if (outcome.placed)
    say(common, fmt::format("{} markers placed; the pose fitted the model's markers to {:.1f} mm RMS.",
                            outcome.placed->markers.size(), 1e3 * outcome.placed->rms_m));
  if (outcome.from_motion) print_adapted(common, *outcome.from_motion, "Motion");
  for (const auto& note : outcome.warnings) say(common, fmt::format("attention: {}", note));
  for (const auto& note : outcome.lost) say(common, fmt::format("attention: {}", note));
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::scale_json(job, outcome)) + "\n");
}

struct ScaleArguments {
  pipeline::ScaleJob job;
  double noise_mm = 0.0, position_prior_mm = 10.0, joint_prior_mm = 20.0, size_prior_percent = 10.0,
         max_rms_mm = 50.0;
  bool no_soft_tissue = false;
};

int run_command(const CommonOptions& common, ScaleArguments& arguments) {
  auto& job = arguments.job;
  job.adapt.marker_noise_sd_m = 1e-3 * arguments.noise_mm;
  job.adapt.soft_tissue = !arguments.no_soft_tissue;
  job.position_prior_sd_m = 1e-3 * arguments.position_prior_mm;
  job.joint_prior_sd_m = 1e-3 * arguments.joint_prior_mm;
  job.size_prior_sd = 1e-2 * arguments.size_prior_percent;
  job.max_rms_m = 1e-3 * arguments.max_rms_mm;
  return run_job(common, "steps", job, pipeline::run_scale,
                 [&](const auto&, const auto& outcome) { print_scale_outcome(common, job, outcome); });
}

}  // namespace

void add_scale(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command =
      app.add_subcommand("scale", "A model made to fit a subject, with the uncertainty of every size");
  command->footer(
      "Writes M.osim and beside it M_report.json: factors, lengths and marker positions with standard "
      "deviations, and "
      "what\n"
      "the data do not determine. Exit status 1: the files are there, but the markers fit worse than "
      "--max-rms,\nor a marker of the static trial lies elsewhere or is exchanged.");
  const auto arguments = std::make_shared<ScaleArguments>();
  auto& job = arguments->job;
  command->add_option("-m,--model", job.model, "General body model, .osim")->group("Input");
  command
      ->add_option("--static", job.static_trial,
                   "Marker file of a static trial; takes precedence over the setup's")
      ->group("Input");
  command->add_option("--setup", job.setup, "OpenSim ScaleTool setup; other options take precedence")
      ->group("Input");
  command
      ->add_option("-t,--markers", job.markers,
                   "Marker file of a motion to which sizes and positions are adapted")
      ->group("Input");
  command
      ->add_option("--joints", job.joints,
                   "Functional joint centres: folder or skeleton.json that 'joints' wrote")
      ->group("Input");
  add_recording_options(*command, job, pipeline::Doubtful::keep);
  command->add_option("-o,--output", job.output, "Model to write, M.osim")->group("Output");
  command->add_option("--report", job.report, "Also write the page that shows the result, R.html")
      ->group("Output");
  command->add_option("--mass", job.mass_kg, "Mass of the subject, kg")->group("Model");
  command
      ->add_flag("--dempster", job.dempster, "Distribute the mass over the segments by Dempster's fractions")
      ->group("Model");
  command->add_flag("--clavicles", job.clavicles, "Let the clavicles move")->group("Model");
  command->add_flag("--symmetric", job.symmetric, "One size for both sides")->group("Model");
  command
      ->add_option("--size-prior", arguments->size_prior_percent,
                   "How far a segment's size may be from the model so far, % (1 SD)")
      ->capture_default_str()
      ->group("Estimate");
  command
      ->add_option("--place-prior", arguments->position_prior_mm,
                   "How far a marker may be from its position in the model so far, mm per axis (1 SD)")
      ->capture_default_str()
      ->group("Estimate");
  command
      ->add_option(
          "--joint-prior", arguments->joint_prior_mm,
          "How far a joint of --joints may be from its position in the model so far, mm per axis (1 SD)")
      ->capture_default_str()
      ->group("Estimate");
  command->add_option("--noise", arguments->noise_mm, "Marker noise per axis, mm; 0 estimates it")
      ->capture_default_str()
      ->group("Estimate");
  command
      ->add_flag("--no-soft-tissue", arguments->no_soft_tissue,
                 "Do not test for markers that slide on the body")
      ->group("Estimate");
  command->add_option("--max-frames", job.adapt.max_frames, "Frames of the motion to use at most")
      ->capture_default_str()
      ->group("Estimate");
  command->add_option("--max-rms", arguments->max_rms_mm, "Gate: RMS marker error, mm")
      ->capture_default_str()
      ->group("Quality gates");
  command->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_command(common, *arguments); }; });
}

}  // namespace kinemark::cli
