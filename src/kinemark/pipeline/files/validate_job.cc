// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/validate_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/input_list.h"

namespace kinemark::pipeline {

int CheckedFile::exit_status() const {
  if (error) return kinemark::exit_status(error->code);
  return warnings.empty() ? 0 : 1;
}

int ValidateOutcome::exit_status() const {
  int worst = 0;
  for (const auto& checked : files) worst = std::max(worst, checked.exit_status());
  return worst;
}

namespace {

bool is_table(const std::filesystem::path& file) {
  const auto ending = ending_of(file);
  return ending == ".mot" || ending == ".sto";
}

/// The model that tables are held beside, where one is named.
Status read_model(const ValidateJob& job, std::optional<model::Model>& model) {
  if (job.model.empty()) return {};
  if (std::ranges::none_of(job.files, is_table))
    return fail(Code::usage,
                fmt::format("--model: {} is for tables of coordinates (.mot, .sto), and there are none",
                            job.model.string()));
  auto description = io::read_osim(job.model);
  if (!description) return std::unexpected(description.error());
  auto compiled = model::Model::compile(std::move(*description));
  if (!compiled) return fail_at(job.model.string(), compiled.error());
  model = std::move(*compiled);
  return {};
}

}  // namespace

Result<ValidateOutcome> run_validate(const ValidateJob& job) {
  ValidateOutcome out;
  std::optional<model::Model> model;
  if (auto s = read_model(job, model); !s) return std::unexpected(s.error());
  const auto recordings = marker_endings();
  const auto total = static_cast<std::int64_t>(job.files.size());
  for (const auto& file : job.files) {
    InfoJob info;
    info.file = file;
    info.model = model ? &*model : nullptr;
    info.find_exchanges = true;
    if (std::ranges::find(recordings, ending_of(file)) != recordings.end())
      static_cast<RecordingOptions&>(info) = job.recording;
    if (!io::needs_rate(file)) info.rate_hz = 0.0;
    auto facts = run_info(info);
    CheckedFile& checked = out.files.emplace_back();
    checked.file = file;
    if (facts) {
      checked.warnings = std::move(facts->warnings);
      std::ranges::move(facts->contradicted, std::back_inserter(checked.warnings));
      checked.facts = std::move(facts->facts);
      if (const auto* markers = std::get_if<MarkerFileFacts>(&*checked.facts))
        for (const auto& note : {markers->filtered, markers->calibration_error})
          if (!note.empty()) checked.notes.push_back(note);
      if (const auto* bodies = std::get_if<ModelFacts>(&*checked.facts)) checked.notes = bodies->notes;
      std::ranges::move(find_strangers(file), std::back_inserter(checked.warnings));
      std::ranges::move(find_changed(file), std::back_inserter(checked.warnings));
    } else {
      checked.error = std::move(facts.error());
    }
    if (job.progress && !job.progress(static_cast<std::int64_t>(out.files.size()), total))
      return fail(Code::cancelled, "the validation was stopped");
  }
  return out;
}

}  // namespace kinemark::pipeline
