// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/joint_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinemark::skeleton::articulated {

double reach_of(const Chain& chain, int joint) {
  double reach = 0.0;
  for (const bool in_parent : {true, false}) {
    const Vector3d at = in_parent ? Vector3d(chain.joint.col(joint)) : Vector3d(Vector3d::Zero());
    double nearest = std::numeric_limits<double>::infinity();
    for (const int k : chain.layout.markers_of(in_parent ? chain.layout.parent[joint] : joint + 1))
      if (const double d = (chain.marker.col(k) - at).norm(); d < nearest) nearest = d;
    reach = std::max(reach, nearest);
  }
  return reach;
}

double distance_change(const Chain& chain, const ChainSamples& samples, const PosedFrames& frames,
                       int joint) {
  double worst = 0.0;
  for (const int s : {chain.layout.parent[joint], joint + 1})
    for (const int k : chain.layout.markers_of(s)) {
      double n = 0.0, mean = 0.0, squares = 0.0;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!samples.seen(frames.frame[i], k)) continue;
        const Eigen::Map<const Vector3d> x(samples.frame(frames.frame[i]) + 3 * k);
        const double d = (x - chain.joint_centre(frames.pose[i], joint)).norm();
        n += 1.0;
        const double off = d - mean;
        mean += off / n;
        squares += off * (d - mean);
      }
      if (n < 2.0) continue;
      const double change = std::sqrt(squares / n);
      worst = std::max(worst, std::isfinite(change) ? change : std::numeric_limits<double>::infinity());
    }
  return worst;
}

}  // namespace kinemark::skeleton::articulated
