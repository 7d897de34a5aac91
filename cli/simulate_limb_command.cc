// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/simulate/simulate_limb_job.h"

namespace kinemark::cli {
namespace {

struct LimbArguments {
  pipeline::SimulateLimbJob job;
  double noise_mm = 1.0, stagger_mm = 0.0, skin_mm = 0.0;
  std::vector<double> lengths_mm{150.0, 160.0};
  std::string interpolation = "linear";
  bool all_seen = false, hard = false;
  bool missing_given = false;
};

int run_limb(const CommonOptions& common, LimbArguments& arguments) {
  auto& job = arguments.job;
  job.arm.noise_sd_m = job.macaque.noise_sd_m = 1e-3 * arguments.noise_mm;
  job.arm.stagger_m = 1e-3 * arguments.stagger_mm;
  job.arm.lengths_m = arguments.lengths_mm;
  for (double& length : job.arm.lengths_m) length *= 1e-3;
  if (arguments.hard) {
    const auto hard = simulation::SleeveOptions::hard();
    job.macaque.sight_cosine = hard.sight_cosine;
    job.macaque.sight_cameras = hard.sight_cameras;
    job.macaque.mouth_loss = hard.mouth_loss;
    if (!arguments.missing_given) job.macaque.missing = hard.missing;
  }
  job.macaque.line_of_sight = !arguments.all_seen;
  job.macaque.skin_m = 1e-3 * arguments.skin_mm;
  job.upsample.how =
      arguments.interpolation == "cubic" ? simulation::Upsampling::cubic : simulation::Upsampling::linear;
  return run_job(common, "files", job, pipeline::run_simulate_limb, print_written);
}

/// What both have in common.
void add_common(CLI::App& command, LimbArguments& arguments, double& missing) {
  command.footer(
      "Writes markers.c3d, markers.trc, truth.csv (joint centres, then markers without noise, m) and "
      "segments.toml (for `kinemark joints`) into the folder.");
  command.add_option("-o,--out", arguments.job.folder, "Folder to write into; made when absent")->required();
  command.add_option("--noise", arguments.noise_mm, "Marker noise per axis, mm")->capture_default_str();
  command.add_option("--missing", missing, "Share of samples lost, each on its own")->capture_default_str();
  command
      .add_option("--upsample", arguments.job.upsample.factor,
                  "Frames that the recorder makes of each: 4 makes 240 Hz of 60")
      ->capture_default_str();
  command.add_option("--interpolation", arguments.interpolation, "How it makes them: linear or cubic")
      ->check(CLI::IsMember({"linear", "cubic"}))
      ->capture_default_str();
}

}  // namespace

void add_simulate_limb(CLI::App& simulate, const CommonOptions& common, Run& run) {
  auto* arm = simulate.add_subcommand(
      "arm", "Segments in a chain in any pose, as the macaque report simulated its arm, and the truth");
  const auto chain = std::make_shared<LimbArguments>();
  auto& options = chain->job.arm;
  add_common(*arm, *chain, options.missing);
  arm->add_option("--frames", options.frames, "Poses, each on its own")->capture_default_str();
  arm->add_option("--rate", options.rate_hz, "Frames per second, of the time base alone")
      ->capture_default_str();
  arm->add_option("--segments", chain->lengths_mm, "Length of each segment, mm, from the origin on")
      ->delimiter(',')
      ->capture_default_str();
  arm->add_option("--markers", options.markers_per_segment, "Markers on each, at even steps")
      ->capture_default_str();
  arm->add_option("--stagger", chain->stagger_mm, "Distance of the markers from the bone, mm")
      ->capture_default_str();
  arm->add_flag("--planar", options.planar, "Staggered to both sides, not all around the bone");
  arm->add_flag("--pose-correlated", options.pose_correlated,
                "--missing goes with the pose: none where the arm points away from a certain side, twice the "
                "share there");
  arm->callback([&common, chain, &run] { run = [&common, chain] { return run_limb(common, *chain); }; });

  auto* macaque = simulate.add_subcommand(
      "macaque", "A monkey's arm in a sleeve of LEDs, reaching for food and bringing it to the mouth");
  const auto sleeve = std::make_shared<LimbArguments>();
  sleeve->job.scene = pipeline::LimbScene::macaque;
  auto& worn = sleeve->job.macaque;
  add_common(*macaque, *sleeve, worn.missing);
  macaque->add_option("--duration", worn.duration_s, "Length, s; an hour is 3600")->capture_default_str();
  macaque->add_option("--rate", worn.rate_hz, "Frames per second of the cameras")->capture_default_str();
  macaque->add_option("--leds", worn.leds_per_segment, "LEDs on each segment")->capture_default_str();
  macaque->add_flag("--tip", worn.tip, "One more LED, w0, at the wrist");
  macaque->add_option("--skin", sleeve->skin_mm, "How far skin moves an LED on its bone, RMS, mm")
      ->capture_default_str();
  auto* all_seen =
      macaque->add_flag("--all-seen", sleeve->all_seen, "No LED is hidden, whichever way it looks");
  macaque
      ->add_flag("--hard", sleeve->hard, "Narrow beams, three cameras a sample, a fifth lost: 30 % is seen")
      ->excludes(all_seen);
  macaque->add_flag("--obstacles", worn.obstacles, "Head, trunk and cage bars stand in the way as well")
      ->excludes(all_seen);
  auto& neurons = sleeve->job.neurons;
  const char* beside = "Beside the movement: session.nwb";
  macaque->add_option("--units", neurons.units, "Neurons tuned to the velocity of the hand; 0: none")
      ->type_name("N")
      ->capture_default_str()
      ->group(beside);
  macaque->add_option("--trials", neurons.trials, "Parts of the session, with the side of the hand; 0: none")
      ->type_name("N")
      ->capture_default_str()
      ->group(beside);
  macaque->add_flag("--lfp", neurons.field_potentials, "Field potentials of four channels, 500 Hz")
      ->group(beside);
  macaque->callback([&common, macaque, sleeve, &run] {
    sleeve->missing_given = macaque->count("--missing") > 0;
    run = [&common, sleeve] { return run_limb(common, *sleeve); };
  });
}

}  // namespace kinemark::cli
