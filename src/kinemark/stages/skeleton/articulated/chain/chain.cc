// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/math/euler.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::SegmentKind;

// Local axes whose coordinates are free.
std::vector<int> free_axes(SegmentKind kind) {
  switch (kind) {
    case SegmentKind::line:
      return {2};
    case SegmentKind::plane:
      return {0, 2};
    case SegmentKind::solid:
      break;
  }
  return {0, 1, 2};
}

}  // namespace

std::vector<int> ChainLayout::markers_of(int segment) const {
  std::vector<int> found;
  for (int k = 0; k < markers(); ++k) {
    if (segment_of_marker[k] == segment) found.push_back(k);
  }
  return found;
}

Chain::Chain(ChainLayout layout_in, std::vector<SegmentKind> kind_in)
    : layout(std::move(layout_in)), kind(std::move(kind_in)) {
  check(!layout.parent.empty() && layout.parent[0] == 0,
        "a chain needs a joint, and joint 0 is on segment 0");
  check(static_cast<int>(kind.size()) == layout.segments(), "one kind a segment");
  for (int j = 0; j < layout.joints(); ++j)
    check(layout.parent[j] >= 0 && layout.parent[j] <= j, "parents first");
  for (const int s : layout.segment_of_marker) check(s >= 0 && s < layout.segments(), "segment out of range");
  marker = Eigen::Matrix3Xd::Zero(3, layout.markers());
  joint = Eigen::Matrix3Xd::Zero(3, layout.joints());
  frame_parameters_ = 3;
  joints_to_.resize(layout.segments());
  for (int s = 0; s < layout.segments(); ++s) {
    rotation_offset_.push_back(frame_parameters_);
    frame_parameters_ += rotation_size(s);
    if (s > 0) {
      joints_to_[s] = joints_to_[layout.parent[s - 1]];
      if (s > 1) joints_to_[s].push_back(s - 1);
    }
  }
  for (int k = 0; k < layout.markers(); ++k) {
    const int s = layout.segment_of_marker[k];
    for (const int axis : free_axes(kind[s])) geometry_parameters_.push_back({k, -1, axis, s});
  }
  for (int j = 1; j < layout.joints(); ++j) {
    const int s = layout.parent[j];
    for (const int axis : free_axes(kind[s])) geometry_parameters_.push_back({-1, j, axis, s});
  }
}

void Chain::move_geometry(const Eigen::VectorXd& step) {
  for (std::size_t g = 0; g < geometry_parameters_.size(); ++g) {
    const GeometryParameter& what = geometry_parameters_[g];
    (what.marker >= 0 ? marker(what.axis, what.marker) : joint(what.axis, what.joint)) += step[g];
  }
}

Eigen::MatrixXd Chain::gauge() const {
  std::vector<Eigen::VectorXd> columns;
  for (int s = 0; s < segments(); ++s) {
    if (kind[s] == SegmentKind::line) continue;
    for (int about = 0; about < 3; ++about) {
      if (kind[s] == SegmentKind::plane && about != 1) continue;
      Eigen::VectorXd change = Eigen::VectorXd::Zero(geometry_parameters_.size());
      for (std::size_t g = 0; g < geometry_parameters_.size(); ++g) {
        const GeometryParameter& what = geometry_parameters_[g];
        if (what.segment != s) continue;
        const Vector3d position = what.marker >= 0 ? marker.col(what.marker) : joint.col(what.joint);
        change[g] = Vector3d::Unit(about).cross(position)[what.axis];
      }
      for (const Eigen::VectorXd& other : columns) change -= other.dot(change) * other;
      // Points on a line through the origin have no third rotation.
      if (change.norm() > 1e-6 * scale()) columns.emplace_back(change.normalized());
    }
  }
  Eigen::MatrixXd basis(geometry_parameters_.size(), columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) basis.col(c) = columns[c];
  return basis;
}

Vector3d Chain::origin(const ChainPose& pose, int segment) const {
  Vector3d o = pose.joint0;
  for (const int j : joints_to_[segment]) o += pose.rotation[layout.parent[j]] * joint.col(j);
  return o;
}

Vector3d Chain::joint_centre(const ChainPose& pose, int j) const { return origin(pose, j + 1); }

Vector3d Chain::predict(const ChainPose& pose, int k) const {
  const int s = layout.segment_of_marker[k];
  return origin(pose, s) + pose.rotation[s] * marker.col(k);
}

double Chain::scale() const {
  return std::max(std::sqrt(marker.squaredNorm() / std::max<double>(1.0, static_cast<double>(marker.cols()))),
                  1e-9);
}

