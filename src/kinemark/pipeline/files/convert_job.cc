// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/convert_job.h"

#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_document.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/motion_bids_files.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/files/turn.h"

namespace kinemark::pipeline {
namespace {

enum class Kind { markers, table, model };

Kind kind_of(const std::string& ending) {
  if (ending == ".osim") return Kind::model;
  if (ending == ".mot" || ending == ".sto") return Kind::table;
  return Kind::markers;
}

Result<std::vector<std::string>> convert_model(const ConvertJob& job) {
  const auto document = io::OsimDocument::read(job.in);
  if (!document) return std::unexpected(document.error());
  auto text = document->format({.model = document->model(), .factors = {}, .paths = {}});
  if (!text) return fail_at(job.out.string(), text.error());
  if (auto s = io::write_osim_text(job.out, text->text, {.force = job.force}); !s)
    return std::unexpected(s.error());
  std::vector<std::string> notes = document->model().warnings;
  notes.insert(notes.end(), text->lost.begin(), text->lost.end());
  return notes;
}

Result<std::vector<std::string>> convert_table(const ConvertJob& job) {
  auto table = io::read_table(job.in);
  if (!table) return std::unexpected(table.error());
  if (auto s = io::write_table(job.out, *table, {.force = job.force}); !s) return std::unexpected(s.error());
  return std::move(table->warnings);
}

/// @param written  gets the files of a format that has several
Result<std::vector<std::string>> convert_markers(const ConvertJob& job,
                                                 std::vector<std::filesystem::path>& written) {
  auto input = read_marker_input({.path = job.in, .rate_hz = job.rate_hz});
  if (!input) return std::unexpected(input.error());
  if (auto s = take_selection(job.selection, input->trial); !s) return fail_at(job.in.string(), s.error());
  if (!job.rotate.empty()) {
    const auto turning = parse_rotation(job.rotate);
    if (!turning) return std::unexpected(turning.error());
    turn(input->trial, *turning);
  }
  auto notes = input->trial.warnings;
  if (ending_of(job.out) == ".tsv") {
    auto files = write_motion_bids(job.out, input->trial, job.force, {job.in});
    if (!files) return std::unexpected(files.error());
    written = std::move(*files);
    const auto lost = io::lost_in(*io::written_format(".tsv"), input->trial);
    notes.insert(notes.end(), lost.begin(), lost.end());
    return notes;
  }
  if (auto s = io::write_markers(job.out, input->trial, job.force, {}, &notes); !s)
    return std::unexpected(s.error());
  return notes;
}

}  // namespace

Result<ConvertOutcome> run_convert(const ConvertJob& job) {
  const std::string from = ending_of(job.in);
  if (kind_of(from) != kind_of(ending_of(job.out)))
    return fail(Code::usage,
                fmt::format("{} cannot become {}: markers, tables and models are different kinds of file",
                            job.in.string(), job.out.string()));
  if (!job.rotate.empty() && kind_of(from) != Kind::markers)
    return fail(Code::usage, fmt::format("{}: only marker files can be turned", job.in.string()));
  if (auto s = job.selection.check(); !s) return std::unexpected(s.error());
  if (!job.selection.empty() && kind_of(from) != Kind::markers)
    return fail(Code::usage, fmt::format("{}: only of marker files a part can be taken", job.in.string()));
  if (auto s = check_apart({job.out}, {job.in}); !s) return std::unexpected(s.error());
  Result<std::vector<std::string>> warnings;
  std::vector<std::filesystem::path> written = {job.out};
  switch (kind_of(from)) {
    case Kind::model:
      warnings = convert_model(job);
      break;
    case Kind::table:
      warnings = convert_table(job);
      break;
    case Kind::markers:
      warnings = convert_markers(job, written);
      break;
  }
  if (!warnings) return std::unexpected(warnings.error());
  ConvertOutcome out;
  out.warnings = std::move(*warnings);
  out.written = std::move(written);
  return out;
}

}  // namespace kinemark::pipeline
