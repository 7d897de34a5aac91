// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_job.h"

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json told_of(const reconstruction::LedSummary& led) {
  return {{"name", led.name},          {"frames", led.frames},       {"located", led.located},
          {"occluded", led.occluded},  {"saturated", led.saturated}, {"inconsistent", led.inconsistent},
          {"near_edge", led.near_edge}};
}

void add_fit(const trajectory::LedFit& fit, Json& to) {
  to["order"] = fit.bandwidth.order;
  to["cutoff_hz"] = fit.bandwidth.cutoff_hz;
  to["chi2_per_dof"] = fit.chi2_per_dof;
  to["rejected"] = fit.rejected;
  to["held_down"] = fit.held_down;
  to["flicker_counts"] = fit.flicker_counts;
}

}  // namespace

Result<Json> reconstruct_file(const ReconstructJob& job) {
  const auto rig = io::read_rig(job.rig);
  if (!rig) return std::unexpected(rig.error());
  const auto recording = io::read_counts(job.recording);
  if (!recording) return std::unexpected(recording.error());
  const auto found = job.method == ReconstructJob::Method::classic
                         ? reconstruction::reconstruct_classic(recording->counts, *rig, job.frames)
                         : reconstruction::reconstruct(recording->counts, *rig, job.frames);
  if (!found) return fail_at(job.recording.string(), found.error());
  Json leds = Json::array();
  for (const auto& led : found->leds) leds.push_back(told_of(led));
  data::Trial trial;
  trial.source = job.recording.string();
  trial.markers = found->points;
  if (job.method == ReconstructJob::Method::smoother) {
    const auto smooth = trajectory::smooth_counts(recording->counts, *rig, found->points, job.smoother);
    if (!smooth) return fail_at(job.recording.string(), smooth.error());
    trial.markers = smooth->points;
    for (std::size_t i = 0; i < smooth->leds.size(); ++i) add_fit(smooth->leds[i], leds[i]);
  }
  if (auto s = io::write_markers(job.output, trial, job.force); !s) return std::unexpected(s.error());
  const char* const names[] = {"smoother", "frames", "classic"};
  return Json{{"method", names[static_cast<std::size_t>(job.method)]},
              {"frames", recording->counts.frames()},
              {"written", job.output.string()},
              {"warnings", recording->warnings},
              {"leds", std::move(leds)}};
}

}  // namespace kinemark::pipeline
