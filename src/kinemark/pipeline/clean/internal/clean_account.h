// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is told of a run beside the account that the stages give, and what the job decides about it.
#pragma once

#include <vector>

#include "kinemark/data/clean_account.h"
#include "kinemark/data/upsampling.h"
#include "kinemark/pipeline/clean/clean_job.h"

namespace kinemark::pipeline::internal {

/// Defects of at least this confidence are rejected on request.
inline constexpr double kRejectConfidence = 0.8;

[[nodiscard]] report::CleanRun describe_run(const CleanJob& job, const data::Trial& trial);
/// What becomes of samples that the recorder made; nothing where there are none.
void settle_upsampling(workflow::RecorderMade made, data::UpsamplingAccount& upsampling);
/// What becomes of what screening found: sure label swaps are exchanged back, other sure defects taken out,
/// as the job says, except clock jumps, which have no wrong samples.
[[nodiscard]] std::vector<data::Defect> settle_defects(std::vector<data::Finding> found,
                                                       std::span<const data::Finding> exchanged,
                                                       std::span<const data::Finding> rejected);

}  // namespace kinemark::pipeline::internal
