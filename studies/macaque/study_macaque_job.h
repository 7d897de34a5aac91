// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "studies/common/study_page.h"
#include "studies/common/study_table.h"
#include "studies/macaque/elbow_study.h"
#include "studies/macaque/published_elbow.h"

namespace kinemark::studies {

/// What `kinemark study macaque` is asked to do.
struct MacaqueJob {
  std::vector<std::uint64_t> seeds{1};  ///< one recording a cell each
  bool as_published =
      false;  ///< the report's own method by the reading that its numbers need, and nothing else
  std::vector<double> noise_mm{0.5, 1.0, 2.0, 3.0, 5.0};
  std::vector<double> missing{0.0, 0.2, 0.4, 0.6};
  std::int64_t frames = 400;                                ///< of the report's arm
  std::vector<double> sleeve_noise_mm{0.5, 1.0, 2.0, 3.0};  ///< empty: no sleeve
  double sleeve_s = 15.0;
  int threads = 0;
};

/// A cell and its errors, all seeds together.
struct ElbowResult {
  ElbowCell cell;
  ElbowErrors errors;
  double worst_over_bound = 0.0;  ///< of a seed, ours; NaN as soon as one seed has none
  /// Add one seed's errors.
  void add(const ElbowErrors& of_seed);
};

struct SleeveResult {
  SleeveCell cell;
  SleeveErrors errors;
};

struct MacaqueStudy {
  /// Noise (none for the report's method alone, and as asked) x missing x collinear and staggered by 20 mm x
  /// uniform and pose-correlated losses.
  std::vector<ElbowResult> elbow;
  std::vector<SleeveResult> sleeve;        ///< noise x line of sight as usual and hard
  std::vector<PublishedResult> published;  ///< where it was asked for
  StudyTable table;

  /// The cell, or null when it was not asked for.
  [[nodiscard]] const ElbowResult* find(double noise_mm, double missing, bool staggered,
                                        bool pose_correlated = false) const;
};

/// Run every cell for every seed, cells side by side. `progress` counts recordings.
[[nodiscard]] Result<MacaqueStudy> study_macaque(const MacaqueJob& job, const Progress& progress = {});

}  // namespace kinemark::studies
