// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory::smoothing {

/// A cut-off that is good for positions lets too much noise into derivatives where the movement ends below
/// it. This one weighs both: the geometric mean of cutoff_hz, best for positions, and of the cut-off with the
/// least estimated error of velocity, searched around it. That estimate is Stein's again, inside a wider
/// band in which movement and noise can be told apart: mean (v_wide - v)^2 + 2 sigma^2 dt / pi integral of
/// w^2 H H_wide dw. O(10 filters).
/// @param noise_sd_m  > 0, of a sample of variance 1
[[nodiscard]] double refine_cutoff(std::span<const Series> parts, int order, double cutoff_hz,
                                   double noise_sd_m);

enum class Criterion : std::uint8_t {
  sure,  ///< RSS / n + 2 sigma^2 tr A / n: Stein's unbiased estimate of the squared error, sigma known or
         ///< found
  gcv,   ///< (RSS / n) / (1 - tr A / n)^2: Craven & Wahba 1979, as in Woltring's GCVSPL
};

struct ChooseOptions {
  Criterion criterion = Criterion::sure;
  int order = 0;            ///< 0: 2 to 5 (sure), 3 to 5 (gcv)
  double cutoff_hz = 0.0;   ///< 0: found
  double noise_sd_m = 0.0;  ///< of a sample of variance 1; 0: found by GCV
  double rate_hz = 0.0;
};

struct Choice {
  int order = 0;
  double cutoff_hz = 0.0;
  double noise_sd_m = 0.0;  ///< as given or found; NaN when there are too few samples
  std::vector<data::FilterCandidate> candidates;
  bool enough = true;  ///< false: too few samples to choose by, the defaults were taken
};

/// Fewer samples than this do not suffice to choose a filter.
inline constexpr std::int64_t kFewestSamples = 12;

/// Longest stretches from which a filter is chosen: all of it up to 16384 frames, else
/// eight stretches of 2048, spread evenly over the samples that are seen.
[[nodiscard]] std::vector<Series> windows(const Series& series);

/// Value of a criterion; sigma only matters to SURE.
[[nodiscard]] double criterion_value(Criterion criterion, const Scores& scores, double sigma);

/// Order and cut-off with the smallest criterion, one choice for all series (parts or axes of one marker). A
/// lower order than 4 must be better by 5 % of the risk: it has no jerk. O(100 filters).
[[nodiscard]] Choice choose(std::span<const Series> parts, const ChooseOptions& options);

}  // namespace kinemark::trajectory::smoothing
