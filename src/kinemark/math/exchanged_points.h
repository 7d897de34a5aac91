// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Two of several moving points that carry each other's names in some frames: single ones, stretches, or to
// and fro. An exchange turns the line between the two round and leaves their middle where it is, so that only
// the signs of that line have to be found: those by which it changes most smoothly, and by which each point
// keeps its distances to others. Theory: docs/theory/exchanges.md
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace kinemark::math {

/// Points as they were recorded. What it points to must live as long as it is used.
struct PointPaths {
  const double* x = nullptr;            ///< F x P x 3, m; NaN where a point was not seen
  std::int64_t frames = 0, points = 0;  ///< F, P
  double rate_hz = 0.0;                 ///< > 0
};

/// What to look for.
struct ExchangeSearch {
  double least_m = 0.03;       ///< > 0; points that are nearer to each other are not told apart
  double longest_gap_s = 0.1;  ///< > 0; paths are continued over that
  /// Distance that a point should have from another, m; NaN where nothing is known. Asked only where the
  /// frames in which that point and its partner (the third argument) are exchanged have been found, for which
  /// of the two sides is wrong: no sample of either of the two can tell. May be empty.
  std::function<double(std::int64_t, std::int64_t, std::int64_t)> distance;
};

/// Two points and the frames in which they carry each other's names.
struct ExchangedPair {
  std::int64_t one = 0, other = 0;   ///< one < other
  std::vector<std::int64_t> frames;  ///< in order, not empty
  double ratio = 0.0;                ///< exchanged they continue their paths so many times better, at least
  double apart_m = 0.0;              ///< median distance of the two in these frames
  /// Which side is wrong: these frames, or all others with both points. By far fewer frames, or told by
  /// distances: true; else the fewer ones are named.
  bool side_known = false;
  bool stated_by_distances = false;  ///< the distances that were known beforehand say so
  /// Both sides of every change were seen: the exchange does not merely last to an end of the recording.
  bool ends = false;
};

/// All exchanges that explain both points better than the names as they are, by the evidence of paths and
/// distances; those with the most evidence first. Exchanges found earlier are undone before the next are
/// looked for. Nothing is found among fewer than three frames, and of three points that change round.
/// O(F P), and O(F P) for each pair that jumps to each other's path.
[[nodiscard]] std::vector<ExchangedPair> find_exchanges(const PointPaths& paths,
                                                        const ExchangeSearch& search = {});

}  // namespace kinemark::math
