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

/// JSON of a scaling: format "kinemark-scale", version 1; docs/stages/scale.md says what stands where.
[[nodiscard]] nlohmann::ordered_json scale_json(const ScaleJob& job, const ScaleOutcome& outcome);

}  // namespace kinemark::pipeline
