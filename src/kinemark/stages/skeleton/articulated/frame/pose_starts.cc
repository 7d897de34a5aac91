// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/pose_starts.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/math/euler.h"

namespace kinemark::skeleton::articulated {

namespace {

constexpr double kLeastHeight = 0.005;  // m: the two sides of a plane must differ for a start on each

// A rotation whose z axis is d.
Matrix3d rotation_with_z(const Vector3d& d) {
  const Vector3d z = d.norm() > 0.0 ? Vector3d(d.normalized()) : Vector3d::UnitZ();
  const Vector3d x = z.unitOrthogonal();
  Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

}  // namespace

PoseStarts::PoseStarts(const Chain& chain)
    : chain_(&chain), done_(chain.segments()), wanted_(chain.segments()), origin_(chain.segments()) {}

ChainPose& PoseStarts::next() {
  if (count_ == static_cast<int>(poses_.size())) poses_.emplace_back();
  ChainPose& pose = poses_[count_++];
  pose.rotation.resize(chain_->segments());
  std::fill(done_.begin(), done_.end(), char{0});
  return pose;
}

Matrix3d PoseStarts::rotation_about(const PoseSolver& solver, int segment, const Vector3d& point,
                                    const Vector3d& position) const {
  const FrameSums::Segment& s = solver.sums().segment[segment];
  if (s.seen == 0) return Matrix3d::Identity();
  return nearest_rotation(s.xm - position * s.m.transpose() - s.x * point.transpose() +
                          s.w * position * point.transpose());
}

void PoseStarts::complete(const PoseSolver& solver, ChainPose& pose) {
  const Chain& c = *chain_;
  // Inwards first, from the segments that are placed to the root, then outwards.
  for (int s = c.segments() - 1; s > 0; --s) {
    const int p = c.layout.parent[s - 1];
    if (!done_[s] || done_[p]) continue;
    const Vector3d l = c.joint.col(s - 1);
    pose.rotation[p] = rotation_about(solver, p, l, origin_[s]);
    origin_[p] = origin_[s] - pose.rotation[p] * l;
    done_[p] = 1;
  }
  for (int s = 1; s < c.segments(); ++s) {
    if (done_[s]) continue;
    const int p = c.layout.parent[s - 1];
    origin_[s] = origin_[p] + pose.rotation[p] * c.joint.col(s - 1);
    pose.rotation[s] = rotation_about(solver, s, Vector3d::Zero(), origin_[s]);
    done_[s] = 1;
  }
  pose.joint0 = origin_[0] + solver.sums().centre;
}

const ChainPose& PoseStarts::find_rigid(const PoseSolver& solver) {
  int segment = 0;
  for (int s = 1; s < chain_->segments(); ++s)
    if (solver.sums().segment[s].seen > solver.sums().segment[segment].seen) segment = s;
  const FrameSums::Segment& s = solver.sums().segment[segment];
  const Vector3d mean_x = s.x / s.w;
  count_ = 0;
  ChainPose& pose = next();
  pose.rotation[segment] = nearest_rotation(s.xm - mean_x * s.m.transpose());
  origin_[segment] = mean_x - pose.rotation[segment] * s.m / s.w;
  done_[segment] = 1;
  complete(solver, pose);
  return pose;
}

void PoseStarts::anchor(const PoseSolver& solver, int segment) {
  const FrameSums::Segment& s = solver.sums().segment[segment];
  if (s.seen < 2) return;
  const Vector3d mean_x = s.x / s.w;
  const Vector3d mean_m = s.m / s.w;
  const Matrix3d R = nearest_rotation(s.xm - mean_x * s.m.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> spread_of_markers(s.mm - s.m * mean_m.transpose());
  const Vector3d axis = spread_of_markers.eigenvectors().col(2);
  // Two markers leave the rotation about their line open. Between two segments the distances to the joint
  // determine it; in a longer chain they may not.
  const bool open = s.seen == 2 && chain_->joints() > 1;
  const int rotations = open ? 4 : 2;
  for (int i = 0; i < rotations; ++i) {
    ChainPose& pose = next();
    pose.rotation[segment] = R * math::exp_so3(2.0 * std::numbers::pi * i / rotations * axis);
    origin_[segment] = mean_x - pose.rotation[segment] * mean_m;
    done_[segment] = 1;
    complete(solver, pose);
  }
}

void PoseStarts::trilaterate(const PoseSolver& solver, const double* x, int joint) {
  const Chain& c = *chain_;
  const int parent = c.layout.parent[joint];
  const int child = joint + 1;
  // |x_k - J|^2 = d_k^2: differences from the mean are linear in J within the markers' plane.
  Vector3d mean = Vector3d::Zero();
  double mean_square = 0.0;
  double mean_d2 = 0.0;
  int n = 0;
  const auto each = [&](auto&& use) {
    for (int k = 0; k < c.markers(); ++k) {
      const int s = c.layout.segment_of_marker[k];
      if ((s != parent && s != child) || std::isnan(x[3 * k])) continue;
      const Vector3d arm =
          s == parent ? Vector3d(c.marker.col(k) - c.joint.col(joint)) : Vector3d(c.marker.col(k));
      use(Vector3d(Eigen::Map<const Vector3d>(x + 3 * k) - solver.sums().centre), arm.squaredNorm());
    }
  };
  double farthest = 0.0;
  each([&](const Vector3d& y, double d2) {
    mean += y;
    mean_d2 += d2;
    farthest = std::max(farthest, d2);
    ++n;
  });
  if (n < 2) return;
  mean /= n;
  mean_d2 /= n;
  each([&](const Vector3d& y, double) { mean_square += (y - mean).squaredNorm() / n; });
  Matrix3d scatter = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  each([&](const Vector3d& y, double d2) {
    const Vector3d q = y - mean;
    scatter += q * q.transpose();
    right += 0.5 * (q.squaredNorm() - mean_square - d2 + mean_d2) * q;
  });
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(scatter);
  const double limit = std::sqrt(farthest);
  Vector3d flat = Vector3d::Zero();
  for (int i = 1; i < 3; ++i) {
    if (eigen.eigenvalues()[i] < 1e-12) continue;
    const Vector3d axis = eigen.eigenvectors().col(i);
    flat += std::clamp(axis.dot(right) / eigen.eigenvalues()[i], -limit, limit) * axis;
  }
  double height2 = 0.0;
  each([&](const Vector3d& y, double d2) { height2 += (d2 - (y - mean - flat).squaredNorm()) / n; });
  const double height = std::max(std::sqrt(std::max(height2, 0.0)), kLeastHeight);
  for (const double side : {1.0, -1.0}) {
    ChainPose& pose = next();
    const Vector3d J = mean + flat + side * height * eigen.eigenvectors().col(0);
    pose.rotation[parent] = rotation_about(solver, parent, c.joint.col(joint), J);
    origin_[parent] = J - pose.rotation[parent] * c.joint.col(joint);
    pose.rotation[child] = rotation_about(solver, child, Vector3d::Zero(), J);
    origin_[child] = J;
    done_[parent] = done_[child] = 1;
    complete(solver, pose);
  }
}

void PoseStarts::two_lines(const PoseSolver& solver) {
  // With the joint eliminated the log likelihood is (alpha.u + beta.w + gamma u.w) / sigma^2: two von
  // Mises-Fisher factors, u ~ alpha + gamma w and w ~ beta + gamma u in turn.
  const FrameSums::Segment& a = solver.sums().segment[0];
  const FrameSums::Segment& b = solver.sums().segment[1];
  const double n = a.w + b.w;
  const Vector3d mean = (a.x + b.x) / n;
  const Vector3d alpha = a.xm.col(2) - a.m[2] * mean;
  const Vector3d beta = b.xm.col(2) - b.m[2] * mean;
  const double gamma = a.m[2] * b.m[2] / n;
  for (const bool other : {false, true}) {
    Vector3d u = other ? Vector3d(alpha + gamma * beta.normalized()) : alpha;
    u.normalize();
    Vector3d w = (beta + gamma * u).normalized();
    for (int round = 0; round < 3; ++round) {
      u = (alpha + gamma * w).normalized();
      w = (beta + gamma * u).normalized();
    }
    ChainPose& pose = next();
    pose.rotation[0] = rotation_with_z(u);
    pose.rotation[1] = rotation_with_z(w);
    pose.joint0 = solver.sums().centre + mean - (a.m[2] * u + b.m[2] * w) / n;
  }
}

void PoseStarts::find(const PoseSolver& solver, const double* x, double sigma_m) {
  const Chain& c = *chain_;
  count_ = 0;
  if (solver.sums().seen == 0) return;
  if (c.segments() == 2 && c.kind[0] == data::SegmentKind::line && c.kind[1] == data::SegmentKind::line) {
    two_lines(solver);
    return;
  }
  const auto open = [&](int joint) {
    return c.joints() == 1 ||
           (!solver.shows_pose(c.layout.parent[joint], sigma_m) && !solver.shows_pose(joint + 1, sigma_m));
  };
  std::fill(wanted_.begin(), wanted_.end(), char{0});
  int shown = -1;
  for (int s = 0; s < c.segments(); ++s) {
    const auto seen = [&](int segment) { return solver.sums().segment[segment].seen; };
    if (solver.shows_pose(s, sigma_m) && (shown < 0 || seen(s) > seen(shown))) shown = s;
  }
  if (shown >= 0) wanted_[shown] = 1;
  for (int j = 0; j < c.joints(); ++j)
    if (open(j)) wanted_[c.layout.parent[j]] = wanted_[j + 1] = 1;
  for (int s = 0; s < c.segments(); ++s)
    if (wanted_[s] != 0) anchor(solver, s);
  for (int j = 0; j < c.joints(); ++j)
    if (open(j)) trilaterate(solver, x, j);
  if (count_ > 0) return;
  // One marker in all, or one on each of two segments far apart: anything that is a pose.
  ChainPose& pose = next();
  for (int s = 0; s < c.segments(); ++s) {
    pose.rotation[s].setIdentity();
  }
  pose.joint0 = solver.sums().centre;
}

void PoseStarts::from_centres(const PoseSolver& solver, std::span<const Vector3d> centres, ChainPose& out) {
  const Chain& c = *chain_;
  out.rotation.resize(c.segments());
  const Vector3d middle = solver.sums().centre;
  for (int s = 0; s < c.segments(); ++s) {
    const FrameSums::Segment& sum = solver.sums().segment[s];
    const Vector3d o = centres[s == 0 ? 0 : s - 1] - middle;
    Matrix3d A = sum.xm - o * sum.m.transpose();
    // The segment's other joints weigh like a marker each.
    for (int j = 1; j < c.joints(); ++j) {
      if (c.layout.parent[j] == s) A += (centres[j] - middle - o) * c.joint.col(j).transpose();
    }
    out.rotation[s] = nearest_rotation(A);
  }
  out.joint0 = centres[0];
}

}  // namespace kinemark::skeleton::articulated
