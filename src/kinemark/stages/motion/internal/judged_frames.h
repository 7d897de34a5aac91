// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// All frames solved, with the samples left out that do not belong to them.
#pragma once

#include <optional>
#include <vector>

#include "kinemark/stages/motion/internal/exchanges.h"
#include "kinemark/stages/motion/internal/frame_walk.h"
#include "kinemark/stages/motion/internal/judgement.h"
#include "kinemark/stages/motion/internal/outlier_account.h"

namespace kinemark::motion::internal {

/// Samples that give themselves away without any model: a value held digit by digit while the body moves, a
/// coordinate that is exactly 0 between others that are not.
[[nodiscard]] std::vector<Outlier> find_plain_defects(const Problem& problem,
                                                      const data::Trajectories& markers,
                                                      const SolvedFrames& solved);

/// Poses, and what was left out on the way.
struct JudgedFrames {
  SolvedFrames solved;
  std::optional<data::Trajectories>
      kept;  ///< the recording, exchanges undone and without what was left out; none where it is as it was
  std::optional<data::Trajectories>
      filled;  ///< the same with what was left out where its marker lies on the body in the frames beside
  std::vector<Outlier> rejected;    ///< by marker and frame, none overlaps another of the same marker
  std::vector<Outlier> doubtful;    ///< as of Judgement
  std::vector<Exchange> exchanges;  ///< undone: each pair once
};

/// Undo exchanges of labels, solve, judge, solve the frames concerned again, until nothing more is found. No
/// value when the caller stopped it.
[[nodiscard]] std::optional<JudgedFrames> solve_and_judge(const Problem& problem, const IkOptions& options,
                                                          const data::Trajectories& markers,
                                                          const Progress& progress);

/// What poses that followed all samples say of these.
struct FollowedSamples {
  bool all_explained = false;  ///< nothing to undo, to leave out or to doubt
  std::int64_t solves = 0;  ///< poses that were solved for: of frames in which markers come, go or stand out
};

/// Judge samples by poses that followed all of them (one column per frame), without solving all frames.
/// `status` as SolvedFrames has it.
[[nodiscard]] FollowedSamples judge_followed(const Problem& problem, const IkOptions& options,
                                             const data::Trajectories& markers, const Eigen::MatrixXd& states,
                                             const Array<data::FrameStatus>& status);

}  // namespace kinemark::motion::internal
