// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The noise of markers as results hold it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "kinemark/stages/analysis/path/path_noise.h"

namespace kinemark::pipeline {

/// One object a marker: "subject", "source", "kind", "sd_mm" (per axis, before any filter), "found_mm", where
/// there are "sample_sd_mm" (of a sample as recorded) and "stated_mm", "correlation" with
/// "correlation_time_s", "filter" ("form", "order", "cutoff_hz" with "low_hz" and "high_hz", 95 %, -3 dB,
/// "half_amplitude_hz"), "floor_mm", "rounding_step_mm"; "slow_noise_mm" (0.2 to 2 Hz: "low", "middle",
/// "high", 10, 50 and 90 %), "slow_noise_unknown" and "outliers". null where not known.
[[nodiscard]] nlohmann::ordered_json noises_json(std::span<const analysis::PathNoise> noises);

}  // namespace kinemark::pipeline
