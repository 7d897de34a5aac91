// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/simulation/subject.h"

namespace kinemark::pipeline {

/// What `kinemark simulate subject` is asked to do.
struct SubjectJob {
  std::filesystem::path folder;        ///< made when absent
  std::filesystem::path model;         ///< empty: kinemark's own human
  simulation::SubjectOptions options;  ///< of the subject and its motion
  bool force = false;                  ///< replace files that exist
};

/// Write markers.c3d, markers.trc (what a laboratory records), model.osim, truth.mot (degrees, metres) and
/// truth.trc (markers without noise or gaps). Either all files appear or none, nor the folder.
/// `progress` counts files. Returns their paths.
[[nodiscard]] Result<std::vector<std::filesystem::path>> simulate_subject(const SubjectJob& job,
                                                                          const Progress& progress = {});

}  // namespace kinemark::pipeline
