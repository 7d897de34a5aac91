// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "cli/choice.h"
#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/json_text.h"
#include "kinemark/pipeline/rig/reconstruct_job.h"

namespace kinemark::cli {
namespace {

int run_command(const CommonOptions& common, pipeline::ReconstructJob& job) {
  settle(common, "LEDs", job);
  const auto outcome = pipeline::run_reconstruct(job);
  if (!outcome) return report_error(outcome.error());
  for (const auto& warning : outcome->warnings) say(common, warning);
  for (const auto& led : outcome->found.leds)
    say(common,
        fmt::format("{}: {} of {} frames located, {} occluded, {} inconsistent, {} near the edge", led.name,
                    led.located, led.frames, led.occluded, led.inconsistent, led.near_edge));
  say_written(common, *outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::reconstruct_json(*outcome)) + "\n");
  return outcome->exit_status();
}

}  // namespace

void add_reconstruct(CLI::App& app, const CommonOptions& common, Run& run) {
  using Method = workflow::ReconstructMethod;
  auto* command = app.add_subcommand("reconstruct", "Points in space from counts and a calibrated rig");
  const auto job = std::make_shared<pipeline::ReconstructJob>();
  using trajectory::Flicker;
  command->add_option("INPUT", job->recording, "Recording of counts (.mcap)")->required();
  command->add_option("--rig", job->rig, "Calibrated rig, rig.toml")->required();
  command->add_option("-o,--output", job->output, "Markers to write: .c3d, .trc or .csv")->required();
  command->add_option("--report", job->report, "Also write the page that shows the result, R.html");
  add_choice<Method>(
      *command, "--method", job->options.method,
      {{"smoother", Method::smoother}, {"frames", Method::frames}, {"classic", Method::classic}},
      "smoother: every count at its own time; frames: each frame alone; classic: look-up table and midpoint");
  add_choice<Flicker>(
      *command, "--flicker", job->options.smoother.flicker,
      {{"regress", Flicker::regress}, {"dark-slot", Flicker::dark_slot}, {"ignore", Flicker::ignore}},
      "Light of the room: regress, dark-slot or ignore");
  command->add_option("--order", job->options.smoother.order, "smoother: integrations, 3 to 5; 0 chooses")
      ->capture_default_str();
  command
      ->add_option("--half-gain", job->options.smoother.half_gain_hz,
                   "smoother: frequency of half gain, Hz; 0 chooses")
      ->capture_default_str();
  command
      ->add_option("--longest-gap", job->options.smoother.longest_gap_s, "smoother: longest gap to bridge, s")
      ->capture_default_str();
  command
      ->add_option("--dim", job->options.frames.dim_share,
                   "Light below this share of the LED's median is not used")
      ->capture_default_str();
  command->add_flag("--calibrated-offsets{false}", job->options.frames.light,
                    "Offsets as in the rig, whatever the light of an LED and however they have drifted");
  command->callback([&common, job, &run] {
    run = [&common, job] {
      job->options.smoother.dim_share = job->options.frames.dim_share;
      return run_command(common, *job);
    };
  });
}

}  // namespace kinemark::cli