void make_canonical(Chain& chain) {
  for (int s = 0; s < chain.segments(); ++s) {
    if (chain.kind[s] == SegmentKind::solid) continue;
    std::vector<double*> points;
    for (int k = 0; k < chain.markers(); ++k) {
      if (chain.layout.segment_of_marker[k] == s) points.push_back(chain.marker.col(k).data());
    }
    for (int j = 1; j < chain.joints(); ++j) {
      if (chain.layout.parent[j] == s) points.push_back(chain.joint.col(j).data());
    }
    Matrix3d scatter = Matrix3d::Zero();
    for (double* point : points) {
      const Eigen::Map<Vector3d> p(point);
      scatter += p * p.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(scatter);
    Matrix3d own_from_old;
    own_from_old.row(2) = axes.eigenvectors().col(2).transpose();
    own_from_old.row(0) = axes.eigenvectors().col(1).transpose();
    own_from_old.row(1) = own_from_old.row(2).cross(own_from_old.row(0));
    for (double* point : points) {
      Eigen::Map<Vector3d> p(point);
      p = (own_from_old * p).eval();
      p.y() = 0.0;
      if (chain.kind[s] == SegmentKind::line) p.x() = 0.0;
    }
  }
}

void move_joint(Chain& chain, int joint, bool in_parent, const Vector3d& change) {
  if (in_parent && joint > 0) {
    chain.joint.col(joint) += change;
    return;
  }
  // The origin moves: everything else moves the other way.
  const int s = in_parent ? chain.layout.parent[joint] : joint + 1;
  for (const int k : chain.layout.markers_of(s)) chain.marker.col(k) -= change;
  for (int j = 1; j < chain.joints(); ++j) {
    if (chain.layout.parent[j] == s) chain.joint.col(j) -= change;
  }
}

Eigen::Matrix3Xd joint_by_geometry(const Chain& chain, int j, bool in_parent,
                                   std::span<const double> marker_weight) {
  const int s = in_parent ? chain.layout.parent[j] : j + 1;
  const Vector3d p = in_parent ? Vector3d(chain.joint.col(j)) : Vector3d(Vector3d::Zero());
  const auto holds = [&](int k) {
    return marker_weight.empty() || marker_weight[static_cast<std::size_t>(k)] > 0.0;
  };
  std::vector<int> markers = chain.layout.markers_of(s);
  std::erase_if(markers, [&](int k) { return !holds(k); });  // their positions are not known
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
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    if (parameters[g].segment != s) continue;
    const Vector3d e = Vector3d::Unit(parameters[g].axis);
    auto column = out.col(static_cast<Eigen::Index>(g));
    if (parameters[g].marker < 0) {
      if (in_parent && parameters[g].joint == j) column = e;
    } else if (holds(parameters[g].marker)) {
      const Vector3d rotation = mobility * (chain.marker.col(parameters[g].marker) - mean).cross(e);
      column = -e / n - rotation.cross(p - mean);
    }
  }
  return out;
}

void move_pose(const Chain& chain, const Eigen::VectorXd& step, ChainPose& pose) {
  pose.joint0 += step.head<3>();
  for (int s = 0; s < chain.segments(); ++s) {
    const double* rotation = step.data() + chain.rotation_offset(s);
    pose.rotation[s] *=
        math::exp_so3({rotation[0], rotation[1], chain.rotation_size(s) == 3 ? rotation[2] : 0.0});
  }
}

Matrix3d nearest_rotation(const Matrix3d& A) {
  Eigen::Matrix4d N;
  N(0, 0) = A(0, 0) + A(1, 1) + A(2, 2);
  N(1, 1) = A(0, 0) - A(1, 1) - A(2, 2);
  N(2, 2) = A(1, 1) - A(0, 0) - A(2, 2);
  N(3, 3) = A(2, 2) - A(0, 0) - A(1, 1);
  N(0, 1) = N(1, 0) = A(2, 1) - A(1, 2);
  N(0, 2) = N(2, 0) = A(0, 2) - A(2, 0);
  N(0, 3) = N(3, 0) = A(1, 0) - A(0, 1);
  N(1, 2) = N(2, 1) = A(0, 1) + A(1, 0);
  N(1, 3) = N(3, 1) = A(0, 2) + A(2, 0);
  N(2, 3) = N(3, 2) = A(1, 2) + A(2, 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(N);
  const Eigen::Vector4d q = eigen.eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace kinemark::skeleton::articulated
