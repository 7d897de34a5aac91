// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Markers that carried each other's labels, and their samples exchanged back. Theory:
// docs/theory/exchanges.md
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/internal/outlier_account.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// Two markers of the model, and the frames in which each carried the other's label.
struct Exchange {
  int one = 0, other = 0;            ///< one < other
  std::vector<std::int64_t> frames;  ///< of the problem, in order
};

/// Exchanges that the paths of the markers and their distances to each other tell; where those leave open
/// which side is wrong, the model's distances between markers of one body decide. Those that stay open are
/// left out.
[[nodiscard]] std::vector<Exchange> find_path_exchanges(const Problem& problem,
                                                        const data::Trajectories& markers);

/// Of stretches that are not believed: the frames in which two markers lay in each other's positions. They
/// are taken out of the stretches, which may leave nothing of them.
[[nodiscard]] std::vector<Exchange> take_mutual(std::vector<Outlier>& outliers);

/// Exchange the samples back, with all that is known of them, where both are present.
void exchange_back(const Problem& problem, const std::vector<Exchange>& exchanges,
                   data::Trajectories& markers);

/// Add exchanges to those before: one entry for each pair. What was exchanged twice is as it was.
void add_exchanges(const std::vector<Exchange>& more, std::vector<Exchange>& all);

}  // namespace kinemark::motion::internal
