// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/pipeline/acquire/acquire_job.h"
#include "kinemark/pipeline/files/info_json.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers that are not known are null.
Json four(const Eigen::Vector4d& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return out;
}

Json levels_json(const AcquireOutcome& outcome) {
  const auto& layout = outcome.plan.layout;
  Json out = Json::array();
  for (std::size_t at = 0; at < outcome.recorded.lit.size(); ++at) {
    const auto& levels = outcome.recorded.lit[at];
    out.push_back({{"led", layout.leds[at / layout.cameras.size()]},
                   {"camera", layout.cameras[at % layout.cameras.size()]},
                   {"frames", levels.frames},
                   {"saturated", levels.saturated},
                   {"still", levels.still},
                   {"mean", four(levels.mean)},
                   {"sd", four(levels.sd)},
                   {"noise", four(levels.noise)}});
  }
  return out;
}

Json clock_json(const std::optional<stream::ClockRate>& clock) {
  if (!clock) return nullptr;
  return {{"rate_hz", clock->rate_hz},
          {"rate_sd_hz", clock->sd_hz},
          {"fast_ppm", clock->ppm_fast},
          {"fast_sd_ppm", clock->sd_ppm},
          {"seconds", clock->span_s}};
}

}  // namespace

Json progress_json(const RecorderProgress& progress) {
  return {{"frames", progress.frames},
          {"acknowledged", progress.acknowledged},
          {"dropped_by_device", progress.dropped_by_device},
          {"dropped_here", progress.dropped_here}};
}

Json acquire_json(const AcquireOutcome& outcome) {
  Json out = outcome_json(outcome);
  out["ended"] = to_string(outcome.recorded.end);
  out.update(progress_json(outcome.recorded.progress));
  out["reopened"] = outcome.recorded.progress.reopened;
  out["fullest_ring"] = outcome.recorded.progress.fullest_ring;
  out["rate_hz"] = outcome.plan.plan.rate_hz;
  out["clock"] = clock_json(outcome.recorded.clock);
  out["leds"] = levels_json(outcome);
  out["notes"] = out["wrong"] = Json::array();
  for (const auto& note : outcome.notes) {
    out["notes"].push_back(note.text);
    if (!note.good) out["wrong"].push_back(note.text);
  }
  out["error"] = outcome.recorded.error ? Json(outcome.recorded.error->message) : Json(nullptr);
  return out;
}

}  // namespace kinemark::pipeline
