// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/length_unit.h"
#include "kinemark/io/animation/amc.h"
#include "kinemark/io/bids/motion_name.h"
#include "kinemark/io/plates/plate_forces.h"
#include "kinemark/pipeline/files/external_forces.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/workflow/prepare/prepare.h"

namespace kinemark::pipeline {
namespace {

/// No journal is named: that beside the recording, or none.
bool names_no_journal(const std::filesystem::path& edits) {
  return edits.empty() || edits == kEditsBeside || edits == kEditsNone;
}

Status apply_journal(const RecordingSource& source, const RecordingOptions& options, Recording& recording) {
  auto journal = take_edits({.edits = options.edits,
                             .recording = source.path,
                             .force = source.force,
                             .seed = source.seed,
                             .threads = source.threads},
                            recording);
  if (!journal && options.edits == kEditsBeside)
    return fail(journal.error().code,
                fmt::format("{}; --edits none passes the journal over", journal.error().message));
  if (!journal) return std::unexpected(journal.error());
  recording.journal = std::move(*journal);
  return {};
}

/// Forces of a file of their own, on the recording's frames.
Status take_forces(const RecordingSource& source, Recording& recording) {
  auto forces = read_external_forces(source.forces, recording.trial.markers.time, source.contact_force_n);
  if (!forces) return std::unexpected(forces.error());
  for (const auto& file : forces->files) {
    auto input = record_input("forces", file);
    if (!input) return std::unexpected(input.error());
    recording.forces.push_back(std::move(*input));
  }
  for (const auto& warning : forces->warnings)
    recording.notes.push_back(fmt::format("{}: {}", source.forces.string(), warning));
  recording.notes.push_back(fmt::format("forces are those of {}", source.forces.string()));
  recording.plates = std::move(forces->wrenches);
  return {};
}

/// Forces of all that was recorded, whatever of it is selected.
Status find_plates(const RecordingSource& source, Recording& recording) {
  if (!source.plates) return {};
  if (!source.forces.empty()) return take_forces(source, recording);
  if (recording.trial.force_plates.empty()) return {};
  auto forces = io::plate_forces(recording.trial, {.contact_force_n = source.contact_force_n});
  if (!forces) {
    recording.plates_fault = forces.error().message;
    return {};
  }
  recording.plates = std::move(forces->wrenches);
  std::ranges::move(forces->warnings, std::back_inserter(recording.notes));
  return {};
}

}  // namespace

std::string_view to_string(Doubtful doubtful) { return doubtful == Doubtful::drop ? "drop" : "keep"; }

Result<Doubtful> parse_doubtful(std::string_view name) {
  for (const auto doubtful : {Doubtful::drop, Doubtful::keep})
    if (name == to_string(doubtful)) return doubtful;
  return fail(Code::usage, fmt::format("--doubtful: '{}' is not drop or keep", name));
}

bool RecordingOptions::empty() const {
  return rate_hz == 0.0 && unit.empty() && names_no_journal(edits) && selection.empty() && axes.up.empty() &&
         axes.rotate.empty() && !doubtful;
}

Status RecordingOptions::check() const {
  if (!(rate_hz >= 0.0) || !std::isfinite(rate_hz))
    return fail(Code::usage, fmt::format("--rate is {} Hz; need a number above 0", rate_hz));
  if (!unit.empty() && !metres_per_unit(unit))
    return fail(Code::usage, fmt::format("--unit: '{}' is no unit of length; need mm, cm or m", unit));
  if (auto s = selection.check(); !s) return s;
  return axes.check();
}

Result<Recording> read_recording(const RecordingSource& source, const RecordingOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  auto input = read_marker_input({.path = source.path,
                                  .rate_hz = options.rate_hz,
                                  .rate = source.rate,
                                  .unit = options.unit,
                                  .skeleton = source.skeleton,
                                  .needs_samples = source.needs_samples,
                                  .record = source.record});
  if (!input) return std::unexpected(input.error());
  Recording recording;
  recording.trial = std::move(input->trial);
  recording.file = std::move(input->file);
  recording.rate_known = input->rate_known;
  if (auto s = find_plates(source, recording); !s) return std::unexpected(s.error());
  return recording;
}

Status prepare_recording(const RecordingSource& source, const RecordingOptions& options,
                         Recording& recording) {
  if (auto s = apply_journal(source, options, recording); !s) return s;
  const workflow::PrepareOptions asked{
      .selection = options.selection,
      .axes = source.turns ? options.axes : workflow::AxesChoice{},
  };
  auto prepared = workflow::prepare(std::move(static_cast<data::Recording&>(recording)), asked);
  if (!prepared) return fail_at(source.path.string(), prepared.error());
  static_cast<data::Recording&>(recording) = std::move(*prepared);
  return {};
}

Result<Recording> open_recording(const RecordingSource& source, const RecordingOptions& options) {
  auto recording = read_recording(source, options);
  if (!recording) return recording;
  if (auto s = prepare_recording(source, options, *recording); !s) return std::unexpected(s.error());
  return recording;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording,
                                            const RecordingOptions& options) {
  std::vector<std::filesystem::path> files{recording};
  if (ending_of(recording) == ".amc") files.push_back(io::skeleton_beside(recording));
  if (io::is_motion_tsv(recording))
    for (const char* ending : {"channels.tsv", "motion.json"})
      if (auto found = io::find_sidecar(recording, ending)) files.push_back(std::move(*found));
  if (options.edits == kEditsBeside)
    files.push_back(edits_of(recording));
  else if (!names_no_journal(options.edits))
    files.push_back(options.edits);
  return files;
}

Status check_for_several(const RecordingOptions& options) {
  if (names_no_journal(options.edits)) return {};
  return fail(Code::usage,
              fmt::format("--edits: {} is of one recording; need 'beside' or 'none' with several",
                          options.edits.string()));
}

}  // namespace kinemark::pipeline
