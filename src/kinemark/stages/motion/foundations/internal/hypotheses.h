// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Explanations of a still frame: nothing is wrong, one marker lies elsewhere, two are exchanged.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/foundations/internal/body_fit.h"

namespace kinemark::motion::internal {

/// One explanation.
struct Hypothesis {
  int first = -1, second = -1;  ///< markers of the body; second -1: first lies elsewhere
  double gain = 0.0;            ///< of the cost against no mistake, over the misfit
  double score = 0.0;           ///< gain less what the freedom to lie anywhere gains by itself
  double misfit = 1.0;          ///< squared distances over what the spreads lead to expect
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     ///< of a single marker, in the first segment's axes, m
  Eigen::Vector3d shift_sd = Eigen::Vector3d::Zero();  ///< per axis, m
};

/// Explanations in order, best first; computed in full are the likeliest `most` of each kind.
[[nodiscard]] std::vector<Hypothesis> explain(const StandingBody& body, const SharedPrior& prior,
                                              const SeenFrame& frame, int most = 4);

/// One marker elsewhere, against no mistake.
[[nodiscard]] Hypothesis explain_shift(const StandingBody& body, const SharedPrior& prior,
                                       const SeenFrame& frame, int marker);

/// What a finding needs: score and fall of the cost.
struct Least {
  double score = 0.0, fall = 0.0;
};

/// Share of single markers and directions (13 axes) in which a shift of this size would be a finding, were
/// all else as the frame shows it. 0 where no marker is seen.
[[nodiscard]] double share_seen(const StandingBody& body, const SharedPrior& prior, const SeenFrame& frame,
                                double shift_m, const Least& least);

/// Two markers as exchanged, against no mistake.
[[nodiscard]] Hypothesis explain_exchange(const StandingBody& body, const SharedPrior& prior,
                                          const SeenFrame& frame, int first, int second);

/// Gain of the frame's mirror image over the frame, as of an exchange; 0 where the frame is a body's, or its
/// image is none.
[[nodiscard]] double explain_mirrored(const StandingBody& body, const SharedPrior& prior,
                                      const SeenFrame& frame);

/// The mirror image of a frame, in the plane of the laboratory's y and z.
[[nodiscard]] SeenFrame mirror_image(SeenFrame frame);

}  // namespace kinemark::motion::internal
