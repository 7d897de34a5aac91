// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/measures/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "kinemark/stages/trajectory/edits/part_of_trial.h"
#include "kinemark/workflow/measures/regions.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/stated_mass.h"

namespace kinemark::workflow {
namespace {

/// Regions of the edits, spans, those that the options name, and spans between events.
Result<std::vector<data::Region>> regions_of(const MeasureOptions& options,
                                             const data::Recording& recording) {
  const auto& trial = recording.trial;
  auto regions = recording.edits.regions;
  std::ranges::copy(options.spans, std::back_inserter(regions));
  for (const auto& text : options.regions) {
    auto region = parse_region(text, trial.markers.time);
    if (!region) return std::unexpected(region.error());
    regions.push_back(std::move(*region));
  }
  for (const auto& label : options.between) {
    auto cycles = regions_between(label, trial);
    if (!cycles) return std::unexpected(cycles.error());
    std::ranges::move(*cycles, std::back_inserter(regions));
  }
  if (auto s = analysis::check_regions(trial.markers.time, regions); !s) return std::unexpected(s.error());
  return regions;
}

// Steps and standing on plates.
Status measure_plates(const AskedMeasures& asked, const data::Recording& recording, Measured& found) {
  const auto& plates = recording.plates;
  if (!plates) return fail(Code::bad_input, "there are no force plates whose forces can be read");
  auto of_plates = asked.plates;
  of_plates.regions = asked.path.regions;
  if (found.gait) of_plates.events = found.gait->events;
  auto measured = analysis::measure_forces(*plates, of_plates);
  if (!measured) return std::unexpected(measured.error());
  std::ranges::move(measured->measures, std::back_inserter(found.measures));
  std::ranges::move(measured->notes, std::back_inserter(found.remarks.warnings));
  return {};
}

// Electromyograms, where channels are named or known by their names.
Status measure_muscles(const AskedMeasures& asked, const data::Trial& trial, Measured& found) {
  auto measured = measure_channels(trial, asked.options.emg, asked.path.regions, asked.emg);
  if (!measured) return std::unexpected(measured.error());
  std::ranges::copy(measured->measures, std::back_inserter(found.measures));
  std::ranges::copy(measured->notes, std::back_inserter(found.remarks.warnings));
  add_contradictions(measured->contradicted, found.remarks.gates);
  found.emg = std::move(*measured);
  return {};
}

// A failure of what was asked for by name ends the verb where nothing else is measured, and is a remark else;
// what was not asked for is simply not there.
Status take_failure(const Status& status, const char* what, bool by_name, bool needed, Measured& found) {
  if (status || !by_name) return {};
  if (needed || status.error().code == Code::usage) return status;
  found.remarks.warnings.push_back(fmt::format("{} are not measured: {}", what, status.error().message));
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
  Status ends_all;             ///< a failure that ends it
  Status ends_without_plates;  ///< one that does so only where plates show nothing either
};

NoWalking measure_walking(const AskedMeasures& asked, const data::Recording& recording, Measured& found) {
  const auto& options = asked.options;
  const auto& needs = options.needs;
  const bool events_needed = needs.events || needs.strides;
  auto gait = measure_gait(recording, asked.gait);
  if (gait) {
    std::ranges::copy(gait->notes, std::back_inserter(found.remarks.warnings));
    add_contradictions(gait->contradicted, found.remarks.gates);
    if (options.of != MeasuresOf::muscles) found.measures = gait->measures;
    found.gait = std::move(*gait);
    return {};
  }
  auto failure = std::unexpected(gait.error());
  const bool alone = options.of == MeasuresOf::walking;
  if (asked.by_name && (!asked.paths || events_needed || gait.error().code == Code::usage))
    return {.ends_all = failure};
  if (alone && events_needed) return {.ends_all = failure};
  if (alone && options.measures.empty()) return {.ends_without_plates = failure};
  if (asked.by_name || recording.up)  // who states which way is up hears what came of it
    found.remarks.warnings.push_back("Walking is not measured: " + gait.error().message);
  else if (needs.events)
    found.remarks.warnings.push_back(
        "events and cycles are those of the markers' own movements, as there is no walking: " +
        gait.error().message);
  return {};
}

// Walking, plates, EMG, then paths; what fails is reported where something else is measured.
Status measure_all(const AskedMeasures& asked, const data::Recording& recording, Measured& found) {
  const auto& needs = asked.options.needs;
  const auto& trial = recording.trial;
  NoWalking walking;
  if (asked.walking) walking = measure_walking(asked, recording, found);
  if (!walking.ends_all) return walking.ends_all;
  const bool others = asked.paths || asked.by_name;
  const Status plates = asked.forces ? measure_plates(asked, recording, found) : Status();
  if (auto s = take_failure(plates, "Force plates", asked.forces_by_name, !others && !asked.muscles_by_name,
                            found);
      !s)
    return s;
  if (const auto& late = walking.ends_without_plates; !late) {
    if (found.measures.empty() && !plates && recording.plates)
      return fail(late.error().code, late.error().message + "; " + plates.error().message);
    if (found.measures.empty()) return late;
    found.remarks.warnings.push_back("Walking is not measured: " + late.error().message);
  }
  if (asked.muscles)
    if (auto s = take_failure(measure_muscles(asked, trial, found), "EMG", asked.muscles_by_name,
                              (!others && found.measures.empty()) || needs.envelopes, found);
        !s)
      return s;
  // Where no foot steps, or nobody asks whether one does, events and cycles are those of the markers' own
  // movements.
  const bool own = (needs.events || needs.own_movements) && !found.gait;
  if (!asked.paths && !own) return {};
  if (trial.markers.markers() == 0) {  // plates or EMG alone
    if (!found.measures.empty()) return {};
    return fail(Code::bad_input, fmt::format("there are no markers to measure{}{}", plates ? "" : "; ",
                                             plates ? "" : plates.error().message));
  }
  auto of_paths = asked.path;
  of_paths.rhythms = own;
  of_paths.calibration_error = trial.calibration_error;
  if (!asked.paths)
    for (const auto& definition : analysis::rhythm_definitions())
      of_paths.measures.emplace_back(definition.id);
  auto measured = analysis::measure_paths(trial.markers, of_paths);
  if (!measured) return std::unexpected(measured.error());
  if (measured->measures.empty() && found.measures.empty())
    return fail(Code::bad_input, fmt::format("nothing can be measured: {}", why_nothing(*measured)));
  if (of_paths.refits > 0)
    if (auto note = data::note_held("Intervals", data::rms_of(trial.calibration_error, trial.markers));
        !note.empty())
      found.remarks.warnings.push_back(std::move(note));
  found.curves = std::move(measured->curves);
  found.rhythms = std::move(measured->rhythms);
  found.noises = std::move(measured->noises);
  std::ranges::move(measured->measures, std::back_inserter(found.measures));
  std::ranges::move(measured->warnings, std::back_inserter(found.remarks.warnings));
  return {};
}

/// Points that are no markers go, with a remark.
void leave_points_apart(Measured& found) {
  auto& trial = found.recording.trial;
  const auto apart = find_points_apart(trial.markers);
  const auto all = apart.all();
  if (all.empty()) return;
  found.remarks.warnings.push_back(
      fmt::format("No markers, and not measured unless they are selected alone: {}",
                  apart.describe(trial.markers.names)));
  std::vector<std::int64_t> kept, channels(at(trial.channels.count()));
  for (std::int64_t m = 0; m < trial.markers.markers(); ++m)
    if (!std::ranges::binary_search(all, m)) kept.push_back(m);
  std::iota(channels.begin(), channels.end(), 0);
  trajectory::keep_part(trial, {.first = 0, .count = trial.markers.frames()}, kept, channels);
}

Result<Measured> measure_as(MeasuresOf of, data::Recording recording, MeasureOptions options) {
  options.of = of;
  auto asked = asked_measures(options);
  if (!asked) return std::unexpected(asked.error());
  return measure_recording(std::move(recording), std::move(*asked));
}

}  // namespace

Result<analysis::Gait> measure_gait(const data::Recording& recording, const analysis::GaitOptions& options) {
  auto stated = options;
  if (recording.up) stated.up = recording.up;
  return analysis::analyze_gait(recording.trial.markers,
                                {.plates = recording.plates ? &*recording.plates : nullptr,
                                 .events = recording.trial.events,
                                 .mass_kg = stated_mass_kg(recording.trial)},
                                stated);
}

Result<Measured> measure_recording(data::Recording recording, AskedMeasures asked) {
  Measured found;
  found.recording = std::move(recording);
  add_contradictions(found.recording.contradicted, found.remarks.gates);
  leave_points_apart(found);
  if (auto s = leave_out_defects(found.recording.trial, asked.options.keep_doubtful,
                                 found.recording.edits.swapped, found.remarks.warnings);
      !s)
    return std::unexpected(s.error());
  auto regions = regions_of(asked.options, found.recording);
  if (!regions) return std::unexpected(regions.error());
  asked.path.regions = asked.gait.regions = std::move(*regions);
  if (auto s = measure_all(asked, found.recording, found); !s) return std::unexpected(s.error());
  return found;
}

Result<Measured> measure(data::Recording recording, const MeasureOptions& options) {
  return measure_as(MeasuresOf::paths, std::move(recording), options);
}

Result<Measured> gait(data::Recording recording, const MeasureOptions& options) {
  return measure_as(MeasuresOf::walking, std::move(recording), options);
}

Result<Measured> emg(data::Recording recording, const MeasureOptions& options) {
  return measure_as(MeasuresOf::muscles, std::move(recording), options);
}

}  // namespace kinemark::workflow
