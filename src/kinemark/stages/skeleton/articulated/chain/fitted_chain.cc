// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace kinemark::skeleton::articulated {

Matrix3d FittedChain::joint_covariance(int j, bool in_parent) const {
  const int s = in_parent ? chain.layout.parent[j] : j + 1;
  const Vector3d p = in_parent ? Vector3d(chain.joint.col(j)) : Vector3d(Vector3d::Zero());
  std::vector<int> markers = chain.layout.markers_of(s);
  std::erase_if(markers, [&](int k) { return !(marker_weight[k] > 0.0); });  // their positions are not known
  const auto n = static_cast<double>(markers.size());
  Vector3d mean = Vector3d::Zero();
  for (const int k : markers) mean += chain.marker.col(k) / n;
  Matrix3d inertia = Matrix3d::Zero();
  for (const int k : markers) {
    const Vector3d d = chain.marker.col(k) - mean;
    inertia += d.squaredNorm() * Matrix3d::Identity() - d * d.transpose();
  }
  // Collinear markers do not show a rotation about their line.
  inertia.diagonal().array() += 1e-9 * inertia.trace() + 1e-300;
  const Matrix3d mobility = inertia.inverse();
  const auto& parameters = chain.geometry_parameters();
  Eigen::Matrix3Xd L = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    if (parameters[g].segment != s) continue;
    const Vector3d e = Vector3d::Unit(parameters[g].axis);
    if (parameters[g].marker < 0) {
      if (in_parent && parameters[g].joint == j) L.col(g) = e;
      continue;
    }
    if (!(marker_weight[parameters[g].marker] > 0.0)) continue;
    const Vector3d turn = mobility * (chain.marker.col(parameters[g].marker) - mean).cross(e);
    L.col(g) = -e / n - turn.cross(p - mean);
  }
  return L * geometry_covariance * L.transpose();
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
