// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A simulated recording in a folder, as a user would have it.
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/pipeline/simulate/simulate_subject_job.h"

namespace kinemark::pipeline::testing {

/// markers.c3d, markers.trc, model.osim, truth.mot, truth.trc of half a second of our human, 20 % gaps.
inline std::vector<std::filesystem::path> simulate_into(const std::filesystem::path& folder) {
  SimulateSubjectJob job;
  job.folder = folder;
  job.options.duration_s = 0.5;
  job.options.rate_hz = 60.0;
  job.options.dropout_random = 0.2;
  return run_simulate_subject(job).value().written;
}

}  // namespace kinemark::pipeline::testing
