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
  std::int64_t solves = 0;        ///< poses that were solved for on the way
};

/// A frame whose samples may be believed, and those of the two on each side: the cheapest such stretch of
/// frames that see nearly all markers, and where there is one, the same in each. Where a marker comes or goes
/// the pose leaps, and with it the speed.
[[nodiscard]] std::int64_t find_sound_frame(const Problem& problem, const data::Trajectories& markers,
                                            const SolvedFrames& solved);

/// Judge the frames from `sound`, whose samples are believed, to `last` (included; last < sound: backwards).
/// So is the speed that led to it: the frame before must be sound too, where there is one.
///
/// @param solved  the pose of each frame, all its samples believed, and the positions of its markers
/// @param scale   its growth is learnt when it is first needed
/// @param solves  grows by the poses that were solved for
/// @return        in the order in which they end
[[nodiscard]] std::vector<Outlier> judge_samples(const Problem& problem, const IkOptions& options,
                                                 const data::Trajectories& markers,
                                                 const SolvedFrames& solved, StepScale& scale,
                                                 std::int64_t sound, std::int64_t last,
                                                 std::int64_t* solves = nullptr);

/// Judge all samples that are present, by the poses and positions of `solved`.
[[nodiscard]] Judgement judge_recording(const Problem& problem, const IkOptions& options,
                                        const data::Trajectories& markers, const SolvedFrames& solved);

}  // namespace kinemark::motion::internal
