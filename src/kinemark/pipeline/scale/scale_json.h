// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <string>

#include "kinemark/pipeline/scale/scale_job.h"

namespace kinemark::pipeline {

/// HTML of a scaled model: what stands out, each size and length with its interval, what the data do not
/// determine, how far markers moved.
[[nodiscard]] std::string scale_page(const ScaleJob& job, const ScaleOutcome& outcome);

/// Sizes, lengths and positions that were found from markers, each with its standard deviation.
/// @param moved  whether there was more than one posture: one cannot tell what follows it
[[nodiscard]] nlohmann::ordered_json adapted_json(const motion::AdaptResult& result, bool moved);

/// JSON of a scaling: format "kinemark-scale", version 1; docs/stages/scale.md says what stands where.
[[nodiscard]] nlohmann::ordered_json scale_json(const ScaleJob& job, const ScaleOutcome& outcome);

}  // namespace kinemark::pipeline
