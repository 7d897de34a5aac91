// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/study_taichi_job.h"

#include <utility>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/simulate/human_model.h"

namespace kinemark::studies {

Result<TaiChiStudy> run_study_taichi(const TaiChiFiles& files, const Progress& progress) {
  constexpr double kRecorded_hz = 179.0;
  TaiChiJob job{.seeds = files.seeds, .threads = files.threads};
  auto human = pipeline::human_model();
  if (!human) return std::unexpected(human.error());
  job.human = std::move(*human);
  if (!files.data.empty()) {
    const bool no_rate = io::needs_rate(files.data) && files.rate_hz == 0.0;
    auto trial = io::read_markers(files.data, {.rate_hz = no_rate ? kRecorded_hz : files.rate_hz});
    if (!trial) return std::unexpected(trial.error());
    job.recording = std::move(trial->markers);
  }
  auto study = study_taichi(job, progress);
  if (!study && !files.data.empty()) return fail_at(files.data.string(), study.error());
  return study;
}

}  // namespace kinemark::studies
