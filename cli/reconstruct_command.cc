// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/rig/reconstruct_job.h"

namespace kinemark::cli {
namespace {

int run_reconstruct(const Globals& globals, pipeline::ReconstructJob& job) {
  job.force = globals.force;
  job.frames.threads = job.smoother.threads = globals.threads;
  const auto done = pipeline::reconstruct_file(job);
  if (!done) return report_error(done.error());
  for (const auto& warning : done->at("warnings")) say(globals, warning.get<std::string>());
  for (const auto& led : done->at("leds"))
    say(globals,
        fmt::format("{}: {} of {} frames located, {} occluded, {} inconsistent, {} near the edge",
                    led.at("name").get<std::string>(), led.at("located").get<std::int64_t>(),
                    led.at("frames").get<std::int64_t>(), led.at("occluded").get<std::int64_t>(),
                    led.at("inconsistent").get<std::int64_t>(), led.at("near_edge").get<std::int64_t>()));
  say(globals, fmt::format("wrote {}", job.output.string()));
  if (globals.json) fmt::print("{}\n", done->dump(2));
  return 0;
}

}  // namespace

void add_reconstruct(CLI::App& app, const Globals& globals, Run& run) {
  using Method = pipeline::ReconstructJob::Method;
  auto* command = app.add_subcommand("reconstruct", "Points in space from counts and a calibrated rig");
  const auto job = std::make_shared<pipeline::ReconstructJob>();
  const std::map<std::string, Method> methods{
      {"smoother", Method::smoother}, {"frames", Method::frames}, {"classic", Method::classic}};
  const std::map<std::string, trajectory::Flicker> flickers{{"regress", trajectory::Flicker::regress},
                                                            {"dark-slot", trajectory::Flicker::dark_slot},
                                                            {"ignore", trajectory::Flicker::ignore}};
  command->add_option("INPUT", job->recording, "Recording of counts (.mcap)")->required();
  command->add_option("--rig", job->rig, "Calibrated rig, rig.toml")->required();
  command->add_option("-o,--output", job->output, "Markers to write: .c3d, .trc or .csv")->required();
  command
      ->add_option("--method", job->method,
                   "smoother: every count at its own time; frames: each frame alone; classic: look-up table "
                   "and midpoint")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case))
      ->default_str("smoother");
  command->add_option("--flicker", job->smoother.flicker, "Light of the room: regress, dark-slot or ignore")
      ->transform(CLI::CheckedTransformer(flickers, CLI::ignore_case))
      ->default_str("regress");
  command->add_option("--order", job->smoother.order, "smoother: integrations, 3 to 5; 0 chooses")
      ->capture_default_str();
  command
      ->add_option("--half-gain", job->smoother.half_gain_hz,
                   "smoother: frequency of half gain, Hz; 0 chooses")
      ->capture_default_str();
  command->add_option("--longest-gap", job->smoother.longest_gap_s, "smoother: longest gap to bridge, s")
      ->capture_default_str();
  command
      ->add_option("--dim", job->frames.dim_share, "Light below this share of the LED's median is not used")
      ->capture_default_str();
  command->callback([&globals, job, &run] {
    run = [&globals, job] {
      job->smoother.dim_share = job->frames.dim_share;
      return run_reconstruct(globals, *job);
    };
  });
}

}  // namespace kinemark::cli
