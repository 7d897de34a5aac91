// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_job.h"

#include <utility>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/rig/rig_page.h"

namespace kinemark::pipeline {

Result<ReconstructOutcome> run_reconstruct(const ReconstructJob& job) {
  if (auto s = io::check_marker_format(job.output); !s) return std::unexpected(s.error());
  auto staging = Staging::create({job.output}, job, {job.recording, job.rig});
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add_page(job.report); !s) return std::unexpected(s.error());
  const auto rig = io::read_rig(job.rig);
  if (!rig) return std::unexpected(rig.error());
  auto recording = io::read_counts(job.recording);
  if (!recording) return std::unexpected(recording.error());
  auto options = job.options;
  options.threads = job.threads;
  auto found = workflow::reconstruct(recording->counts, *rig, options);
  if (!found) return fail_at(job.recording.string(), found.error());
  ReconstructOutcome out;
  out.method = job.options.method;
  out.frames = recording->counts.frames();
  out.found = std::move(*found);
  out.warnings = std::move(recording->warnings);
  out.warnings.insert(out.warnings.end(), out.found.remarks.warnings.begin(),
                      out.found.remarks.warnings.end());
  data::Trial trial;
  trial.source = job.recording.string();
  trial.markers = std::move(out.found.markers);
  std::vector<ResultFile> files{marker_file(job.output, trial)};
  out.written = {job.output};  // as the page says
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] { return reconstruct_page(job, out, *rig, trial.markers); }));
  auto written = write_results(*staging, files, {}, "the reconstruction");
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  out.found.markers = std::move(trial.markers);
  return out;
}

}  // namespace kinemark::pipeline
