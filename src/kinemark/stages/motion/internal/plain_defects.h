// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/outlier_account.h"

namespace kinemark::motion::internal {

/// Samples that give themselves away without any model: a value held digit by digit while the body moves, a
/// coordinate that is exactly 0 between others that are not.
[[nodiscard]] std::vector<Outlier> find_plain_defects(const Problem& problem,
                                                      const data::Trajectories& markers,
                                                      const SolvedFrames& solved);

}  // namespace kinemark::motion::internal
