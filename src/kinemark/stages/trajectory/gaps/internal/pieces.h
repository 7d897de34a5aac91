// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kinemark/stages/trajectory/gaps/internal/filler.h"

namespace kinemark::trajectory::internal {

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
