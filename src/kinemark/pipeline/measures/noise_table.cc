// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/noise_table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/pipeline/files/table_cell.h"
#include "kinemark/stages/analysis/path/noise_sentences.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json filter_json(const analysis::PathNoise& noise, bool agreed) {
  const auto& model = noise.model;
  return {{"agreed", agreed},
          {"form", math::name_of(model.form, model.order)},
          {"order", model.order},
          {"cutoff_hz", json_number(noise.cutoff_hz.middle)},
          {"low_hz", json_number(noise.cutoff_hz.low)},
          {"high_hz", json_number(noise.cutoff_hz.high)},
          {"half_amplitude_hz", json_number(model.half * noise.rate_hz)}};
}

}  // namespace

Json noises_json(std::span<const analysis::PathNoise> noises) {
  Json out = Json::array();
  const auto shared = analysis::find_shared_filter(noises);
  for (std::size_t i = 0; i < noises.size(); ++i) {
    const auto& noise = noises[i];
    const auto& model = noise.model;
    const auto mm = [](double m) { return json_number(1e3 * m); };
    Json one{{"subject", noise.subject},
             {"source", to_string(noise.source)},
             {"kind", math::to_string(model.kind)},
             {"sd_mm", mm(noise.sd_m())},
             {"found_mm", mm(noise.found_sd_m)}};
    if (std::isfinite(noise.sample_sd_m)) one["sample_sd_mm"] = mm(noise.sample_sd_m);
    if (noise.stated_sd_m > 0.0) one["stated_mm"] = mm(noise.stated_sd_m);
    if (model.correlation > 0.0) {
      one["correlation"] = json_number(model.correlation);
      one["correlation_time_s"] = json_number(-1.0 / std::log(model.correlation) / noise.rate_hz);
    }
    if (noise.filtered())
      one["filter"] = filter_json(noise, noise.source == analysis::NoiseSource::filter ||
                                             std::ranges::find(shared.members, i) != shared.members.end());
    if (model.floor > 0.0) one["floor_mm"] = mm(std::sqrt(model.floor));
    if (noise.rounding_step_m > 0.0) one["rounding_step_mm"] = mm(noise.rounding_step_m);
    one["slow_noise_mm"] = {{"low", mm(noise.slow_sd_m.low)},
                            {"middle", mm(noise.slow_sd_m.middle)},
                            {"high", mm(noise.slow_sd_m.high)}};
    one["slow_noise_unknown"] = noise.slow_is_unknown();
    one["outliers"] = noise.outliers;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace kinemark::pipeline
