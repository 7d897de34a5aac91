// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a job asks of the measures of a recording, as workflow::measure_recording() takes it.
#pragma once

#include "kinemark/core/result.h"
#include "kinemark/pipeline/measures/measures_job.h"
#include "kinemark/workflow/measures/asked.h"

namespace kinemark::pipeline {

/// The options of the verb: files of roles and of maxima are read. Code::usage for a measure that does not
/// exist, with the nearest names, for one of another command, and as gait_options() and
/// workflow::asked_measures(); else as the readers.
[[nodiscard]] Result<workflow::MeasureOptions> measure_options(const MeasuresJob& job);

}  // namespace kinemark::pipeline
