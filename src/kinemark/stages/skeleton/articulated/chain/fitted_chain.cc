// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"

#include <algorithm>
#include <cmath>

namespace kinemark::skeleton::articulated {

Matrix3d FittedChain::joint_covariance(int j, bool in_parent) const {
  const Eigen::Matrix3Xd by_geometry = joint_by_geometry(chain, j, in_parent, marker_weight);
  return by_geometry * geometry_covariance * by_geometry.transpose();
}

std::vector<FittedChain::Length> FittedChain::lengths() const {
  std::vector<Length> out;
  for (int s = 0; s < chain.segments(); ++s) {
    std::vector<int> joints;
    if (s > 0) joints.push_back(s - 1);
    for (int j = 0; j < chain.joints(); ++j) {
      if (chain.layout.parent[j] == s) joints.push_back(j);
    }
    for (std::size_t a = 0; a < joints.size(); ++a) {
      for (std::size_t b = a + 1; b < joints.size(); ++b) {
        // The segment's upper joint (segment 0: joint 0) is its origin.
        const auto position = [&](int j) {
          return j == s - 1 ? Vector3d(Vector3d::Zero()) : Vector3d(chain.joint.col(j));
        };
        const Vector3d direction = position(joints[b]) - position(joints[a]);
        const double length = direction.norm();
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(chain.geometry_parameters().size());
        for (std::size_t g = 0; g < chain.geometry_parameters().size(); ++g) {
          const Chain::GeometryParameter& what = chain.geometry_parameters()[g];
          if (what.joint < 0 || what.segment != s) continue;
          const double sign = what.joint == joints[b] ? 1.0 : what.joint == joints[a] ? -1.0 : 0.0;
          gradient[g] = sign * direction[what.axis] / std::max(length, 1e-12);
        }
        const double variance = gradient.dot(geometry_covariance * gradient);
        out.push_back({joints[a], joints[b], s, length, std::sqrt(std::max(variance, 0.0)),
                       direction / std::max(length, 1e-12)});
      }
    }
  }
  return out;
}

}  // namespace kinemark::skeleton::articulated
