// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "kinemark/stages/trajectory/gaps/gap_options.h"
#include "kinemark/stages/trajectory/gaps/internal/fills.h"
#include "kinemark/stages/trajectory/gaps/internal/label_check.h"

namespace kinemark::trajectory::internal {

/// The fill that is used, combined from the candidates.
struct Combination {
  std::vector<double> weights;  ///< per candidate, >= 0, sum 1
  std::vector<bool> guarded;    ///< per candidate: left out because it deviates from the others
  Eigen::MatrixXd gap;          ///< L x 3, m
  Eigen::VectorXd sd_m;         ///< L, per axis; NaN without windows
};

/// Convex combination with weights that minimise the squared leave-gap-out error, or the one best candidate.
///
/// Candidates with more than 3 times the least error are excluded, and so are those that deviate in this gap:
/// further from the median of the others, or (untied ones) from the samples beside the gap, than their errors
/// allow. SD: errors of the combination on the windows, each rescaled by how much the candidates disagree
/// in this gap and in that window; see docs/theory/gaps.md. `fills` is not empty.
[[nodiscard]] Combination combine(const GapProblem& problem, const std::vector<Fill>& fills, bool only_best);

/// min w'Mw over w >= 0, sum w = 1, for a positive definite M.
[[nodiscard]] Eigen::VectorXd simplex_weights(const Eigen::MatrixXd& M);

/// A stretch as it was filled.
struct Filled {
  GapProblem problem;
  std::vector<Fill> fills;  ///< empty when nothing could be made
  Combination combination;  ///< SD with the noise of a sample
};

/// A recording made ready for filling. Filling one stretch does not change it.
class Filler {
 public:
  Filler(const data::Trajectories& in, const GapOptions& options);

  [[nodiscard]] const Recording& recording() const { return recording_; }
  [[nodiscard]] const std::vector<Swap>& swaps() const { return swaps_; }
  /// SD of a sample of a marker, m per axis.
  [[nodiscard]] double noise_m(Index marker) const { return noise_m_[static_cast<std::size_t>(marker)]; }
  /// The stretch with the usable samples beside it, 0.3 s of them at most.
  [[nodiscard]] GapSpan span(Index marker, Index first, Index end) const;
  /// The method takes other markers into account.
  [[nodiscard]] bool uses_neighbours() const;
  /// Safe from several threads at once.
  [[nodiscard]] Filled fill(const GapSpan& span, const std::vector<Neighbour>& neighbours) const;

 private:
  GapOptions options_;
  Recording recording_;
  std::vector<double> noise_m_;
  std::vector<Swap> swaps_;
  mutable WalkCache cache_;  // remembers matrices; never changes a result
};

/// Cut a gap where the set of complete neighbours changes, if single pieces have clearly more rigid
/// neighbours than the gap as a whole. One piece, the gap itself, when there is nothing to gain. Only the
/// first piece uses the samples before the gap, only the last one those after it.
[[nodiscard]] std::vector<GapSpan> split_gap(const Recording& recording,
                                             const std::vector<Neighbour>& neighbours, const GapSpan& gap);

/// Tie consecutive pieces to one another. Errors are taken to grow from the outer end of a piece to the joint
/// as those of a random walk do; the mismatch is distributed in proportion to the variances. The SDs remain
/// those of pieces without a constraint at the joint.
void join_pieces(std::span<Filled> pieces);

}  // namespace kinemark::trajectory::internal
