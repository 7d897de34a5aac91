// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_job.h"

#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/rig/rig_page.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json summary_of(const reconstruction::LedSummary& led) {
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

/// Numbers that were not found are null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void add_light(const reconstruction::LedLight& found, Json& to) {
  const bool known = found.source != reconstruction::LightSource::unknown;
  to["light"] = number(known ? found.light : kNaN);
  to["light_sd"] = number(known ? found.light_sd : kNaN);
  to["light_source"] = to_string(found.source);
  to["strength_counts"] = found.strength_counts;
}

}  // namespace

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
  trial.calibration_error = out.found.calibration_error;
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

Json reconstruct_json(const ReconstructOutcome& outcome) {
  Json leds = Json::array();
  for (const auto& led : outcome.found.leds) leds.push_back(summary_of(led));
  for (std::size_t i = 0; i < outcome.found.lights.size(); ++i) add_light(outcome.found.lights[i], leds[i]);
  for (std::size_t i = 0; i < outcome.found.fits.size(); ++i) add_fit(outcome.found.fits[i], leds[i]);
  return Json{{"method", to_string(outcome.method)},
              {"frames", outcome.frames},
              {"written", outcome.written.front().string()},
              {"warnings", outcome.warnings},
              {"leds", std::move(leds)}};
}

}  // namespace kinemark::pipeline
