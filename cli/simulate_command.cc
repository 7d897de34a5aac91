// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/simulate/simulate_subject_job.h"

namespace kinemark::cli {
namespace {

struct SubjectArguments {
  pipeline::SimulateSubjectJob job;
  double noise_mm = 1.0;
};

int run_subject(const CommonOptions& common, SubjectArguments& arguments) {
  auto& job = arguments.job;
  job.options.noise_sd_m = 1e-3 * arguments.noise_mm;
  return run_job(common, "files", job, pipeline::run_simulate_subject, print_written);
}

}  // namespace

void add_simulate(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("simulate", "Recordings with known truth");
  command->require_subcommand(1);
  auto* subject = command->add_subcommand(
      "subject", "A moving person with markers: noise, soft tissue, gaps, and the truth");
  subject->footer(
      "Writes markers.c3d, markers.trc, model.osim, truth.mot (degrees, metres) and truth.trc into the "
      "folder.");
  const auto arguments = std::make_shared<SubjectArguments>();
  auto& options = arguments->job.options;
  subject->add_option("-o,--out", arguments->job.folder, "Folder to write into; made when absent")
      ->required();
  subject->add_option("-m,--model", arguments->job.model,
                      "Body model, .osim; kinemark's own human when absent");
  subject->add_option("--duration", options.duration_s, "Length, s")->capture_default_str();
  subject->add_option("--rate", options.rate_hz, "Frames per second")->capture_default_str();
  subject->add_option("--noise", arguments->noise_mm, "Marker noise per axis, mm")->capture_default_str();
  subject
      ->add_option("--soft-tissue", options.soft_tissue,
                   "Skin motion: 1 is 2 mm (head, hand) to 15 mm (thigh) RMS")
      ->capture_default_str();
  subject
      ->add_option("--soft-tissue-common", options.soft_tissue_common,
                   "Share of it that a segment's markers have in common")
      ->capture_default_str();
  subject->add_option("--dropout-random", options.dropout_random, "Share of samples lost at random, in gaps")
      ->capture_default_str();
  subject
      ->add_option("--dropout-sight", options.dropout_sight,
                   "Share of samples lost because the body hides the marker")
      ->capture_default_str();
  subject->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_subject(common, *arguments); }; });
  add_simulate_limb(*command, common, run);
  add_simulate_rig(*command, common, run);
}

}  // namespace kinemark::cli
