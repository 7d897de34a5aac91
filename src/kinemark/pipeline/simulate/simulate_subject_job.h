// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/simulation/subject.h"

namespace kinemark::pipeline {

/// What `kinemark simulate subject` is asked to do.
struct SimulateSubjectJob : JobSettings {
  std::filesystem::path folder;        ///< made when absent
  std::filesystem::path model;         ///< empty: kinemark's own human
  simulation::SubjectOptions options;  ///< of the subject and its motion
};

struct SimulateSubjectOutcome : JobOutcome {};

/// Write markers.c3d, markers.trc (what a laboratory records), model.osim, truth.mot (degrees, metres) and
/// truth.trc (markers without noise or gaps). Either all files appear or none, nor the folder. Progress
/// counts files.
[[nodiscard]] Result<SimulateSubjectOutcome> run_simulate_subject(const SimulateSubjectJob& job);

}  // namespace kinemark::pipeline
