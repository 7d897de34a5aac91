// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/info_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/data/filtering.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/io/markers/orientation_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/recording/markers_recording.h"
#include "kinemark/io/recording/mcap_markers.h"
#include "kinemark/io/recording/survey.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/coordinate_rows.h"
#include "kinemark/stages/analysis/consistency/motion_facts.h"
#include "kinemark/stages/analysis/consistency/table_facts.h"
#include "kinemark/workflow/measures/emg_channels.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/exchanged_labels.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::pipeline {
namespace {

std::int64_t missing_frames(const data::Channels& channels, std::size_t c) {
  std::int64_t missing = 0;
  for (std::size_t i = 3 * c; i < channels.values.size(); i += 3 * channels.names.size())
    missing += std::isnan(channels.values[i]);
  return missing;
}

std::vector<ChannelFacts> describe_channels(const data::Channels& channels) {
  std::vector<ChannelFacts> facts;
  for (std::size_t c = 0; c < channels.names.size(); ++c)
    facts.push_back({.name = channels.names[c],
                     .kind = std::string(data::to_string(channels.kinds[c])),
                     .unit = channels.units[c],
                     .rate_hz = channels.rate_hz,
                     .missing = missing_frames(channels, c)});
  return facts;
}

std::string describe_up(const InfoJob& job, const data::Trial& trial) {
  auto vertical = workflow::stated_vertical(job.axes);
  if (!vertical) vertical = workflow::vertical_of_plates(trial);
  if (!vertical) vertical = workflow::vertical_of_screen(trial);
  return vertical ? fmt::format("{}, by {}", workflow::name_of_direction(vertical->up), vertical->from) : "";
}

OrientationFacts facts_of(const data::Orientations& sensors) {
  OrientationFacts facts{.frames = sensors.frames(),
                         .rate_hz = sensors.time.rate_hz,
                         .first_time_s = sensors.time.t0_s,
                         .last_time_s = sensors.time.time_s(std::max<std::int64_t>(0, sensors.frames() - 1))};
  for (std::int64_t s = 0; s < sensors.size(); ++s) {
    SensorFacts one{.name = sensors.names[at(s)]};
    for (std::int64_t f = 0; f < facts.frames; ++f) {
      if (!sensors.present(f, s)) {
        ++one.missing;
      } else if (!one.first) {
        one.first.emplace();
        std::copy_n(sensors.quaternion.data() + 4 * (f * sensors.size() + s), 4, one.first->begin());
      }
    }
    facts.missing += one.missing;
    facts.sensors.push_back(std::move(one));
  }
  return facts;
}

Status describe_orientations(const InfoJob& job, InfoOutcome& out) {
  auto sensors = io::read_orientation_file(job.file);
  if (!sensors) return std::unexpected(sensors.error());
  out.facts = facts_of(*sensors);
  out.warnings = std::move(sensors->warnings);
  return {};
}

/// A recording, held against all that is known of it; what its plates are like is for who checks it.
Result<Recording> open_whole(const InfoJob& job) {
  const RecordingSource source{.path = job.file,
                               .rate = io::RateRule::or_unknown,
                               .plates = true,
                               .facts = workflow::HeldFacts::all(),
                               .force = job.force};
  auto recording = read_recording(source, job);
  if (!recording) return recording;
  if (!job.find_exchanges) recording->notes.clear();
  if (auto s = prepare_recording(source, job, *recording); !s) return std::unexpected(s.error());
  return recording;
}

Status describe_markers(const InfoJob& job, InfoOutcome& out) {
  auto recording = open_whole(job);
  const bool turned = io::has_orientations(job.file);
  if (!recording && turned && job.RecordingOptions::empty() && describe_orientations(job, out)) return {};
  if (!recording) return std::unexpected(recording.error());
  auto& trial = recording->trial;
  out.warnings = trial.warnings;
  for (const auto& note : recording->notes)
    if (std::ranges::find(recording->contradicted, note) == recording->contradicted.end())
      out.warnings.push_back(note);
  out.contradicted = std::move(recording->contradicted);
  std::ranges::move(workflow::contradicted_channels(trial), std::back_inserter(out.contradicted));
  if (job.drops_doubtful(false))
    if (auto s = workflow::leave_out_defects(trial, false, recording->edits.swapped, out.warnings); !s)
      return fail_at(job.file.string(), s.error());
  const auto& markers = trial.markers;
  MarkerFileFacts facts{.format = trial.format,
                        .units = trial.units_in_file,
                        .software = trial.software,
                        .points = markers.markers(),
                        .frames = markers.frames(),
                        .rate_hz = recording->rate_known ? std::optional(markers.time.rate_hz) : std::nullopt,
                        .first_frame = trial.first_frame,
                        .last_frame = trial.last_frame(),
                        .missing = markers.count_missing(),
                        .analog_channels = trial.analog.names.size(),
                        .analog_rate_hz = trial.analog.rate_hz,
                        .force_plates = std::max(trial.force_plates.size(),
                                                 recording->plates ? recording->plates->items.size() : 0),
                        .events = trial.events.size(),
                        .labels = markers.names,
                        .channels = describe_channels(trial.channels),
                        .up = describe_up(job, trial),
                        .calibration_error = data::describe(trial.calibration_error, markers),
                        .beside = trial.beside.objects,
                        .filtered = data::describe_filters(markers)};
  for (const auto& name : markers.names)
    if (data::is_unlabelled(name)) facts.unlabelled.push_back(name);
  const auto apart = workflow::find_points_apart(markers);
  for (const auto m : apart.computed) facts.computed.push_back(markers.names[at(m)]);
  std::vector<std::uint8_t> no_markers(markers.names.size(), 0);
  for (const auto m : apart.all()) no_markers[at(m)] = 1;
  facts.set = data::find_marker_set(markers.names, no_markers);
  if (turned) {
    const auto sensors = io::read_orientation_file(job.file);
    if (sensors) facts.orientations = facts_of(*sensors);
    if (!sensors) out.warnings.push_back(sensors.error().message);
  }
  out.facts = std::move(facts);
  if (!job.find_exchanges) return {};
  if (!recording->plates_fault.empty()) out.warnings.push_back(recording->plates_fault);
  if (!recording->rate_known) return {};
  const auto swaps = workflow::find_label_swaps(trial);
  if (!swaps) return std::unexpected(swaps.error());
  for (const auto& swap : workflow::sure_swaps(*swaps))
    out.warnings.push_back(sentence_of(swap, markers.time));
  return {};
}

/// A table of coordinates beside the model that it is of; another one says nothing of it.
void hold_beside_model(const model::Model& model, const data::Table& table, InfoOutcome& out) {
  const auto rows = coordinate_rows(model, table);
  if (!rows) return;
  data::JointMotion motion;
  motion.time = rows->time;
  data::set_coordinates(model.description(), motion);
  for (const auto& q : rows->q) motion.q.insert(motion.q.end(), q.begin(), q.end());
  std::ranges::move(analysis::coordinates_out_of_range(model.description(), motion),
                    std::back_inserter(out.contradicted));
}

Status describe_table(const InfoJob& job, InfoOutcome& out) {
  if (io::has_orientations(job.file)) return describe_orientations(job, out);
  auto table = io::read_table(job.file);
  if (!table) return std::unexpected(table.error());
  TableFacts facts{
      .rows = table->rows(), .in_degrees = io::angles_are_degrees(*table), .labels = table->columns};
  if (facts.rows > 0) {
    facts.first_time_s = table->time_s.front();
    facts.last_time_s = table->time_s.back();
  }
  out.facts = std::move(facts);
  out.warnings = std::move(table->warnings);
  out.contradicted = analysis::contradicted_values(*table, job.file.filename().string());
  if (job.model != nullptr) hold_beside_model(*job.model, *table, out);
  return {};
}

Status describe_model(const InfoJob& job, InfoOutcome& out) {
  auto model = io::read_osim(job.file);
  if (!model) return std::unexpected(model.error());
  ModelFacts facts{.name = model->name,
                   .joints = model->joints.size(),
                   .markers = model->markers.size(),
                   .couplings = model->couplings.size(),
                   .point_constraints = model->point_constraints.size()};
  for (const auto& body : model->bodies) {
    facts.mass_kg += body.mass;
    facts.body_names.push_back(body.name);
  }
  for (const auto& coordinate : model->coordinates) facts.labels.push_back(coordinate.name);
  out.warnings = std::move(model->warnings);
  out.contradicted = workflow::contradicted_model(*model, &facts.notes);
  out.facts = std::move(facts);
  return {};
}

/// What the counts of a recording are, and how many of their observations are flawed.
Result<CountsFacts> describe_counts(const std::filesystem::path& path) {
  const auto recording = io::read_counts(path);
  if (!recording) return std::unexpected(recording.error());
  const data::Counts& counts = recording->counts;
  const auto flagged = [&counts](data::CountFlag flag) -> std::int64_t {
    return std::ranges::count_if(counts.flags, [flag](std::uint8_t flags) { return (flags & flag) != 0; });
  };
  return CountsFacts{.frames = counts.frames(),
                     .rate_hz = counts.time.rate_hz,
                     .first_time_s = counts.time.t0_s,
                     .rig = counts.rig_id,
                     .dark_slot = counts.has_dark_slot(),
                     .saturated = flagged(data::kCountSaturated),
                     .occluded = flagged(data::kCountOccluded),
                     .lost = flagged(data::kCountLost),
                     .cameras = counts.cameras,
                     .labels = counts.leds};
}

/// What is no recording of markers has no use for the options of one.
Status check_no_options(const InfoJob& job) {
  if (job.RecordingOptions::empty()) return {};
  return fail(
      Code::usage,
      fmt::format("{}: is no recording of markers; --rate, --edits, --select and the other options of "
                  "one are not for it",
                  job.file.string()));
}

/// Of an MCAP file of another program, and of a recording of markers, what of it is markers.
Status describe_recording(const InfoJob& job, InfoOutcome& out) {
  const auto begin = io::read_begin(job.file);
  if (!begin) return std::unexpected(begin.error());
  if (io::is_mcap_of_others(*begin)) return describe_markers(job, out);
  auto survey = io::survey_recording(job.file);
  if (!survey) return std::unexpected(survey.error());
  if (std::ranges::any_of(survey->channels, io::carries_markers)) return describe_markers(job, out);
  if (auto s = check_no_options(job); !s) return s;
  RecordingFacts facts{.end = survey->end, .bytes = survey->bytes, .messages = survey->messages};
  for (const auto& channel : survey->channels) facts.channels.push_back(channel.topic);
  for (const auto& metadata : survey->metadata) facts.metadata.push_back(metadata.name);
  if (std::ranges::any_of(survey->channels, io::carries_counts)) {
    auto counts = describe_counts(job.file);
    if (!counts) return std::unexpected(counts.error());
    facts.counts = std::move(*counts);
  }
  out.facts = std::move(facts);
  out.warnings = std::move(survey->warnings);
  return {};
}

Status describe_skeleton(const InfoJob& job, InfoOutcome& out) {
  auto vsk = io::read_vsk(job.file);
  if (!vsk) return std::unexpected(vsk.error());
  out.warnings = std::exchange(vsk->warnings, {});
  out.facts = std::move(*vsk);
  return {};
}

}  // namespace

Result<InfoOutcome> run_info(const InfoJob& job) {
  const std::string ending = ending_of(job.file);
  const auto describe = ending == ".osim"                      ? describe_model
                        : ending == ".mot" || ending == ".sto" ? describe_table
                        : ending == ".mcap"                    ? describe_recording
                        : io::is_vsk_ending(ending)            ? describe_skeleton
                                                               : describe_markers;
  const bool may_hold_markers = describe == describe_markers || describe == describe_recording;
  if (auto s = may_hold_markers ? Status() : check_no_options(job); !s) return std::unexpected(s.error());
  InfoOutcome out;
  out.file = job.file;
  if (auto s = describe(job, out); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::pipeline
