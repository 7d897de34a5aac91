// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/segments/segments_job.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/data/name_index.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/marker_screening.h"
#include "kinemark/pipeline/files/plates.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/files/vertical.h"
#include "kinemark/pipeline/foundations/foundation_gate.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"
#include "kinemark/pipeline/segments/definition_file.h"
#include "kinemark/pipeline/segments/modelled_points.h"
#include "kinemark/pipeline/segments/segment_tables.h"
#include "kinemark/pipeline/segments/subject_values.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// All that is read. Formulas see the markers with modelled points where some stand in for markers.
struct Files {
  data::Trial recording;
  std::unique_ptr<data::Trial> static_trial;  // null: none, or the recording
  bool static_is_recording = false;
  std::map<std::string, std::unique_ptr<data::Trial>> trials;
  std::map<const data::Trial*, std::unique_ptr<MarkersAndModelled>> modelled;

  [[nodiscard]] const data::Trajectories* markers_of(const data::Trial& trial) const {
    const auto at = modelled.find(&trial);
    return at == modelled.end() ? &trial.markers : &at->second->markers;
  }
};

Result<data::Trial> read_trial(const SegmentsJob& job, const fs::path& path, SegmentsOutcome& outcome) {
  auto input = read_marker_input({.path = path,
                                  .rate_hz = job.rate_hz,
                                  .rate = RateRule::where_needed,
                                  .needs_samples = true,
                                  .record = true});
  if (!input) return std::unexpected(input.error());
  outcome.inputs.push_back(std::move(input->file));
  std::ranges::move(input->trial.warnings, std::back_inserter(outcome.warnings));
  input->trial.warnings.clear();
  // The recording is screened when its part is taken.
  if (path != job.input)
    if (auto s = leave_out_defects(input->trial, job.keep_defects, outcome.warnings); !s)
      return fail_at(path.string(), s.error());
  return std::move(input->trial);
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

Result<Files> read_files(const SegmentsJob& job, SegmentsOutcome& outcome) {
  Files out;
  auto recording = read_trial(job, job.input, outcome);
  if (!recording) return std::unexpected(recording.error());
  out.recording = std::move(*recording);
  if (auto s = take_selection(job.selection, out.recording); !s)
    return fail_at(job.input.string(), s.error());
  if (auto s = leave_out_defects(out.recording, job.keep_defects, outcome.warnings); !s)
    return fail_at(job.input.string(), s.error());
  out.static_is_recording = !job.static_trial.empty() && same_file(job.static_trial, job.input);
  if (!job.static_trial.empty() && !out.static_is_recording) {
    auto trial = read_trial(job, job.static_trial, outcome);
    if (!trial) return std::unexpected(trial.error());
    out.static_trial = std::make_unique<data::Trial>(std::move(*trial));
  }
  for (const auto& text : job.trials) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not NAME=FILE", text));
    auto trial = read_trial(job, text.substr(equals + 1), outcome);
    if (!trial) return std::unexpected(trial.error());
    out.trials[text.substr(0, equals)] = std::make_unique<data::Trial>(std::move(*trial));
  }
  return out;
}

// Modelled points under names that the definition has for markers of which there are no samples.
void take_modelled_points(const data::Trial& trial, const std::string& file,
                          const std::set<std::string>& wanted, Files& files,
                          std::vector<std::string>& warnings) {
  auto found = with_modelled_points(trial, wanted);
  if (!found) return;
  warnings.push_back(fmt::format("{}: not measured, taken as a model of the file has them: {}", file,
                                 fmt::join(found->points, ", ")));
  files.modelled[&trial] = std::make_unique<MarkersAndModelled>(std::move(*found));
}

// Modelled points of all trials, and names of outputs in them.
void join_points(const SegmentsJob& job, const analysis::SegmentDefinition& definition, Files& files,
                 analysis::SegmentInput& input, std::vector<std::string>& warnings) {
  const auto wanted = names_of_points(definition);
  const auto take = [&](const data::Trial& trial, const fs::path& path) {
    take_modelled_points(trial, path.filename().string(), wanted, files, warnings);
    for (auto& [name, theirs] : suffixed_names(trial.markers.names, wanted))
      input.aliases.try_emplace(name, theirs);
    return files.markers_of(trial);
  };
  input.markers = take(files.recording, job.input);
  if (files.static_is_recording) input.static_trial = input.markers;
  if (files.static_trial) input.static_trial = take(*files.static_trial, job.static_trial);
  for (const auto& [name, trial] : files.trials) input.trials[name] = take(*trial, name);
}

