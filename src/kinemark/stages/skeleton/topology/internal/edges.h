// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/skeleton/functional/segment_poses.h"
#include "kinemark/stages/skeleton/topology/internal/pairs.h"

namespace kinemark::skeleton::internal {

/// Evidence for a joint between two segments; small values favour it.
struct Edge {
  int a = 0, b = 0;
  double residual_m = 0.0;  ///< of the common point; NaN where none could be fitted
  double cost_m = 0.0;      ///< with a share of the steadiest distance between their markers, see edge_cost()
};

/// RMS gap, per axis, of the point that two segments share, each frame weighted by the precision of its
/// poses. NaN below 8 frames with both poses.
[[nodiscard]] double shared_point_residual(const Samples& samples, const SegmentPoses& a,
                                           const SegmentPoses& b);

/// All pairs of segments that were seen together. A residual of a pair that hardly moves is small whatever
/// they are, so a tenth of the spread of their steadiest distance is added in quadrature.
[[nodiscard]] std::vector<Edge> find_edges(const Samples& samples, const std::vector<SegmentPoses>& poses,
                                           const std::vector<int>& segment, const PairSpread& pairs);

struct TreeEdge {
  Edge edge;
  double margin = 0.0;  ///< cost of the cheapest replacement over its own
};
/// Minimum spanning tree (Kruskal); several trees where pairs are missing.
[[nodiscard]] std::vector<TreeEdge> spanning_tree(std::vector<Edge> edges, int segments);

}  // namespace kinemark::skeleton::internal
