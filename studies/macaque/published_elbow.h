// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The macaque report's method as its own numbers need it: one documented reading of what the report leaves
// open.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "studies/common/study_table.h"

namespace kinemark::studies {

/// What the report does not state and what decides its numbers. Chosen so that its three numbers come out;
/// three numbers bear out the method, not these.
struct PublishedReading {
  std::int64_t frames = 80;     ///< of a recording; every complete one informs the distances
  double penalty_m = 3e-5;      ///< weight of the mean distances, 0.03 in millimetres
  double low_noise_m = 7.5e-4;  ///< what "less than 1 mm" is taken for, per axis
};

/// Noise and losses of one cell of the report.
struct PublishedCell {
  double noise_m = 0.0, missing = 0.0;
  std::optional<double> paper_m;  ///< the report's mean error
};
/// 2 mm without losses, and less than 1 mm with 20 to 50 % of samples missing.
[[nodiscard]] std::vector<PublishedCell> published_cells(const PublishedReading& reading = {});

/// Mean distance of the elbow from its true position over the frames that a method answers, m; NaN where it
/// answers none. The report's answers frames with three visible markers on both segments; ours those that it
/// calls determined.
struct PublishedErrors {
  double classic_m = 0.0, ours_m = 0.0;
};

/// One recording: arm of 150 and 160 mm, three markers at a third, two thirds and the end of each segment.
[[nodiscard]] Result<PublishedErrors> study_published_elbow(const PublishedCell& cell, std::uint64_t seed,
                                                            const PublishedReading& reading = {});

/// A cell and what its recordings gave.
struct PublishedResult {
  PublishedCell cell;
  std::vector<double> classic_m, ours_m;  ///< of the recordings that have an answer
};

/// Share of missing samples at which the mean error of the report's method reaches `error_m`, on a straight
/// line between cells of less than 1 mm of noise; no value where it does not.
[[nodiscard]] std::optional<double> share_at(const std::vector<PublishedResult>& cells, double error_m);

/// Means over recordings and their deviations beside the report's numbers. No bounds.
[[nodiscard]] std::vector<StudyRow> published_rows(const std::vector<PublishedResult>& cells);

/// Every cell for every seed. `progress` counts recordings. About 0.1 s a recording.
[[nodiscard]] Result<std::vector<PublishedResult>> study_published(const std::vector<std::uint64_t>& seeds,
                                                                   int threads,
                                                                   const Progress& progress = {});

}  // namespace kinemark::studies
