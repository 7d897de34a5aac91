// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/convert_job.h"

#include <fmt/core.h>

#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "kinemark/io/animation/bvh.h"
#include "kinemark/io/animation/glb.h"
#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/markers/orientation_file.h"
#include "kinemark/io/matlab/mat.h"
#include "kinemark/io/osim/external_loads.h"
#include "kinemark/io/osim/osim_document.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/robot/robot_file.h"
#include "kinemark/io/text/orientation_table.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/coordinate_rows.h"
#include "kinemark/pipeline/files/merge_trials.h"
#include "kinemark/pipeline/files/motion_bids_files.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/resample.h"
#include "kinemark/stages/analysis/consistency/table_facts.h"
#include "kinemark/workflow/prepare/contradictions.h"
#include "kinemark/workflow/prepare/marker_screening.h"
#include "kinemark/workflow/prepare/turn.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {
namespace {

enum class Kind { markers, table, model };

Kind kind_of(const std::string& ending) {
  if (ending == ".osim") return Kind::model;
  if (ending == ".mot" || ending == ".sto") return Kind::table;
  return Kind::markers;
}

/// What the input is taken for: a table of OpenSim may hold markers and nothing else, and stays a table all
/// the same where it becomes one.
Kind kind_of_input(const ConvertJob& job) {
  const Kind kind = kind_of(ending_of(job.in));
  const bool may_be_markers = kind == Kind::table && kind_of(ending_of(job.out)) != Kind::table;
  return may_be_markers && io::begins_as_markers(job.in) ? Kind::markers : kind;
}

/// Formats of models for robots and physics programs, which are written and not read.
bool is_robot(const std::string& ending) {
  return ending == ".urdf" || ending == ".xml" || ending == ".mjcf";
}

/// @param gates  get `contradictions`
Result<std::vector<std::string>> convert_model(const ConvertJob& job, std::vector<data::Gate>& gates) {
  const auto document = io::OsimDocument::read(job.in);
  if (!document) return std::unexpected(document.error());
  const auto contradicted = workflow::contradicted_model(document->model());
  workflow::add_contradictions(contradicted, gates);
  if (is_robot(ending_of(job.out))) {
    auto lost = io::write_robot(job.out, document->model(), job.force);
    if (!lost) return std::unexpected(lost.error());
    auto notes = document->model().warnings;
    notes.insert(notes.end(), contradicted.begin(), contradicted.end());
    notes.insert(notes.end(), lost->begin(), lost->end());
    return notes;
  }
  auto text = document->format({.model = document->model(), .factors = {}, .paths = {}});
  if (!text) return fail_at(job.out.string(), text.error());
  if (auto s = io::write_osim_text(job.out, text->text, {.force = job.force}); !s)
    return std::unexpected(s.error());
  std::vector<std::string> notes = document->model().warnings;
  notes.insert(notes.end(), contradicted.begin(), contradicted.end());
  notes.insert(notes.end(), text->lost.begin(), text->lost.end());
  return notes;
}

/// @param gates  get `contradictions`
Result<std::vector<std::string>> convert_table(const ConvertJob& job, std::vector<data::Gate>& gates) {
  auto table = io::read_table(job.in);
  if (!table) return std::unexpected(table.error());
  const auto contradicted = analysis::contradicted_values(*table, job.in.filename().string());
  workflow::add_contradictions(contradicted, gates);
  std::ranges::copy(contradicted, std::back_inserter(table->warnings));
  if (ending_of(job.out) == ".mat") {
    const bool degrees = io::angles_are_degrees(*table);
    if (auto s = io::write_mat(job.out, *table, degrees, {.force = job.force}); !s)
      return std::unexpected(s.error());
    return std::move(table->warnings);
  }
  if (auto s = io::write_table(job.out, *table, {.force = job.force}); !s) return std::unexpected(s.error());
  return std::move(table->warnings);
}

/// The motion of a model's bodies.
/// @param gates  get `contradictions`
Result<std::vector<std::string>> convert_motion(const ConvertJob& job, std::vector<data::Gate>& gates) {
  auto motion = read_model_motion(job.model, job.in);
  if (!motion) return std::unexpected(motion.error());
  workflow::add_contradictions(motion->contradicted, gates);
  std::ranges::copy(motion->contradicted, std::back_inserter(motion->notes));
  const bool is_bvh = ending_of(job.out) == ".bvh";
  const auto write =
      is_bvh
          ? io::write_bvh
          : static_cast<Status (*)(const std::filesystem::path&, const io::PoseTree&, bool)>(io::write_glb);
  if (auto s = write(job.out, motion->poses, job.force); !s) return std::unexpected(s.error());
  if (is_bvh)
    motion->notes.emplace_back(
        motion->y_is_up ? "lengths are in cm and y is up, which a .bvh file cannot say"
                        : "lengths are in cm, which a .bvh file cannot say; what is up is not known, "
                          "as the model has no gravity");
  return std::move(motion->notes);
}

/// A scene has y up: a recording whose vertical is known is turned, which is said.
/// @param vertical  as it is stated; none: nobody states it
void turn_y_up(std::optional<workflow::Vertical> vertical, data::Trial& trial) {
  if (!vertical) vertical = workflow::vertical_of_plates(trial);
  if (!vertical) vertical = workflow::vertical_of_screen(trial);
  if (!vertical) {
    trial.warnings.emplace_back(
        "which way is up is not known and y is taken, as a .glb has it; --rotate turns a recording, \"x "
        "-90\" from z up");
    return;
  }
  if (vertical->up == Eigen::Vector3d::UnitY()) return;
  workflow::turn(trial, workflow::rotation_between(vertical->up, Eigen::Vector3d::UnitY()));
  trial.warnings.push_back(fmt::format("the recording was turned: {} is up by {}, and y in a .glb",
                                       workflow::name_of_direction(vertical->up), vertical->from));
}

/// Every file that the job reads.
std::vector<std::filesystem::path> files_of(const ConvertJob& job) {
  auto inputs = pipeline::files_of(job.in, job);
  inputs.insert(inputs.end(), {job.model, job.skeleton});
  for (const auto& part : job.merged)
    std::ranges::move(pipeline::files_of(part, job), std::back_inserter(inputs));
  return inputs;
}

/// The files of one recording together, each by its own journal.
Result<Recording> read_merged(const ConvertJob& job, const std::vector<std::filesystem::path>& files) {
  RecordingOptions options;
  options.rate_hz = job.rate_hz;
  options.unit = job.unit;
  options.edits = job.edits;
  Recording out;
  std::vector<data::Trial> trials;
  for (const auto& file : files) {
    auto one = open_recording({.path = file,
                               .skeleton = job.skeleton,
                               .facts = workflow::HeldFacts::none(),
                               .force = job.force,
                               .seed = job.seed,
                               .threads = job.threads},
                              options);
    if (!one) return one;
    trials.push_back(std::move(one->trial));
    std::ranges::move(one->notes, std::back_inserter(out.notes));
  }
  auto trial = merge_trials(std::move(trials));
  if (!trial) return std::unexpected(trial.error());
  out.trial = std::move(*trial);
  return out;
}

/// The recording as it is to be written.
Result<Recording> read_prepared(const ConvertJob& job, const std::vector<std::filesystem::path>& files) {
  auto recording = read_merged(job, files);
  if (!recording) return recording;
  RecordingOptions rest = job;
  rest.edits = io::kEditsNone;
  auto notes = std::exchange(recording->notes, {});
  if (auto s = prepare_recording({.path = job.in}, rest, *recording); !s) return std::unexpected(s.error());
  auto& trial = recording->trial;
  if (job.drops_doubtful(false))
    if (auto s = workflow::leave_out_defects(trial, false, recording->edits.swapped, notes); !s)
      return fail_at(job.in.string(), s.error());
  if (job.resample_hz)
    if (auto s = resample(trial, *job.resample_hz); !s) return fail_at(job.in.string(), s.error());
  if (job.axes.rotate.empty() && ending_of(job.out) == ".glb")
    turn_y_up(workflow::stated_vertical(job.axes), trial);
  std::ranges::move(notes, std::back_inserter(recording->notes));
  return recording;
}

/// @param out  gets the gate `contradictions`, and the files of a format that has several
Result<std::vector<std::string>> convert_markers(const ConvertJob& job, ConvertOutcome& out) {
  std::vector<std::filesystem::path> files{job.in};
  files.insert(files.end(), job.merged.begin(), job.merged.end());
  const auto recording = read_prepared(job, files);
  if (!recording) return std::unexpected(recording.error());
  const auto& trial = recording->trial;
  auto notes = trial.warnings;
  notes.insert(notes.end(), recording->notes.begin(), recording->notes.end());
  workflow::add_contradictions(recording->contradicted, out.gates);
  if (ending_of(job.out) == ".tsv") {
    auto made = write_motion_bids(job.out, trial, job, files_of(job));
    if (!made) return std::unexpected(made.error());
    out.written = std::move(*made);
    const auto lost = io::lost_in(*io::written_format(".tsv"), trial);
    notes.insert(notes.end(), lost.begin(), lost.end());
    return notes;
  }
  if (auto s =
          io::write_markers(job.out, trial, {.force = job.force, .ndx_pose = job.ndx_pose, .lost = &notes});
      !s)
    return std::unexpected(s.error());
  return notes;
}

/// Whether orientations are to be written: of a table that holds nothing else, without being asked.
bool is_of_orientations(const ConvertJob& job) {
  const auto to = ending_of(job.out);
  return job.orientations || (kind_of(ending_of(job.in)) == Kind::table && (to == ".sto" || to == ".csv") &&
                              io::has_orientations(job.in));
}

/// Orientations go into formats that have them; what is for markers and models is refused.
Status check_orientations(const ConvertJob& job) {
  const auto to = ending_of(job.out);
  if (to != ".sto" && to != ".csv")
    return fail(Code::usage, fmt::format("{}: orientations are written as .sto (OpenSense, for 'kinemark ik "
                                         "--orientations') or .csv",
                                         job.out.string()));
  if (!job.RecordingOptions::empty() || !job.merged.empty() || job.resample_hz || !job.model.empty() ||
      !job.skeleton.empty() || job.ndx_pose)
    return fail(
        Code::usage,
        fmt::format("{}: orientations are written as they are; --rate, --select, --merge, --model and "
                    "the other options of markers and models are not for them",
                    job.out.string()));
  return {};
}

Result<ConvertOutcome> convert_orientations(const ConvertJob& job) {
  if (auto s = check_orientations(job); !s) return std::unexpected(s.error());
  if (auto s = check_apart(job, {job.out}, {job.in}); !s) return std::unexpected(s.error());
  auto sensors = io::read_orientation_file(job.in);
  if (!sensors) return std::unexpected(sensors.error());
  if (auto s = io::write_orientations(job.out, *sensors, job.force); !s)
    return fail_at(job.out.string(), s.error());
  ConvertOutcome out;
  out.warnings = std::move(sensors->warnings);
  out.written = {job.out};
  return out;
}

constexpr double kContact_n = 20.0;  ///< of OpenSim's users; a plate that bears less is empty

/// Forces of the plates of a recording, as OpenSim reads them.
Result<std::vector<std::string>> convert_forces(const ConvertJob& job, std::vector<data::Gate>& gates) {
  if (!job.merged.empty() || job.resample_hz)
    return fail(Code::usage, fmt::format("{}: forces are those of one recording, at the rate of its markers",
                                         job.out.string()));
  const auto& chosen = job.selection;
  if (!chosen.select.empty() || !chosen.drop.empty() || !chosen.rename.empty() || job.doubtful)
    return fail(Code::usage, fmt::format("{}: no marker goes into a table of forces; --select, --drop, "
                                         "--rename and --doubtful are not for it",
                                         job.out.string()));
  auto recording = open_recording({.path = job.in,
                                   .skeleton = job.skeleton,
                                   .plates = true,
                                   .contact_force_n = kContact_n,
                                   .facts = {.size = false, .sides = false, .pairs = false},
                                   .force = job.force,
                                   .seed = job.seed,
                                   .threads = job.threads},
                                  job);
  if (!recording) return std::unexpected(recording.error());
  if (!recording->plates_fault.empty()) return fail(Code::bad_input, recording->plates_fault);
  if (!recording->plates)
    return fail(Code::bad_input,
                fmt::format("{}: has no force plates, whose forces a {} could hold; {}", job.in.string(),
                            ending_of(job.out),
                            io::has_orientations(job.in) ? "the orientations that it has are written with "
                                                           "--orientations"
                                                         : "joint angles are made by kinemark ik"));
  if (auto s = io::write_table(job.out, io::table_of_forces(*recording->plates), {.force = job.force}); !s)
    return std::unexpected(s.error());
  workflow::add_contradictions(recording->contradicted, gates);
  auto notes = std::move(recording->trial.warnings);
  std::ranges::move(recording->notes, std::back_inserter(notes));
  return notes;
}

}  // namespace