// Laboratories whose marker set has a knee alignment device or medial markers measure the wands' offsets.
bool measures_offsets(const data::Trial& trial) {
  for (const auto& group : trial.foreign) {
    if (group.name != "SUBJECTS") continue;
    for (const auto& parameter : group.parameters) {
      if (!parameter.name.starts_with("MARKER_SET")) continue;
      std::string text;
      for (const auto byte : parameter.values)
        text += static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
      if (text.find("KAD") != std::string::npos || text.find("MED") != std::string::npos) return true;
    }
  }
  return std::ranges::any_of(trial.markers.names, [](const std::string& name) {
    const auto plain = data::without_prefix(name);
    return plain.size() >= 4 && (plain.substr(1) == "KAX" || plain.substr(1) == "MED" ||
                                 plain.substr(1) == "KNEMED" || plain.substr(1) == "KD1");
  });
}

Result<Eigen::Vector3d> up_of(const SegmentsJob& job, const data::Trial& trial) {
  if (job.up.empty()) {
    if (const auto plates = vertical_of_plates(trial)) return plates->up;
    if (const auto screen_up = vertical_of_screen(job.input)) return screen_up->up;
    return Eigen::Vector3d::UnitZ();
  }
  const std::string_view axis = job.up.front() == '-' ? std::string_view(job.up).substr(1) : job.up;
  if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z')
    return fail(Code::usage, fmt::format("up is '{}'; expected x, y, z, -x, -y or -z", job.up));
  return Eigen::Vector3d(Eigen::Vector3d::Unit(axis[0] - 'x') * (job.up.front() == '-' ? -1.0 : 1.0));
}

Status find_values(const SegmentsJob& job, const analysis::SegmentDefinition& definition, const Files& files,
                   analysis::SegmentInput& input, SegmentsOutcome& outcome) {
  for (const auto& text : job.subject) {
    auto value = parse_subject_value(text, definition);
    if (!value) return std::unexpected(value.error());
    input.given.push_back(std::move(*value));
  }
  const auto take = [&](std::vector<analysis::SubjectValue> values) {
    mend_units(values, definition, outcome.warnings);
    std::ranges::move(values, std::back_inserter(input.known));
  };
  if (!job.vsk.empty()) {
    auto values = read_subject_file(job.vsk, definition);
    if (!values) return std::unexpected(values.error());
    outcome.inputs.push_back({.role = "subject", .path = job.vsk.string()});
    take(std::move(*values));
  }
  take(subject_values(files.recording, definition));
  input.zeros_doubtful = measures_offsets(files.recording);
  if (files.static_trial) {
    take(subject_values(*files.static_trial, definition));
    input.zeros_doubtful = input.zeros_doubtful || measures_offsets(*files.static_trial);
  }
  return {};
}

// What a reader of a static trial's angles must know: they jump against those of walks.
void note_static_angles(const Files& files, SegmentsOutcome& outcome) {
  if (!files.static_is_recording) return;
  constexpr double kSeen_rad = 0.1 * std::numbers::pi / 180.0;
  std::vector<std::string> turns;
  for (const auto& p : outcome.motion.parameters)
    if (p.name.ends_with("TibialTorsion") && std::abs(p.value) > kSeen_rad)
      turns.push_back(fmt::format("{} {:.1f} deg", p.name, p.value * 180.0 / std::numbers::pi));
  if (!turns.empty())
    outcome.warnings.push_back(
        fmt::format("Knee rotation of a static trial contains the tibia's torsion, that of a walk does not: "
                    "beside a walk "
                    "it jumps by {}.",
                    fmt::join(turns, ", ")));
}

// What nobody stated of the static trial.
void note_choices(const analysis::SegmentDefinition& definition, SegmentsOutcome& outcome) {
  for (const auto& used : outcome.motion.parameters) {
    const auto p =
        std::ranges::find(definition.parameters, used.name, &analysis::SegmentDefinition::Parameter::name);
    if (!used.assumed || p == definition.parameters.end() || p->choices.empty()) continue;
    outcome.warnings.push_back(fmt::format(
        "{} is assumed to be {:g}: no file tells; --subject {}={:g} is the other.", used.name, used.value,
        used.name, p->choices.front() == used.value ? p->choices.back() : p->choices.front()));
  }
}

