// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// When a muscle is active, where that can be known, and what is rest.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/analysis/emg/envelope.h"
#include "kinemark/stages/analysis/emg/internal/power_levels.h"

namespace kinemark::analysis {

/// How it is looked for.
struct ActivityOptions {
  EnvelopeOptions band;     ///< that the signal was passed through
  double rest_s = 0.5;      ///< the least rest
  double burst_s = 0.05;    ///< the shortest burst and interruption that count
  std::int64_t draws = 99;  ///< of the instants
  std::uint64_t seed = 1;   ///< of the draws
};

/// Bursts, in samples and between them.
struct Activity {
  Quiet::Found found = Quiet::Found::steady;
  std::vector<Burst> bursts;              ///< medians of the draws; empty unless found == bursts
  std::vector<std::vector<Burst>> draws;  ///< likewise each
  std::vector<char> rest;                 ///< one a sample: well outside bursts
};

/// Power of the band in bins of 10 ms, its levels, which of them are rest, and when what is above begins and
/// ends (docs/theory/emg.md).
[[nodiscard]] Activity find_activity(const Eigen::VectorXd& band, double rate_hz,
                                     const ActivityOptions& options);

}  // namespace kinemark::analysis