namespace {

/// Whether these files go together, with a model or without.
Status check_kinds(const ConvertJob& job) {
  const std::string from = ending_of(job.in), to = ending_of(job.out);
  const bool makes_skeleton = kind_of_input(job) == Kind::table && (to == ".bvh" || to == ".glb");
  if (!job.model.empty() && !makes_skeleton)
    return fail(
        Code::usage,
        fmt::format("--model: {} as {} needs none; it is for a table of coordinates (.mot, .sto) that "
                    "becomes a .bvh or .glb",
                    job.in.string(), job.out.string()));
  if (job.model.empty() && (to == ".bvh" || makes_skeleton))
    return fail(Code::usage,
                fmt::format("{}: a motion of joint angles is made with the model that they are of: "
                            "kinemark convert Q.mot {} --model M.osim",
                            job.out.string(), job.out.filename().string()));
  if (!job.skeleton.empty() && from != ".amc")
    return fail(Code::usage,
                fmt::format("--skeleton: {} has none beside it; it is for .amc files", job.in.string()));
  if (kind_of_input(job) == Kind::model && is_robot(to)) return {};
  if (kind_of_input(job) == Kind::table && to == ".mat") return {};
  if (kind_of_input(job) == Kind::markers && kind_of(to) == Kind::table) return {};
  if (makes_skeleton || (kind_of_input(job) == kind_of(to) && !is_robot(to))) return {};
  return fail(Code::usage,
              fmt::format("{} cannot become {}: markers, tables and models are different kinds of file",
                          job.in.string(), job.out.string()));
}

/// A file that is merged with itself is a slip: another one was meant.
Status check_each_once(const ConvertJob& job) {
  std::vector<std::filesystem::path> files{job.in};
  files.insert(files.end(), job.merged.begin(), job.merged.end());
  std::error_code unknown;
  for (std::size_t i = 1; i < files.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (std::filesystem::equivalent(files[i], files[k], unknown))
        return fail(Code::usage,
                    fmt::format("{}: is given twice; files to merge must differ", files[i].string()));
  return {};
}

}  // namespace

Result<ConvertOutcome> run_convert(const ConvertJob& job) {
  if (is_of_orientations(job)) return convert_orientations(job);
  if (auto s = check_kinds(job); !s) return std::unexpected(s.error());
  if (auto s = job.RecordingOptions::check(); !s) return std::unexpected(s.error());
  if (!job.RecordingOptions::empty() && kind_of_input(job) != Kind::markers)
    return fail(Code::usage,
                fmt::format("{}: is no recording; --rate, --edits, --select and the other options "
                            "of a recording are not for it",
                            job.in.string()));
  if ((!job.merged.empty() || job.resample_hz) && kind_of_input(job) != Kind::markers)
    return fail(Code::usage,
                fmt::format("{}: only marker files can be merged and resampled", job.in.string()));
  if (!job.merged.empty())
    if (auto s = check_for_several(job); !s) return std::unexpected(s.error());
  if (job.ndx_pose && ending_of(job.out) != ".nwb")
    return fail(Code::usage, fmt::format("--ndx-pose: {} is no .nwb file", job.out.string()));
  if (auto s = check_each_once(job); !s) return std::unexpected(s.error());
  if (auto s = check_apart(job, {job.out}, files_of(job)); !s) return std::unexpected(s.error());
  Result<std::vector<std::string>> warnings;
  ConvertOutcome out;
  out.written = {job.out};
  switch (kind_of_input(job)) {
    case Kind::model:
      warnings = convert_model(job, out.gates);
      break;
    case Kind::table:
      warnings = job.model.empty() ? convert_table(job, out.gates) : convert_motion(job, out.gates);
      break;
    case Kind::markers:
      warnings = kind_of(ending_of(job.out)) == Kind::table ? convert_forces(job, out.gates)
                                                            : convert_markers(job, out);
      break;
  }
  if (!warnings) return std::unexpected(warnings.error());
  out.warnings = std::move(*warnings);
  return out;
}

}  // namespace kinemark::pipeline