void find_cross_talk(const analysis::SegmentDefinition& definition, SegmentsOutcome& outcome) {
  for (const auto& series : outcome.motion.angles) {
    const auto a =
        std::ranges::find(definition.angles, series.name, &analysis::SegmentDefinition::Angle::name);
    if (a == definition.angles.end() || !a->cross_talk) continue;
    const auto found = analysis::find_cross_talk(series);
    if (!found) continue;
    outcome.cross_talk.emplace_back(series.name, *found);
    if (found->suspicious()) outcome.warnings.push_back(found->sentence(series.name));
  }
}

Status find_loads(const SegmentsJob& job, const analysis::SegmentDefinition& definition,
                  const data::Trial& recording, const analysis::SegmentInput& input,
                  const analysis::SegmentOptions& options, SegmentsOutcome& outcome) {
  const auto plates = plates_of(job.input, recording);
  if (!plates || input.static_trial == input.markers) return {};
  analysis::PlateEvidence evidence{.plates = &*plates, .corners = {}};
  for (const auto& plate : recording.force_plates) evidence.corners.push_back(plate.corners_in_world);
  auto loads = analysis::find_joint_loads(definition, input, evidence,
                                          {.segments = options, .refits = job.refits, .seed = job.seed});
  if (!loads) return fail_at(job.input.string(), loads.error());
  outcome.loads = std::move(*loads);
  std::ranges::copy(outcome.loads.warnings, std::back_inserter(outcome.warnings));
  return {};
}

Status write_all(const SegmentsJob& job, const Files& files, SegmentsOutcome& outcome) {
  std::vector<std::string> names{"angles.mot",  "angles_sd.sto", "angles.csv",
                                 "centres.csv", "segments.c3d",  "segments.json"};
  if (!outcome.loads.series.empty())
    for (const auto* name : {"loads.sto", "loads_sd.sto", "loads.csv"}) names.emplace_back(name);
  auto staging = Staging::create_in(job.output, names, job.force, {job.input, job.static_trial, job.vsk});
  if (!staging) return std::unexpected(staging.error());
  const auto& motion = outcome.motion;
  const SeriesList angles = series_of(motion), loads = series_of(outcome.loads);
  const data::Trial points = points_trial(motion, files.recording);
  const data::Trial whole = trial_with(motion, outcome.loads, files.recording);
  const auto& targets = staging->targets();
  std::vector<ResultFile> made{
      table_file(targets[0], [&] { return series_table(angles, motion.time, "angles"); }),
      table_file(targets[1], [&] { return deviations_table(angles, motion.time, "angles_sd"); }),
      text_file(targets[2], [&] { return series_csv(angles, motion.time); }),
      marker_file(targets[3], points),
      marker_file(targets[4], whole),
      json_file(targets[5], [&] { return segments_outcome_json(outcome); })};
  if (!loads.empty()) {
    made.push_back(table_file(targets[6], [&] { return series_table(loads, motion.time, "loads"); }));
    made.push_back(table_file(targets[7], [&] { return deviations_table(loads, motion.time, "loads_sd"); }));
    made.push_back(text_file(targets[8], [&] { return series_csv(loads, motion.time); }));
  }
  SetDigest digest;
  digest.add("segments").add(outcome.inputs).add(series_csv(angles, motion.time));
  if (!loads.empty()) digest.add(series_csv(loads, motion.time));
  auto written = write_results(*staging, made, job.progress, "the segments", digest.hex());
  if (!written) return std::unexpected(written.error());
  outcome.written = std::move(*written);
  return {};
}

/// The static trial by the names of its markers, and against the recording, before anything is built on it.
Status judge_static(const SegmentsJob& job, const Files& files, SegmentsOutcome& outcome) {
  if (job.static_trial.empty()) return {};
  const auto& still = files.static_trial ? files.static_trial->markers : files.recording.markers;
  std::vector<const data::Trajectories*> movements;
  if (files.static_trial) movements.push_back(&files.recording.markers);
  auto judgement = judge_static_trial(job.static_trial.filename().string(),
                                      motion::body_of_names(still.names), still, movements, outcome);
  if (!judgement) return std::unexpected(judgement.error());
  outcome.static_trial = std::move(*judgement);
  return {};
}

