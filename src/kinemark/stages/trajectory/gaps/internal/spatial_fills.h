// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/fills.h"

namespace kinemark::trajectory::internal {

/// Append the candidates that use other markers. The problem has windows and predictors.
void spatial_fills(const Recording& recording, const GapProblem& problem, GapMethod method, WalkCache& cache,
                   std::vector<Fill>& fills);

}  // namespace kinemark::trajectory::internal
