// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/body/motion_measures_job.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/measures/event_table.h"
#include "kinemark/pipeline/measures/gait_drawing.h"
#include "kinemark/pipeline/measures/gait_request.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/pipeline/measures/measures_nwb.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/pipeline/motion/given_motion.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/report/inputs_json.h"
#include "kinemark/workflow/measures/measure.h"
#include "kinemark/workflow/measures/regions.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

analysis::CycleSeries empty_series(const TimeBase& time, std::string id, data::Quantity quantity) {
  analysis::CycleSeries out{.id = std::move(id), .quantity = quantity};
  for (std::int64_t f = 0; f < time.frames; ++f) out.time_s.push_back(time.time_s(f));
  return out;
}

GaitDrawingJob drawing_of(const MotionMeasuresJob& job) {
  GaitDrawingJob out;
  static_cast<JobSettings&>(out) = job;
  static_cast<GaitOutputs&>(out) = job;
  out.refits = job.refits;
  out.level = job.level;
  return out;
}

// Whether the forces come with markers and events.
bool of_recording(const std::filesystem::path& forces) {
  const auto ending = ending_of(forces);
  return ending == ".c3d" || ending == ".mat";
}

Status check(const MotionMeasuresJob& job) {
  if (auto s = check_measures_output(job.output); !s) return s;
  if (job.motion.empty()) return fail(Code::usage, "no motion: give a .mot or .sto");
  if (job.model.empty()) return fail(Code::usage, "no model: give --model");
  if (!job.between.empty() && !of_recording(job.forces))
    return fail(Code::usage,
                "--between of a motion takes the events of a recording; need --forces FILE.c3d or .mat");
  if (drawing_of(job).wanted() && !of_recording(job.forces))
    return fail(
        Code::usage,
        fmt::format("--{}: cycles of a motion are cut at the foot strikes of a recording; need --forces "
                    "FILE.c3d or .mat",
                    !job.report.empty()              ? "report"
                    : !job.figures.empty()           ? "figures"
                    : !job.gait.write_events.empty() ? "write-events"
                                                     : "write-cycles"));
  if (job.first_time_s > job.last_time_s)
    return fail(Code::usage,
                fmt::format("{:g} to {:g} s is no range of time", job.first_time_s, job.last_time_s));
  std::vector<std::string> known;
  for (const auto& definition : analysis::body_definitions()) known.emplace_back(definition.what.id);
  for (const auto& id : job.measures)
    if (std::ranges::find(known, id) == known.end()) {
      const auto nearest = nearest_names(id, known);
      return fail(Code::usage,
                  fmt::format("there is no measure '{}' of a motion{}; --list shows them all", id,
                              nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
    }
  return {};
}

analysis::BodyStretch stretch_of(const data::Region& region, const TimeBase& time) {
  return {.name = region.name,
          .first = region.first_frame - time.first_number,
          .count = region.last_frame - region.first_frame + 1};
}

/// The recording that the motion is of, whose events and plates count; the plates are held against the rest
/// with the motion.
RecordingSource recording_of(const MotionMeasuresJob& job) {
  return {.path = job.forces,
          .needs_samples = true,
          .plates = true,
          .facts = {.size = false,
                    .sides = false,
                    .pairs = false,
                    .plates = false,
                    .events = !job.between.empty()},
          .force = job.force,
          .seed = job.seed,
          .threads = job.threads};
}

/// Events of the recording on the motion's clock: its own, or those of its feet where a label has none.
Result<std::vector<data::Event>> events_of(const MotionMeasuresJob& job, workflow::Remarks& remarks) {
  auto recording = open_recording(recording_of(job), {});
  if (!recording) return std::unexpected(recording.error());
  std::ranges::copy(recording->contradicted, std::back_inserter(remarks.warnings));
  workflow::add_contradictions(recording->contradicted, remarks.gates);
  auto& trial = recording->trial;
  const auto two = [&](const std::string& label) {
    return std::ranges::count(trial.events, label, &data::Event::label) > 1;
  };
  if (!std::ranges::all_of(job.between, two)) {
    if (auto gait = workflow::measure_gait(*recording, {.refits = 0})) {
      const auto of_feet = pipeline::events_of(*gait, trial.markers.time);
      trial = with_events(std::move(trial), of_feet);
      remarks.warnings.push_back(
          fmt::format("the events of feet are those that were found in {}", job.forces.filename().string()));
    }
  }
  return std::move(trial.events);
}

/// Stretches between events: "Foot Strike Left 2" is cycle 1 of the left.
Status add_cycles(const MotionMeasuresJob& job, const TimeBase& time, workflow::Remarks& remarks,
                  std::vector<analysis::BodyStretch>& stretches) {
  auto events = events_of(job, remarks);
  if (!events) return std::unexpected(events.error());
  data::Trial clock;
  clock.markers.time = time;
  clock.events = std::move(*events);
  for (const auto& label : job.between) {
    const auto cycles = workflow::regions_between(label, clock);
    if (!cycles) return fail_at(job.forces.string(), cycles.error());
    std::size_t outside = 0;
    for (const auto& region : *cycles) {
      auto stretch = stretch_of(region, time);
      const std::string rest = region.name.substr(label.size() + 1);
      const auto space = rest.rfind(' ');
      if (space != std::string::npos) stretch.context = rest.substr(0, space);
      const auto number = space == std::string::npos ? rest : rest.substr(space + 1);
      std::from_chars(number.data(), number.data() + number.size(), stretch.cycle);
      stretch.cycle -= 1;
      if (stretch.first < 0 || stretch.first + stretch.count > time.frames)
        ++outside;
      else
        stretches.push_back(std::move(stretch));
    }
    if (outside == cycles->size())
      return fail(Code::bad_input, fmt::format("{}: no span between events '{}' lies within the motion",
                                               job.forces.string(), label));
    if (outside > 0)
      remarks.warnings.push_back(
          fmt::format("{} of {} spans between events '{}' reach beyond the motion and "
                      "are left out",
                      outside, cycles->size(), label));
  }
  return {};
}

Result<std::vector<analysis::BodyStretch>> stretches_of(const MotionMeasuresJob& job, const TimeBase& time,
                                                        workflow::Remarks& remarks) {
  std::vector<analysis::BodyStretch> stretches;
  for (const auto& text : job.regions) {
    const auto region = workflow::parse_region(text, time);
    if (!region) return std::unexpected(region.error());
    stretches.push_back(stretch_of(*region, time));
    const auto& one = stretches.back();
    if (one.first < 0 || one.count < 1 || one.first + one.count > time.frames)
      return fail(Code::bad_input, fmt::format("region '{}' is not within the {} rows of the motion",
                                               region->name, time.frames));
  }
  if (!job.between.empty())
    if (auto s = add_cycles(job, time, remarks, stretches); !s) return std::unexpected(s.error());
  if (!stretches.empty()) return stretches;
  const auto last = static_cast<double>(time.frames - 1);
  const double begin = std::clamp((job.first_time_s - time.t0_s) * time.rate_hz, 0.0, last),
               end = std::clamp((job.last_time_s - time.t0_s) * time.rate_hz, 0.0, last);
  const auto first = static_cast<std::int64_t>(std::ceil(begin - 1e-3));
  stretches.push_back(
      {.first = first, .count = static_cast<std::int64_t>(std::floor(end + 1e-3)) - first + 1});
  return stretches;
}

std::vector<std::filesystem::path> files_of(const MotionMeasuresJob& job) {
  auto files = pipeline::files_of(job.gait);
  files.insert(files.end(), {job.motion, beside(job.motion, "_sd.sto"), job.model, job.forces});
  if (!job.forces.empty()) files.push_back(io::edits_of(job.forces));
  return files;
}

workflow::MotionMeasureOptions options_of(const MotionMeasuresJob& job,
                                          std::vector<analysis::BodyStretch> stretches) {
  return {.measures = job.measures,
          .select = job.select,
          .couple = job.couple,
          .stretches = std::move(stretches),
          .torques = job.torques,
          .normalized = job.normalize,
          .cutoff_hz = job.cutoff_hz,
          .refits = job.refits,
          .level = job.level,
          .seed = job.seed,
          .threads = job.threads};
}

// The motion over the cycles of the recording's feet.
Result<std::vector<ResultFile>> draw_walking(const MotionMeasuresJob& job,
                                             const workflow::MotionMeasured& measured, GaitDrawing& drawing,
                                             Staging& staging, MotionMeasuresOutcome& out) {
  const auto recording = open_recording(recording_of(job), {});
  if (!recording) return std::unexpected(recording.error());
  if (auto s = drawing.find_walking(*recording); !s) {
    if (s.error().code == Code::usage) return std::unexpected(s.error());
    out.warnings.push_back("walking is not drawn: " + s.error().message);
    return std::vector<ResultFile>();
  }
  const auto& gait = *drawing.gait();
  std::ranges::copy(gait.notes, std::back_inserter(out.warnings));
  workflow::add_contradictions(gait.contradicted, out.gates);
  std::vector<SheetInput> inputs;
  std::vector<data::CycleCurves> curves;
  add_motion_cycles(measured, gait.cycles, inputs);
  for (const auto& one : inputs)
    if (one.curves.quantity == data::Quantity::angle || one.curves.quantity == data::Quantity::length)
      curves.push_back(one.curves);
  const auto vertical = workflow::vertical_of_plates(recording->trial);
  if (recording->plates && vertical) add_ground_reaction(*recording->plates, vertical->up, gait, inputs);
  return drawing.draw(job.forces, recording->trial, curves, inputs,
                      {.angles_from = fmt::format("coordinates of {} in {}", job.model.filename().string(),
                                                  job.motion.filename().string()),
                       .inputs = out.inputs},
                      staging, out);
}

// The table of measures, and `files` with it.
Status write_all(const MotionMeasuresJob& job, std::vector<ResultFile> files, Staging& staging,
                 MotionMeasuresOutcome& out) {
  staging.add_inputs(out.inputs);
  for (const auto& file : files) out.written.push_back(file.target);  // as the table has them
  const auto ending = ending_of(job.output);
  const auto name = name_of_recording(job.motion);
  if (ending == ".csv")
    files.push_back(text_file(job.output, [&] { return measures_csv(out.measures, name); }));
  else if (ending == ".json")
    files.push_back(json_file(job.output, [json = motion_measures_json(out)] { return json; }));
  else if (!job.output.empty())
    files.push_back(nwb_file(job.output, {{.name = name, .measures = out.measures}}, out.inputs, job));
  auto written = write_results(staging, files, {}, "the measures");
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return {};
}

}  // namespace

void add_motion_cycles(const workflow::MotionMeasured& measured, std::span<const analysis::GaitCycle> cycles,
                       std::vector<SheetInput>& out) {
  const auto& motion = measured.motion;
  const auto& record = measured.record;
  for (std::int64_t c = 0; c < record.size(); ++c) {
    if (!record.measured[at(c)]) continue;
    auto one = empty_series(record.time, record.names[at(c)],
                            record.is_rotation[at(c)] ? data::Quantity::angle : data::Quantity::length);
    for (std::int64_t f = 0; f < record.frames(); ++f) {
      one.values.push_back(record.determined(f, c) ? record.q(f, c) : kNaN);
      if (record.q_sd.size() > 0) one.sd.push_back(record.q_sd(f, c));
    }
    add_series(one, cycles, "", out);
  }
  if (record.torque_known.size() == 0) return;
  for (std::int64_t c = 0; c < record.size(); ++c) {
    if (!record.driven[at(c)] || !record.is_rotation[at(c)]) continue;
    auto moment = empty_series(record.time, record.names[at(c)] + "_moment", data::Quantity::moment),
         power = empty_series(record.time, record.names[at(c)] + "_power", data::Quantity::power);
    for (std::int64_t f = 0; f < record.frames(); ++f) {
      const bool known = record.torque_known(f, c) && record.determined(f, c);
      const auto i = motion.index(f, c);
      moment.values.push_back(known ? motion.tau[i] : kNaN);
      power.values.push_back(known ? motion.tau[i] * motion.qd[i] : kNaN);
    }
    add_series(moment, cycles, "", out);
    add_series(power, cycles, "", out);
  }
}

Result<MotionMeasuresOutcome> run_motion_measures(const MotionMeasuresJob& job) {
  if (auto s = check(job); !s) return std::unexpected(s.error());
  std::vector<std::filesystem::path> targets;
  if (!job.output.empty()) targets.push_back(job.output);
  auto staging = Staging::create(targets, job, files_of(job));
  if (!staging) return std::unexpected(staging.error());
  std::optional<GaitDrawing> drawing;
  if (auto walking = drawing_of(job); walking.wanted()) {
    auto begun = GaitDrawing::begin(std::move(walking), *staging);
    if (!begun) return std::unexpected(begun.error());
    drawing.emplace(std::move(*begun));
  } else if (auto s = job.gait.check_idle(); !s) {
    return std::unexpected(s.error());
  }
  MotionMeasuresOutcome out;
  auto description = io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  auto input = io::record_input("model", job.model);
  if (!input) return std::unexpected(input.error());
  out.inputs.push_back(std::move(*input));
  const auto model = model::Model::compile(std::move(*description));
  if (!model) return fail_at(job.model.string(), model.error());
  auto read = read_motion(job.motion, job.forces, *model, job.cutoff_hz);
  if (!read) return std::unexpected(read.error());
  auto& time = read->given.motion.time;
  time.first_number = 1;
  std::ranges::move(read->inputs, std::back_inserter(out.inputs));
  workflow::Remarks of_spans;
  auto stretches = stretches_of(job, time, of_spans);
  if (!stretches) return std::unexpected(stretches.error());
  auto measured = workflow::measure_motion(*model, read->given, options_of(job, std::move(*stretches)));
  if (!measured) return std::unexpected(measured.error());
  out.measures = std::move(measured->measures);
  out.gates = std::move(of_spans.gates);
  std::ranges::move(measured->remarks.gates, std::back_inserter(out.gates));
  for (auto* sentences : {&read->notes, &measured->remarks.warnings, &of_spans.warnings, &measured->left_out})
    std::ranges::move(*sentences, std::back_inserter(out.warnings));
  std::vector<ResultFile> files;
  if (drawing) {
    auto drawn = draw_walking(job, *measured, *drawing, *staging, out);
    if (!drawn) return std::unexpected(drawn.error());
    files = std::move(*drawn);
  }
  if (auto s = write_all(job, std::move(files), *staging, out); !s) return std::unexpected(s.error());
  return out;
}

nlohmann::ordered_json motion_measures_json(const MotionMeasuresOutcome& outcome) {
  nlohmann::ordered_json out;
  out["inputs"] = report::inputs_json(outcome.inputs);
  out["measures"] = measures_json(outcome.measures);
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
