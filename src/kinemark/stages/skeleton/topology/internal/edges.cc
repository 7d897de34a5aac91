// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/edges.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinemark/core/missing.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/sphere.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr double kArm_m = 0.1;  ///< from the markers to a joint, about
constexpr double kRidge = 1e-6;
constexpr std::size_t kLeastFrames = 8, kMostFrames = 600;
constexpr double kSteadyShare = 0.1;

int find_root(const std::vector<int>& root, int s) {
  while (root[static_cast<std::size_t>(s)] != s) s = root[static_cast<std::size_t>(s)];
  return s;
}

/// SD of the steadiest distance between markers of two segments; NaN when no pair was seen together.
double steadiest(const std::vector<int>& segment, const PairSpread& pairs, int a, int b) {
  double least = kNaN;
  for (std::size_t i = 0; i < segment.size(); ++i)
    for (std::size_t j = 0; j < segment.size(); ++j) {
      if (segment[i] != a || segment[j] != b) continue;
      const double v = pairs.variance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (!std::isnan(v) && !(v >= least)) least = v;
    }
  return std::sqrt(least);
}

/// Frames with both poses, evenly thinned.
std::vector<std::int64_t> common_frames(const SegmentPoses& a, const SegmentPoses& b) {
  std::vector<std::int64_t> all, frames;
  for (std::size_t f = 0; f < a.known.size(); ++f)
    if (a.known[f] && b.known[f]) all.push_back(static_cast<std::int64_t>(f));
  const std::size_t n = std::min(all.size(), kMostFrames);
  for (std::size_t i = 0; i < n; ++i) frames.push_back(all[i * all.size() / n]);
  return frames;
}

/// Variance that noise gives a point at a usual distance from the markers, m^2. It does not depend on the
/// point itself: otherwise a distant point would seem to fit well because it is uncertain.
double spread_at_arm(const Samples& samples, const SegmentPoses& poses, std::int64_t frame) {
  const PoseNoise noise = pose_noise(samples, poses, frame);
  return 3.0 * noise.mean_variance + 2.0 / 3.0 * kArm_m * kArm_m * noise.rotation_covariance.trace() + 1e-12;
}

/// Of a segment without poses that moves about a point held still by one with poses.
double sphere_residual(const Samples& samples, const SegmentPoses& a, const SegmentPoses& b) {
  const bool a_still = a.known_frames > 0;
  if (!a_still && b.known_frames == 0) return kNaN;
  const SphereFit fit = a_still ? fit_spheres(samples, a, b.markers) : fit_spheres(samples, b, a.markers);
  return fit.found && fit.frames >= static_cast<std::int64_t>(kLeastFrames) ? fit.residual_rms_m : kNaN;
}

}  // namespace

double shared_point_residual(const Samples& samples, const SegmentPoses& a, const SegmentPoses& b) {
  const std::vector<std::int64_t> frames = common_frames(a, b);
  if (frames.size() < kLeastFrames) return kNaN;
  ScoreSums sums;
  double total = 0.0;
  for (const std::int64_t f : frames) {
    const double weight = 1.0 / (spread_at_arm(samples, a, f) + spread_at_arm(samples, b, f));
    sums.add(a, b, f, weight * Eigen::Matrix3d::Identity());
    total += weight;
  }
  Matrix6 normal = sums.normal;
  normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff();
  return std::sqrt(sums.cost(normal.ldlt().solve(sums.right)) / (3.0 * total));
}

std::vector<Edge> find_edges(const Samples& samples, const std::vector<SegmentPoses>& poses,
                             const std::vector<int>& segment, const PairSpread& pairs) {
  std::vector<Edge> edges;
  for (int a = 0; a < static_cast<int>(poses.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(poses.size()); ++b) {
      const double steady = steadiest(segment, pairs, a, b);
      if (std::isnan(steady)) continue;
      const SegmentPoses& pa = poses[static_cast<std::size_t>(a)];
      const SegmentPoses& pb = poses[static_cast<std::size_t>(b)];
      Edge edge{.a = a, .b = b, .residual_m = kNaN, .cost_m = steady};
      edge.residual_m = pa.known_frames > 0 && pb.known_frames > 0 ? shared_point_residual(samples, pa, pb)
                                                                   : sphere_residual(samples, pa, pb);
      if (!std::isnan(edge.residual_m)) edge.cost_m = std::hypot(edge.residual_m, kSteadyShare * steady);
      edges.push_back(edge);
    }
  return edges;
}

std::vector<TreeEdge> spanning_tree(std::vector<Edge> edges, int segments) {
  std::ranges::stable_sort(edges, {}, &Edge::cost_m);
  std::vector<int> all(static_cast<std::size_t>(segments));
  std::iota(all.begin(), all.end(), 0);
  std::vector<int> root = all;
  const auto join = [](std::vector<int>& roots, const Edge& e) {
    const int a = find_root(roots, e.a), b = find_root(roots, e.b);
    roots[static_cast<std::size_t>(a)] = b;
    return a != b;
  };
  std::vector<TreeEdge> tree;
  for (const Edge& e : edges)
    if (join(root, e)) tree.push_back({e, std::numeric_limits<double>::infinity()});
  for (TreeEdge& t : tree) {
    std::vector<int> parts = all;
    for (const TreeEdge& other : tree)
      if (&other != &t) join(parts, other.edge);
    for (const Edge& e : edges) {
      if ((e.a == t.edge.a && e.b == t.edge.b) || find_root(parts, e.a) == find_root(parts, e.b)) continue;
      t.margin = e.cost_m / std::max(t.edge.cost_m, 1e-9);
      break;
    }
  }
  return tree;
}

}  // namespace kinemark::skeleton::internal
