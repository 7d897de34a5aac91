// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_job.h"

#include <utility>

#include "kinemark/core/enum_names.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/rig/rig_page.h"

namespace kinemark::pipeline {

std::string_view method_name(ReconstructJob::Method method) {
  constexpr EnumNames<ReconstructJob::Method::classic> kNames{"smoother", "frames", "classic"};
  return kNames[method];
}

Result<ReconstructOutcome> run_reconstruct(const ReconstructJob& job) {
  if (auto s = io::check_marker_format(job.output); !s) return std::unexpected(s.error());
  auto staging = Staging::create({job.output}, job, {job.recording, job.rig});
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add_page(job.report); !s) return std::unexpected(s.error());
  const auto rig = io::read_rig(job.rig);
  if (!rig) return std::unexpected(rig.error());
  auto recording = io::read_counts(job.recording);
  if (!recording) return std::unexpected(recording.error());
  auto frames = job.frames;
  frames.threads = job.threads;
  auto found = job.method == ReconstructJob::Method::classic
                   ? reconstruction::reconstruct_classic(recording->counts, *rig, frames)
                   : reconstruction::reconstruct(recording->counts, *rig, frames);
  if (!found) return fail_at(job.recording.string(), found.error());
  ReconstructOutcome out;
  out.method = job.method;
  out.frames = recording->counts.frames();
  out.leds = std::move(found->leds);
  out.warnings = std::move(recording->warnings);
  data::Trial trial;
  trial.source = job.recording.string();
  if (job.method == ReconstructJob::Method::smoother) {
    auto smoother = job.smoother;
    smoother.threads = job.threads;
    auto smooth = trajectory::smooth_counts(recording->counts, *rig, found->points, smoother);
    if (!smooth) return fail_at(job.recording.string(), smooth.error());
    trial.markers = std::move(smooth->points);
    out.fits = std::move(smooth->leds);
  } else {
    trial.markers = std::move(found->points);
  }
  std::vector<ResultFile> files{marker_file(job.output, trial)};
  out.written = {job.output};  // as the page says
  if (!job.report.empty())
    files.push_back(text_file(job.report, [&] { return reconstruct_page(job, out, *rig, trial.markers); }));
  auto written = write_results(*staging, files, {}, "the reconstruction");
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return out;
}

}  // namespace kinemark::pipeline
