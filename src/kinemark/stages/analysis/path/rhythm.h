// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What repeats in a path: movements between rests, and the cycles of a periodic movement. Times are counted
// from the first sample, s.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/timing.h"

namespace kinemark::analysis {

/// How long a movement takes to repeat, and how much it is like itself then.
struct Period {
  double s = kNaN;        ///< NaN: it does not come back to what it did
  double likeness = 0.0;  ///< correlation of the velocity with itself one period later, at most 1
};
/// The least lag up to half of the samples at which the velocity, less its mean, is like itself again: the
/// first peak of its autocorrelation (axes added, each lag over the samples it has) that reaches nine tenths
/// of the highest one behind the first lag without likeness. Cost: n log n.
/// @param v  n x 3
[[nodiscard]] Period period_of(const SeriesMatrix& v, double rate_hz);

/// The likeness at one lag, or the largest at those within a tenth of it. Cost: n times a fifth of the lag,
/// 2e7 at most: of longer series every k-th sample counts.
[[nodiscard]] double likeness_after(const SeriesMatrix& v, double rate_hz, double lag_s);

/// Least likeness of a periodic movement. Of filtered noise, which has no period, one path in fifty comes as
/// far.
inline constexpr double kPeriodicLikeness = 0.5;

/// From a crossing to the one a period later: indices of crossings, ascending.
using CycleEnds = std::pair<std::size_t, std::size_t>;
/// Pairs of crossings that lie a period apart, by up to kPeriodSlack of it, from the first on: where several
/// crossings fall into a period, the ones that make the longest row; where none follows, the row ends, and
/// another begins behind it.
/// @param crossings  s, ascending
[[nodiscard]] std::vector<CycleEnds> cycles_among(std::span<const double> crossings, double period_s);
/// How far a cycle may be from the period, of it.
inline constexpr double kPeriodSlack = 0.35;

/// Which of the movements are like each other: the number of its kind for each, from 0 in the order in which
/// kinds appear. Two are of a kind where their ways from start to end differ by less than half of the
/// longer; ways below a quarter of the longest, of movements that come back to where they began, are a kind,
/// too.
/// @param ways  from start to end, m
[[nodiscard]] std::vector<std::size_t> kinds_of(std::span<const Eigen::Vector3d> ways);

}  // namespace kinemark::analysis
