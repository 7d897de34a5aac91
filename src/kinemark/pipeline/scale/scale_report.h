// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/pipeline/scale/scale_job.h"

namespace kinemark::pipeline {

/// JSON of a scaling: format "kinemark-scale", version 1; docs/stages/scale.md describes the fields.
[[nodiscard]] std::string scale_report(const ScaleJob& job, const ScaleOutcome& outcome);

}  // namespace kinemark::pipeline
