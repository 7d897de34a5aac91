// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Samples judged in both directions of time, and what follows for a recording: what is left out, and where
// nobody can say which of two stretches is wrong. Theory: docs/theory/inverse-kinematics.md
#pragma once

#include <vector>

#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/sample_judge.h"

namespace kinemark::motion::internal {

/// What became of the samples of a recording.
struct Judgement {
  std::vector<Outlier> bad;       ///< to be left out
  std::vector<Outlier> doubtful;  ///< this or the other side of its beginning is wrong; kept
};

/// Samples that give themselves away without any model: a value held digit by digit while the body moves, a
/// coordinate that is exactly 0 between others that are not.
[[nodiscard]] std::vector<Outlier> find_plain_defects(const Problem& problem,
                                                      const data::Trajectories& markers,
                                                      const SolvedFrames& solved);

/// Judge all samples that are present, by the poses and positions of `solved`.
[[nodiscard]] Judgement judge_recording(const Problem& problem, const IkOptions& options,
                                        const data::Trajectories& markers, const SolvedFrames& solved);

}  // namespace kinemark::motion::internal
