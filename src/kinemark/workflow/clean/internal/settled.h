// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What became of what screening found, in words.
#pragma once

#include <span>
#include <vector>

#include "kinemark/data/clean_account.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/upsampling.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow::internal {

/// What becomes of samples that the recorder made; nothing where there are none.
void settle_upsampling(RecorderMade made, data::UpsamplingAccount& upsampling);
/// What becomes of what screening found: sure label swaps are exchanged back, other sure defects taken out,
/// except clock jumps, which have no wrong samples.
[[nodiscard]] std::vector<data::Defect> settle_defects(std::vector<data::Finding> found,
                                                       std::span<const data::Finding> exchanged,
                                                       std::span<const data::Finding> rejected);

}  // namespace kinemark::workflow::internal
