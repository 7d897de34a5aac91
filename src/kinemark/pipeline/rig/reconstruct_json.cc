// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_json.h"

#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"

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
