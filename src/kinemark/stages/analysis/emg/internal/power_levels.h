// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The power of a band in short bins, and the steps between which it keeps a level.
#pragma once

#include <cstdint>
#include <vector>

namespace kinemark::analysis {

/// Bins [first, end) of one level.
struct PowerLevel {
  std::int64_t first = 0, end = 0;  ///< bins
  double power = 0.0;               ///< their mean
};

/// Power of bins as gamma variates whose mean keeps a level between steps: of all ways to step between levels
/// a quarter of a natural logarithm apart the likeliest, each step at the cost of telling where it is.
/// Neighbouring bins of a muscle may scatter more than those of Gaussian noise, those of hum less: `freedom`
/// becomes what runs of five show within levels.
/// @param power    one a bin, > 0
/// @param freedom  of a bin: its power is a mean of so many squares of Gaussian variates
[[nodiscard]] std::vector<PowerLevel> power_levels(const std::vector<double>& power, double& freedom);

/// What of the channel is quiet.
struct Quiet {
  enum class Found : std::uint8_t { bursts, steady, no_rest };
  Found found = Found::steady;  ///< no_rest: its quietest parts are no level of their own
  double power = 0.0;           ///< of rest
  std::vector<char> active;     ///< one a bin
};

/// Lengths that count, in bins.
struct QuietBins {
  double rest = 0.0;    ///< the least rest of a channel
  double burst = 0.0;   ///< the shortest burst and interruption
  double judged = 0.0;  ///< the shortest quiet part that tells rest from a valley between two bursts
};

/// Rest is the lowest level that is kept for `bins.rest` in all; active is what has twice its power, for
/// `bins.burst` together. Rest is none where the channel spends more time just above it than at it, as a
/// modulated strength does, where its quiet parts are valleys rather than even, or where they are too short
/// to show which: `bins.rest` have to lie in parts of `bins.judged` and more.
/// @param freedom        of a bin within levels
/// @param freedom_still  that of noise of the channel's spectrum and even strength: where nothing is active
/// and bins scatter by twice as much, the strength is modulated
[[nodiscard]] Quiet find_quiet(const std::vector<double>& power, const std::vector<PowerLevel>& levels,
                               double freedom, double freedom_still, const QuietBins& bins);

}  // namespace kinemark::analysis