GaitDrawingJob drawing_of(const SegmentsJob& job) {
  GaitDrawingJob out;
  static_cast<JobSettings&>(out) = job;
  static_cast<GaitOutputs&>(out) = job;
  out.refits = job.refits;
  out.level = job.level;
  out.noise_sd_m = job.noise_sd_m;
  return out;
}

// Angles and values over the cycle, and what else of them is drawn.
Status draw_walking(const SegmentsJob& job, const data::Trial& recording, GaitDrawing& drawing,
                    SegmentsOutcome& outcome) {
  if (auto s = drawing.find_walking(job.input, recording); !s) {
    if (s.error().code == Code::usage || job.output.empty()) return s;
    outcome.warnings.push_back("walking is not drawn: " + s.error().message);
    return {};
  }
  outcome.gait = drawing.gait();
  std::ranges::copy(outcome.gait->notes, std::back_inserter(outcome.warnings));
  std::vector<SheetInput> inputs;
  SeriesList list = series_of(outcome.motion);
  for (const auto& series : outcome.loads.series)
    if (series.name.ends_with("Moment") || series.name.ends_with("Power")) list.push_back(&series);
  for (const auto& series : cycle_series(list, outcome.motion.time))
    add_series(series, outcome.gait->cycles, "", inputs);
  std::vector<data::CycleCurves> curves;
  for (const auto& input : inputs) curves.push_back(input.curves);
  // Moments that the recording holds give way to those that were computed.
  data::Trial plates = recording;
  if (!outcome.loads.series.empty()) plates.channels = {};
  add_recorded_kinetics(job.input, plates, *outcome.gait, inputs);
  return drawing.write(job.input, recording, curves, inputs,
                       {.angles_from = outcome.title, .inputs = outcome.inputs}, outcome);
}

}  // namespace

Result<SegmentsOutcome> run_segments(const SegmentsJob& job) {
  if (auto s = job.selection.check(); !s) return std::unexpected(s.error());
  const auto definition = find_definition(job.definition);
  if (!definition) return std::unexpected(definition.error());
  std::optional<GaitDrawing> drawing;
  if (auto walking = drawing_of(job); walking.wanted()) {
    auto begun = GaitDrawing::begin(std::move(walking), {job.input, job.static_trial, job.vsk});
    if (!begun) return std::unexpected(begun.error());
    drawing.emplace(std::move(*begun));
  } else if (auto s = job.gait.check(); !s) {
    return std::unexpected(s.error());
  }
  SegmentsOutcome outcome;
  outcome.title = definition->title.empty() ? job.definition : definition->title;
  auto files = read_files(job, outcome);
  if (!files) return std::unexpected(files.error());
  if (auto s = judge_static(job, *files, outcome); !s) return std::unexpected(s.error());
  const auto up = up_of(job, files->recording);
  if (!up) return std::unexpected(up.error());
  analysis::SegmentInput input;
  join_points(job, *definition, *files, input, outcome.warnings);
  if (auto s = find_values(job, *definition, *files, input, outcome); !s) return std::unexpected(s.error());
  const analysis::SegmentOptions options{.noise_sd_m = job.noise_sd_m, .up = *up, .threads = job.threads};
  auto motion = analysis::compute_segments(*definition, input, options);
  if (!motion) return fail_at(job.input.string(), motion.error());
  outcome.motion = std::move(*motion);
  if (outcome.motion.noise) {
    input.noise = &*outcome.motion.noise;
    std::ranges::move(input.noise->sentences(), std::back_inserter(outcome.warnings));
  }
  auto comparison = compare_outputs(*definition, input, options, outcome.motion, files->recording);
  if (!comparison) return fail_at(job.input.string(), comparison.error());
  outcome.comparison = std::move(*comparison);
  if (auto s = find_loads(job, *definition, files->recording, input, options, outcome); !s)
    return std::unexpected(s.error());
  std::ranges::copy(outcome.motion.warnings, std::back_inserter(outcome.warnings));
  std::ranges::move(outcome.comparison.findings(), std::back_inserter(outcome.warnings));
  note_static_angles(*files, outcome);
  if (input.static_trial != nullptr) note_choices(*definition, outcome);
  find_cross_talk(*definition, outcome);
  if (!job.output.empty())
    if (auto s = write_all(job, *files, outcome); !s) return std::unexpected(s.error());
  if (drawing)
    if (auto s = draw_walking(job, files->recording, *drawing, outcome); !s)
      return fail_at(job.input.string(), s.error());
  return outcome;
}

}  // namespace kinemark::pipeline
