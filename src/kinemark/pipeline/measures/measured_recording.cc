// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measured_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/pipeline/measures/trial_spans.h"
#include "kinemark/workflow/measures/measure.h"
#include "kinemark/workflow/prepare/screen_axes.h"

namespace kinemark::pipeline {
namespace {

/// What is asked of walking and of cycles fits what the command is about.
Status check_walking(const MeasuresJob& job) {
  if (job.gait.of_movement() && job.of != workflow::MeasuresOf::everything &&
      job.of != workflow::MeasuresOf::paths)
    return fail(
        Code::usage,
        fmt::format("--events movement is none of 'kinemark {}'; 'kinemark measure' takes the markers' own",
                    workflow::command_of(job.of)));
  if (job.of == workflow::MeasuresOf::muscles && job.gait.wanted() && job.emg.write_cycles.empty())
    return fail(Code::usage, fmt::format("--{} is of walking, over whose cycles nothing is written; need "
                                         "--write-cycles FILE.csv too",
                                         job.gait.events == "best" ? "gait-marker" : "events"));
  return {};
}

// What the verb found goes into the outcome, behind the warnings that are there.
void take_measured(workflow::Measured&& found, MeasuredRecording& out) {
  auto& outcome = out.outcome;
  static_cast<data::Recording&>(out.recording) = std::move(found.recording);
  out.curves = std::move(found.curves);
  std::ranges::move(found.remarks.warnings, std::back_inserter(outcome.warnings));
  std::ranges::move(found.remarks.gates, std::back_inserter(outcome.gates));
  static_cast<workflow::MeasuresFound&>(outcome) = std::move(found);
}

// What is rested on: bodies by paths and walking, plates by loads (walking judges its own), events by spans.
workflow::HeldFacts facts_of(const workflow::AskedMeasures& asked) {
  const bool body = asked.paths || asked.walking;
  return {.size = body,
          .sides = body,
          .pairs = body,
          .plates = asked.forces && !asked.walking,
          .events = !asked.options.between.empty()};
}

// Curves over strides, or over the repetitions of the markers' own movements.
Result<std::vector<RegionCurves>> cycles_of(const MeasuresJob& job, const data::Trial& trial,
                                            const MeasuresOutcome& outcome) {
  std::vector<RegionCurves> out;
  if (outcome.gait) {
    auto cut = gait_curves(trial, outcome.gait->cycles, job.gait.angles);
    if (!cut) return std::unexpected(cut.error());
    out.push_back({.region = {}, .curves = std::move(*cut)});
    return out;
  }
  for (const auto& rhythm : outcome.rhythms)
    if (!rhythm.curves.empty()) out.push_back({.region = rhythm.region, .curves = rhythm.curves});
  if (!out.empty()) return out;
  if (outcome.rhythms.empty())
    return fail(Code::bad_input, "there is no movement whose cycles could be written");
  const auto& first = outcome.rhythms.front();
  return fail(Code::bad_input, fmt::format("no movement repeats: {}: {}", first.subject, first.verdict));
}

// Trials of the file are spans, with their conditions.
Status take_trials(const MeasuresJob& job, MeasuredRecording& out, std::vector<data::Region>& spans) {
  const bool others = !job.regions.empty() || !job.between.empty() || !out.recording.edits.regions.empty();
  if (job.trials.empty() && (others || job.of != workflow::MeasuresOf::paths)) return {};
  auto trials = trial_spans(job.input, job.trials, out.recording.trial.markers.time);
  if (!trials) return std::unexpected(trials.error());
  std::ranges::move(trials->notes, std::back_inserter(out.outcome.warnings));
  spans = std::move(trials->regions);
  out.name.spans = std::move(trials->labels);
  name_span_columns(out.name);
  out.outcome.spans = out.name.spans;
  return {};
}

// Which markers have no cycles, where cycles are asked for.
void note_aimless(const MeasuresOutcome& outcome, std::vector<std::string>& notes) {
  const auto is_aimless = [](const analysis::PathRhythm& rhythm) { return !rhythm.periodic; };
  const auto first = std::ranges::find_if(outcome.rhythms, is_aimless);
  const auto count = std::ranges::count_if(outcome.rhythms, is_aimless);
  if (count == 1) notes.push_back(fmt::format("{}: {}", first->subject, first->verdict));
  if (count > 1)
    notes.push_back(fmt::format("{} paths of {} have no cycles, such as {}: {}", count,
                                outcome.rhythms.size(), first->subject, first->verdict));
}

}  // namespace

Result<workflow::AskedMeasures> asked_measures(const MeasuresJob& job) {
  const bool drawn = !job.figures.empty() || !job.report.empty();
  auto gait = gait_options(job.gait, drawn);
  if (!gait) return std::unexpected(gait.error());
  if (auto s = job.emg.check(); !s) return std::unexpected(s.error());
  if (auto s = check_walking(job); !s) return std::unexpected(s.error());
  workflow::MeasureOptions out;
  static_cast<workflow::MeasureChoice&>(out) = job;
  out.of = job.of;
  out.gait = std::move(*gait);
  out.noise_sd_m = job.noise_sd_m;
  out.seed = job.seed;
  out.threads = job.threads;
  out.keep_doubtful = !job.drops_doubtful(true);
  out.curves = drawn;
  const bool cycles_of_emg = !job.emg.write_cycles.empty();
  out.needs = {.events = job.gait.writes(),
               .own_movements = job.gait.of_movement(),
               .walking = job.gait.wanted(),
               .strides = cycles_of_emg,
               .emg = job.emg.wanted(),
               .envelopes = cycles_of_emg || !job.emg.write.empty()};
  out.emg.envelope = job.emg.envelope;
  auto asked = workflow::asked_measures(out);
  if (!asked) return asked;
  auto emg = emg_choice(job.emg);
  if (!emg) return std::unexpected(emg.error());
  asked->options.emg = std::move(*emg);
  return asked;
}

Result<MeasuredRecording> measure_recording(const MeasuresJob& job, const workflow::AskedMeasures& asked) {
  if (!job.forces.empty() && !asked.uses_forces())
    return fail(Code::usage, fmt::format("--forces: nothing that is asked for of {} is measured from forces",
                                         job.input.string()));
  const RecordingSource source{.path = job.input,
                               .needs_samples = !asked.muscles && !asked.forces,
                               .record = true,
                               .plates = asked.uses_forces(),
                               .forces = job.forces,
                               .facts = facts_of(asked),
                               .force = job.force,
                               .seed = job.seed,
                               .threads = job.threads};
  auto read = read_recording(source, job);
  if (!read) return std::unexpected(read.error());
  MeasuredRecording out{.name = name_of_recording(job.input), .recording = std::move(*read)};
  auto& trial = out.recording.trial;
  auto& outcome = out.outcome;
  outcome.input = std::move(out.recording.file);
  outcome.warnings = std::exchange(trial.warnings, {});
  if (job.participants && !take_participant(*job.participants, out.name))
    outcome.warnings.push_back(fmt::format("{}: {} has no row for {}", out.name.file,
                                           job.participants->table.name,
                                           out.name.participant.empty() ? "it" : out.name.participant));
  const std::string name = job.input.string();
  if (job.gait.into_recording()) out.recorded = trial;
  if (auto s = prepare_recording(source, job, out.recording); !s) return std::unexpected(s.error());
  if (out.recording.journal.file) outcome.beside.push_back(*out.recording.journal.file);
  std::ranges::move(out.recording.forces, std::back_inserter(outcome.beside));
  if (const auto up = workflow::stated_vertical(job.axes); up && out.recorded)
    workflow::set_screen_up(*out.recorded, up->up);
  std::ranges::move(out.recording.notes, std::back_inserter(outcome.warnings));
  std::ranges::move(std::exchange(trial.warnings, {}), std::back_inserter(outcome.warnings));
  auto spanned = asked;
  if (auto s = take_trials(job, out, spanned.options.spans); !s) return std::unexpected(s.error());
  auto found = workflow::measure_recording(std::move(static_cast<data::Recording&>(out.recording)),
                                           std::move(spanned));
  if (!found) return fail_at(name, found.error());
  take_measured(std::move(*found), out);
  const auto& time = trial.markers.time;
  if (outcome.gait)
    out.events = events_of(*outcome.gait, time);
  else
    out.events = events_of(outcome.rhythms, time);
  if (job.gait.write_cycles.empty()) return out;
  note_aimless(outcome, outcome.warnings);
  auto cycles = cycles_of(job, trial, outcome);
  if (!cycles) return fail_at(name, cycles.error());
  out.cycles = std::move(*cycles);
  return out;
}

}  // namespace kinemark::pipeline
