// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/pipeline/measures/measure_figures.h"
#include "kinemark/pipeline/measures/measures_job.h"

namespace kinemark::pipeline {

/// The page of a recording's measures: what stands out, figures, the table.
[[nodiscard]] std::string measures_page(const MeasuresJob& job, const MeasuresOutcome& outcome,
                                        const std::vector<NamedFigure>& figures);

}  // namespace kinemark::pipeline
