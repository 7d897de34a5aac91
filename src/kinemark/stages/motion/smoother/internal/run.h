// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What smooth_motion() and smooth_images() share.
#pragma once

#include <optional>

#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/smoother/internal/noise.h"
#include "kinemark/stages/motion/smoother/observations.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::motion::internal {

struct Prepared {
  Problem problem;
  IkResult start;
  double seconds = 0.0;
  std::optional<data::Trajectories>
      kept;  ///< the recording without what the start left out; none: all was kept
  /// The samples that are believed.
  [[nodiscard]] const data::Trajectories& believed(const data::Trajectories& markers) const {
    return kept ? *kept : markers;
  }
};

/// Options checked, model and recording matched, least squares solved.
[[nodiscard]] Result<Prepared> prepare(const model::Model& model, const data::Trajectories& markers,
                                       const SmootherOptions& options, const Progress& progress);

/// Runs the smoother from `prepared`, whose marker summaries are moved into the result.
[[nodiscard]] Result<SmootherResult> run(Prepared& prepared, const data::Trajectories& markers,
                                         const Observations& observations, const NoiseSplit& noise,
                                         const SmootherOptions& options, const Progress& progress);

}  // namespace kinemark::motion::internal
