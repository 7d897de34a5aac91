// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recording.h"

#include <fmt/core.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/workflow/prepare/prepare.h"

namespace kinemark::pipeline {
namespace {

/// No journal is named: that beside the recording, or none.
bool names_no_journal(const std::filesystem::path& edits) {
  return edits.empty() || edits == io::kEditsBeside || edits == io::kEditsNone;
}

Status apply_journal(const io::Journal& journal, std::uint64_t seed, int threads,
                     data::Recording& recording) {
  auto& notes = recording.notes;
  const auto own = std::ssize(notes);
  if (journal.file) {
    const auto& name = journal.file->path;
    if (auto s = workflow::apply_edits(recording, journal.in_force, seed, threads); !s)
      return std::unexpected(journal.failure(s.error()));
    for (auto note = notes.begin() + own; note != notes.end(); ++note)
      *note = fmt::format("{}: {}", name, *note);
    notes.push_back(fmt::format("{} of {} {} applied", counted(std::ssize(journal.in_force), "edit"), name,
                                journal.in_force.size() == 1 ? "was" : "were"));
  }
  notes.insert(notes.begin() + own, journal.notes.begin(), journal.notes.end());
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
  return io::read_recording(
      {.path = source.path,
       .rate_hz = options.rate_hz,
       .rate = source.rate,
       .unit = options.unit,
       .skeleton = source.skeleton,
       .needs_samples = source.needs_samples,
       .record = source.record},
      {.wanted = source.plates, .file = source.forces, .contact_force_n = source.contact_force_n},
      options.edits, source.force);
}

Status prepare_recording(const RecordingSource& source, const RecordingOptions& options,
                         Recording& recording) {
  if (auto s = apply_journal(recording.journal, source.seed, source.threads, recording); !s) return s;
  const workflow::PrepareOptions asked{
      .one_time = source.one_time,
      .selection = options.selection,
      .axes = source.turns ? options.axes : workflow::AxesChoice{},
      .facts = source.facts,
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

Result<io::Journal> take_edits(const io::EditsSource& source, data::Recording& recording, std::uint64_t seed,
                               int threads) {
  auto journal = io::read_journal(source);
  if (!journal) return journal;
  if (auto s = apply_journal(*journal, seed, threads, recording); !s) return std::unexpected(s.error());
  return journal;
}

std::vector<std::pair<std::string, std::string>> edit_options(const data::EditsInForce& edits,
                                                              const io::Journal& journal) {
  std::vector<std::pair<std::string, std::string>> options;
  if (!journal.file) return options;
  options.emplace_back("edits in force", fmt::format("{}, XXH3-64 {}", edits.in_force, journal.digest));
  for (const auto& region : edits.regions)
    options.emplace_back(fmt::format("region '{}'", region.name),
                         fmt::format("frames {} to {}", region.first_frame, region.last_frame));
  return options;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording,
                                            const RecordingOptions& options) {
  return io::files_of(recording, options.edits);
}

Status check_for_several(const RecordingOptions& options) {
  if (names_no_journal(options.edits)) return {};
  return fail(Code::usage,
              fmt::format("--edits: {} is of one recording; need 'beside' or 'none' with several",
                          options.edits.string()));
}

}  // namespace kinemark::pipeline
