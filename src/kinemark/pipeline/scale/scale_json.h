// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "kinemark/pipeline/scale/scale_job.h"

namespace kinemark::pipeline {

/// JSON of a scaling: format "kinemark-scale", version 1; docs/stages/scale.md says what stands where.
[[nodiscard]] nlohmann::ordered_json scale_json(const ScaleJob& job, const ScaleOutcome& outcome);

}  // namespace kinemark::pipeline
