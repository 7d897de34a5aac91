// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/recording_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <utility>

#include "kinemark/io/animation/amc.h"
#include "kinemark/io/bids/motion_name.h"
#include "kinemark/io/input/external_forces.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/plates/plate_forces.h"
#include "kinemark/io/text/d_flow_forces.h"

namespace kinemark::io {
namespace {

/// Forces of all that was recorded, whatever of it will be selected.
void take_plates(const ForcesSource& forces, RecordingInput& input) {
  if (input.trial.force_plates.empty()) return;
  auto found = plate_forces(input.trial, {.contact_force_n = forces.contact_force_n});
  if (!found) {
    input.plates_fault = found.error().message;
    return;
  }
  input.plates = std::move(found->wrenches);
  std::ranges::move(found->warnings, std::back_inserter(input.notes));
  input.contradicted = std::move(found->contradicted);
}

/// Forces that the text of the markers holds beside them.
void take_own_forces(const ForcesSource& forces, RecordingInput& input) {
  if (input.trial.format != "D-Flow" ||
      std::ranges::find(input.trial.unread, kForcesOfDFlow) == input.trial.unread.end())
    return;
  auto found = read_own_forces(input.file.path, input.trial.markers.time, forces.contact_force_n);
  if (!found) {
    input.plates_fault = found.error().message;
    return;
  }
  input.plates = std::move(found->wrenches);
  std::ranges::move(found->warnings, std::back_inserter(input.notes));
}

/// Forces of a file of their own, on the recording's frames.
Status take_forces(const ForcesSource& forces, RecordingInput& input) {
  auto found = read_external_forces(forces.file, input.trial.markers.time, forces.contact_force_n);
  if (!found) return std::unexpected(found.error());
  for (const auto& path : found->files) {
    auto file = record_input("forces", path);
    if (!file) return std::unexpected(file.error());
    input.forces.push_back(std::move(*file));
  }
  for (const auto& warning : found->warnings)
    input.notes.push_back(fmt::format("{}: {}", forces.file.string(), warning));
  for (const auto& one : found->contradicted)
    input.contradicted.push_back(fmt::format("{}: {}", forces.file.string(), one));
  input.notes.push_back(fmt::format("forces are those of {}", forces.file.string()));
  input.plates = std::move(found->wrenches);
  return {};
}

bool is_amc(const std::filesystem::path& path) {
  return std::ranges::equal(path.extension().string(), std::string_view(".amc"), {},
                            [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

}  // namespace

Result<MarkerInput> read_marker_input(const MarkerSource& source) {
  const bool tells_none = needs_rate(source.path);
  const bool unknown = source.rate == RateRule::or_unknown && tells_none && source.rate_hz == 0.0;
  const double rate_hz = unknown                                                ? 1.0
                         : source.rate == RateRule::where_needed && !tells_none ? 0.0
                                                                                : source.rate_hz;
  // Of a file that nothing reads, the reader's own sentence says more than one on units.
  const bool states_unit = !source.unit.empty() && !may_lack_unit(source.path);
  auto trial = read_markers(
      source.path,
      {.rate_hz = rate_hz, .unit = states_unit ? std::string() : source.unit, .skeleton = source.skeleton});
  if (!trial) return std::unexpected(trial.error());
  if (states_unit && source.rate != RateRule::where_needed)
    return fail(Code::usage,
                fmt::format("{}: the file states the unit of its coordinates; one (--unit) is given only for "
                            "tables of coordinates that state none",
                            source.path.string()));
  MarkerInput input{.trial = std::move(*trial), .file = {}, .rate_known = !unknown};
  const auto& markers = input.trial.markers;
  if (source.needs_samples && (markers.markers() == 0 || markers.frames() == 0))
    return fail(Code::bad_input, fmt::format("{}: holds {} markers and {} frames; need at least one of each",
                                             source.path.string(), markers.markers(), markers.frames()));
  input.file = {.role = "markers", .path = source.path.string(), .bytes = 0, .hash = {}, .hash_kind = {}};
  if (!source.record) return input;
  auto file = record_input("markers", source.path);
  if (!file) return std::unexpected(file.error());
  input.file = std::move(*file);
  return input;
}

Result<RecordingInput> read_recording(const MarkerSource& markers, const ForcesSource& forces,
                                      const std::filesystem::path& edits, bool force_edits) {
  auto read = read_marker_input(markers);
  if (!read) return std::unexpected(read.error());
  RecordingInput input;
  input.trial = std::move(read->trial);
  input.file = std::move(read->file);
  input.rate_known = read->rate_known;
  auto journal = read_journal({.edits = edits, .recording = markers.path, .force = force_edits});
  if (!journal) return std::unexpected(journal.error());
  input.journal = std::move(*journal);
  if (forces.wanted && forces.file.empty()) take_plates(forces, input);
  if (forces.wanted && forces.file.empty()) take_own_forces(forces, input);
  if (forces.wanted && !forces.file.empty())
    if (auto s = take_forces(forces, input); !s) return std::unexpected(s.error());
  return input;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording,
                                            const std::filesystem::path& edits) {
  std::vector<std::filesystem::path> files{recording};
  if (is_amc(recording)) files.push_back(skeleton_beside(recording));
  if (is_motion_tsv(recording))
    for (const char* ending : {"channels.tsv", "motion.json"})
      if (auto found = find_sidecar(recording, ending)) files.push_back(std::move(*found));
  if (edits == kEditsBeside)
    files.push_back(edits_of(recording));
  else if (!edits.empty() && edits != kEditsNone)
    files.push_back(edits);
  return files;
}

}  // namespace kinemark::io
