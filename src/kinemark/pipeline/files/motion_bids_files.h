// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/job_settings.h"

namespace kinemark::pipeline {

/// Write a trial as a recording of Motion-BIDS: table, sidecars and, where the data set has none yet, its
/// description and README, all of them or none. Folders are made. Code::usage, saying the pattern, for a path
/// that is not as BIDS has it; else as io::motion_files() and Staging.
///
/// @param path    TOP/sub-LABEL/motion/sub-LABEL_task-LABEL_tracksys-LABEL_motion.tsv
/// @param job, inputs  as for Staging::create()
/// @return        what was written, the table first
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_motion_bids(
    const std::filesystem::path& path, const data::Trial& trial, const JobSettings& job,
    const std::vector<std::filesystem::path>& inputs);

}  // namespace kinemark::pipeline
