// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What smooth_motion() and smooth_images() share.
#pragma once

#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/smoother/internal/noise.h"
#include "kinemark/stages/motion/smoother/smoother.h"

namespace kinemark::motion::internal {

struct Prepared {
  Problem problem;
  IkResult start;
  double seconds = 0.0;
};

/// Options checked, model and recording matched, least squares solved.
[[nodiscard]] Result<Prepared> prepare(const model::Model& model, const data::Trajectories& markers,
                                       const SmootherOptions& options, const Progress& progress);

/// Runs the smoother from `prepared`, whose marker summaries are moved into the result.
[[nodiscard]] Result<SmootherResult> run(Prepared& prepared, const data::Trajectories& markers,
                                         const Sightings& sightings, const NoiseSplit& noise,
                                         const SmootherOptions& options, const Progress& progress);

}  // namespace kinemark::motion::internal
