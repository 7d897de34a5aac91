// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measured_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/pipeline/measures/measure_regions.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/screen_axes.h"

namespace kinemark::pipeline {
namespace {

Result<std::vector<data::Region>> regions_of(const MeasuresJob& job, const data::Trial& trial,
                                             std::vector<data::Region> regions) {
  for (const auto& text : job.regions) {
    auto region = parse_region(text, trial.markers.time);
    if (!region) return std::unexpected(region.error());
    regions.push_back(std::move(*region));
  }
  for (const auto& label : job.between) {
    auto cycles = regions_between(label, trial);
    if (!cycles) return std::unexpected(cycles.error());
    std::ranges::move(*cycles, std::back_inserter(regions));
  }
  if (auto s = analysis::check_regions(trial.markers.time, regions); !s) return std::unexpected(s.error());
  return regions;
}

// Screening, after which the recording is as it is measured; the regions to measure.
Result<std::vector<data::Region>> prepare(const MeasuresJob& job, Recording& recording,
                                          MeasuresOutcome& outcome) {
  std::ranges::move(recording.notes, std::back_inserter(outcome.warnings));
  std::ranges::move(std::exchange(recording.trial.warnings, {}), std::back_inserter(outcome.warnings));
  if (auto s = workflow::leave_out_defects(recording.trial, !job.drops_doubtful(true),
                                           recording.edits.swapped, outcome.warnings);
      !s)
    return std::unexpected(s.error());
  return regions_of(job, recording.trial, std::move(recording.edits.regions));
}

// Steps and standing on plates.
Status measure_plates(const AskedMeasures& asked, const Recording& recording, MeasuresOutcome& outcome) {
  const auto& plates = recording.plates;
  if (!plates) return fail(Code::bad_input, "there are no force plates whose forces can be read");
  auto options = asked.plates;
  options.regions = asked.path.regions;
  if (outcome.gait) options.events = outcome.gait->events;
  auto measured = analysis::measure_forces(*plates, options);
  if (!measured) return std::unexpected(measured.error());
  std::ranges::move(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::move(measured->notes, std::back_inserter(outcome.warnings));
  return {};
}

// Electromyograms, where channels are named or known by their names.
Status measure_muscles(const MeasuresJob& job, const AskedMeasures& asked, const data::Trial& trial,
                       MeasuresOutcome& outcome) {
  auto measured = measure_emg_of(trial, job.emg, asked.path.regions, asked.emg);
  if (!measured) return std::unexpected(measured.error());
  std::ranges::copy(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::copy(measured->notes, std::back_inserter(outcome.warnings));
  outcome.emg = std::move(*measured);
  return {};
}

// A failure of what was asked for by name ends the job where nothing else is measured, and is told else; what
// was not asked for is simply not there.
Status take_failure(const Status& status, const char* what, bool by_name, bool needed,
                    MeasuresOutcome& outcome) {
  if (status || !by_name) return {};
  if (needed || status.error().code == Code::usage) return status;
  outcome.warnings.push_back(fmt::format("{} are not measured: {}", what, status.error().message));
  return {};
}

// The first sentence on why there is no measure.
std::string why_nothing(const analysis::PathMeasures& measured) {
  if (!measured.warnings.empty()) return measured.warnings.front();
  if (!measured.rhythms.empty())
    return fmt::format("{}: {}", measured.rhythms.front().subject, measured.rhythms.front().verdict);
  return "no measure applies";
}

// Why walking is not measured.
struct NoWalking {
  Status ends_job;                 ///< a failure that ends the job
  Status ends_job_without_plates;  ///< one that does so only where plates show nothing either
};

NoWalking measure_walking(const MeasuresJob& job, const AskedMeasures& asked, const Recording& recording,
                          MeasuresOutcome& outcome) {
  const bool events_needed = job.gait.writes() || !job.emg.write_cycles.empty();
  auto gait = measure_gait(recording, asked.gait);
  if (gait) {
    std::ranges::copy(gait->notes, std::back_inserter(outcome.warnings));
    if (job.of != MeasuresOf::muscles) outcome.measures = gait->measures;
    outcome.gait = std::move(*gait);
    return {};
  }
  auto failure = std::unexpected(gait.error());
  const bool alone = job.of == MeasuresOf::walking;
  if (asked.by_name && (!asked.paths || events_needed || gait.error().code == Code::usage))
    return {.ends_job = failure};
  if (alone && events_needed) return {.ends_job = failure};
  if (alone && job.measures.empty()) return {.ends_job_without_plates = failure};
  if (asked.by_name || recording.up)  // who states which way is up hears what came of it
    outcome.warnings.push_back("Walking is not measured: " + gait.error().message);
  else if (job.gait.writes())
    outcome.warnings.push_back(
        "events and cycles are those of the markers' own movements, as there is no walking: " +
        gait.error().message);
  return {};
}

// Walking, plates, EMG, then paths; what fails is reported where something else is measured.
Status measure_all(const MeasuresJob& job, const AskedMeasures& asked, const Recording& recording,
                   std::vector<analysis::PathCurves>& curves, MeasuresOutcome& outcome) {
  const auto& trial = recording.trial;
  NoWalking walking;
  if (asked.walking) walking = measure_walking(job, asked, recording, outcome);
  if (!walking.ends_job) return walking.ends_job;
  const bool others = asked.paths || asked.by_name;
  const Status plates = asked.forces ? measure_plates(asked, recording, outcome) : Status();
  if (auto s = take_failure(plates, "Force plates", asked.forces_by_name, !others && !asked.muscles_by_name,
                            outcome);
      !s)
    return s;
  if (const auto& late = walking.ends_job_without_plates; !late) {
    if (outcome.measures.empty() && !plates && recording.plates)
      return fail(late.error().code, late.error().message + "; " + plates.error().message);
    if (outcome.measures.empty()) return late;
    outcome.warnings.push_back("Walking is not measured: " + late.error().message);
  }
  if (asked.muscles)
    if (auto s = take_failure(
            measure_muscles(job, asked, trial, outcome), "EMG", asked.muscles_by_name,
            (!others && outcome.measures.empty()) || !job.emg.write.empty() || !job.emg.write_cycles.empty(),
            outcome);
        !s)
      return s;
  // Where no foot steps, or nobody asks whether one does, events and cycles are those of the markers' own
  // movements.
  const bool own = (job.gait.writes() || job.gait.of_movement()) && !outcome.gait;
  if (!asked.paths && !own) return {};
  auto options = asked.path;
  options.rhythms = own;
  if (!asked.paths)
    for (const auto& definition : analysis::rhythm_definitions())
      options.measures.emplace_back(definition.id);
  auto measured = analysis::measure_paths(trial.markers, options);
  if (!measured) return std::unexpected(measured.error());
  if (measured->measures.empty() && outcome.measures.empty())
    return fail(Code::bad_input, fmt::format("nothing can be measured: {}", why_nothing(*measured)));
  curves = std::move(measured->curves);
  outcome.rhythms = std::move(measured->rhythms);
  outcome.noises = std::move(measured->noises);
  std::ranges::move(measured->measures, std::back_inserter(outcome.measures));
  std::ranges::move(measured->warnings, std::back_inserter(outcome.warnings));
  return {};
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

Result<MeasuredRecording> measure_recording(const MeasuresJob& job, AskedMeasures asked) {
  if (!job.forces.empty() && !asked.walking && !asked.forces)
    return fail(Code::usage, fmt::format("--forces: nothing that is asked for of {} is measured from forces",
                                         job.input.string()));
  const RecordingSource source{.path = job.input,
                               .needs_samples = true,
                               .record = true,
                               .plates = asked.walking || asked.forces,
                               .forces = job.forces,
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
  if (ending_of(job.gait.write_events) == ".c3d") out.recorded = trial;
  if (auto s = prepare_recording(source, job, out.recording); !s) return std::unexpected(s.error());
  if (out.recording.journal.file) outcome.beside.push_back(*out.recording.journal.file);
  std::ranges::move(out.recording.forces, std::back_inserter(outcome.beside));
  if (const auto up = workflow::stated_vertical(job.axes); up && out.recorded)
    workflow::set_screen_up(*out.recorded, up->up);
  auto regions = prepare(job, out.recording, outcome);
  if (!regions) return fail_at(name, regions.error());
  asked.path.regions = asked.gait.regions = std::move(*regions);
  if (auto s = measure_all(job, asked, out.recording, out.curves, outcome); !s)
    return fail_at(name, s.error());
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
