// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/segments_options.h"

#include <fmt/core.h>

#include <iterator>

#include "cli/console.h"
#include "kinemark/core/counted.h"
#include "kinemark/pipeline/files/json_text.h"

namespace kinemark::cli {
namespace {

void print_segments(const CommonOptions& common, const pipeline::SegmentsOutcome& outcome) {
  for (const auto& warning : outcome.warnings) say(common, "note: " + warning);
  const auto& motion = outcome.motion;
  say(common,
      fmt::format("{}: {}, {} and {} in {}.", outcome.title, counted(std::ssize(motion.angles), "angle"),
                  counted(std::ssize(motion.values), "value"), counted(motion.points.markers(), "point"),
                  counted(motion.time.frames, "frame")));
  if (const auto assumed = pipeline::assumed_measures(motion); !assumed.empty())
    say(common, fmt::format("Assumed, and carried in the deviations: {}.", assumed));
  if (const auto noise = pipeline::sample_noise(motion); !noise.empty())
    say(common, fmt::format("Marker noise behind the deviations, found in the samples: {}.", noise));
  if (!outcome.comparison.empty()) say(common, fmt::format("It {}.", outcome.comparison.summary()));
  if (!outcome.loads.series.empty())
    say(common, fmt::format("Joints: {} of forces, moments and powers, from {} on force plates.",
                            counted(std::ssize(outcome.loads.series), "series", "series"),
                            counted(std::ssize(outcome.loads.steps), "step")));
  for (const auto& [name, found] : outcome.cross_talk)
    if (!found.suspicious()) say(common, found.sentence(name));
  say_written(common, outcome);
  if (common.json) print_result(pipeline::json_text(pipeline::segments_outcome_json(outcome)) + "\n");
}

}  // namespace

void add_segments_options(CLI::App& command, pipeline::SegmentsJob& job, const std::string& definition) {
  auto* segments = command
                       .add_option(definition, job.definition,
                                   "Whose segment frames, joint centres and angles: pig (Plug-in Gait), "
                                   "isb-shoulder, or a .toml")
                       ->type_name("NAME|FILE");
  auto* still = command
                    .add_option("--static", job.static_trial,
                                "Static trial of the subject; the recording itself: it is its own")
                    ->type_name("FILE");
  auto* vsk =
      command.add_option("--vsk", job.vsk, "Measures of the subject, a Vicon .vsk or .mp")->type_name("FILE");
  auto* subject =
      command
          .add_option(
              "--subject", job.subject,
              "A measure of the subject: LLegLength=920, or with its deviation LThighRotation=4+-2.5; "
              "mm, deg, kg. Repeatable.")
          ->type_name("NAME=VALUE[+-SD]")
          ->allow_extra_args(false);
  auto* trial = command
                    .add_option("--trial", job.trials,
                                "A trial in which landmarks of the definition were shown. Repeatable.")
                    ->type_name("NAME=FILE")
                    ->allow_extra_args(false);
  for (auto* option : {segments, still, vsk, subject, trial}) option->group("Segments");
  if (definition == "--segments")  // where it is not there anyway
    for (auto* option : {still, vsk, subject, trial}) option->needs(segments);
}

int run_segments_command(const CommonOptions& common, pipeline::SegmentsJob& job,
                         const MeasuresArguments& measures) {
  static_cast<pipeline::RecordingOptions&>(job) = measures.job;
  job.noise_sd_m = 1e-3 * measures.noise_mm;
  static_cast<pipeline::GaitOutputs&>(job) = measures.job;
  job.refits = measures.job.refits;
  job.level = measures.job.level;
  return run_job(common, "files", job, pipeline::run_segments, print_segments);
}

}  // namespace kinemark::cli
