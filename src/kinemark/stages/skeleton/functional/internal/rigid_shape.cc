// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/rigid_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/missing.h"
#include "kinemark/math/rotation_fit.h"
#include "kinemark/math/statistics.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr std::int64_t kShapeFrames = 3000;  ///< more frames do not improve the shape
constexpr int kRounds = 60;
constexpr double kSettled_m = 1e-9;
/// Least share of the whole shape's inertia about a line that the visible markers must have.
constexpr double kInertiaShare = 1e-2;
constexpr double kOnLine = 1e-6;  ///< inertia about a line over that across it

double smallest_eigenvalue(const Eigen::Matrix3d& m) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0);
}

Eigen::Index at(std::size_t k) { return static_cast<Eigen::Index>(k); }

}  // namespace

Eigen::Matrix3d inertia(const Eigen::Matrix3d& scatter) {
  return scatter.trace() * Eigen::Matrix3d::Identity() - scatter;
}

RigidShape::RigidShape(const Samples& samples, const std::vector<int>& markers)
    : samples_(samples), markers_(markers), positions_(3, at(markers.size())) {
  positions_.setConstant(kNaN);
}

bool RigidShape::placed(std::size_t k) const { return !std::isnan(positions_(0, at(k))); }

int RigidShape::seen(std::int64_t frame) const {
  return static_cast<int>(std::ranges::count_if(markers_, [&](int m) { return samples_.seen(frame, m); }));
}

Eigen::Matrix3d RigidShape::scatter(std::int64_t frame) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int n = 0;
  for (const int m : markers_) {
    if (!samples_.seen(frame, m)) continue;
    mean += samples_.x(frame, m);
    ++n;
  }
  mean /= std::max(n, 1);
  for (const int m : markers_) {
    if (!samples_.seen(frame, m)) continue;
    const Eigen::Vector3d d = samples_.x(frame, m) - mean;
    squares += d * d.transpose();
  }
  return squares;
}

void RigidShape::start(std::int64_t frame) {
  for (std::size_t k = 0; k < markers_.size(); ++k)
    if (samples_.seen(frame, markers_[k])) positions_.col(at(k)) = samples_.x(frame, markers_[k]);
}

FramePose RigidShape::pose(std::int64_t frame) const {
  FramePose p;
  Eigen::Vector3d world = Eigen::Vector3d::Zero(), local = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    if (!placed(k) || !samples_.seen(frame, markers_[k])) continue;
    world += samples_.x(frame, markers_[k]);
    local += positions_.col(at(k));
    ++p.visible;
  }
  if (p.visible < 3) return p;
  world /= p.visible;
  local /= p.visible;
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero(), squares = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    if (!placed(k) || !samples_.seen(frame, markers_[k])) continue;
    const Eigen::Vector3d d = positions_.col(at(k)) - local;
    product += (samples_.x(frame, markers_[k]) - world) * d.transpose();
    squares += d * d.transpose();
  }
  p.least_inertia = smallest_eigenvalue(inertia(squares));
  p.rotation = math::fit_rotation(product).rotation;
  p.origin = world - p.rotation * local;
  for (std::size_t k = 0; k < markers_.size(); ++k)
    if (placed(k) && samples_.seen(frame, markers_[k]))
      p.squares +=
          (samples_.x(frame, markers_[k]) - p.rotation * positions_.col(at(k)) - p.origin).squaredNorm();
  return p;
}

RigidShape::Spread RigidShape::spread() const {
  Spread out;
  for (std::size_t k = 0; k < markers_.size(); ++k)
    if (placed(k)) {
      out.mean += positions_.col(at(k));
      ++out.placed;
    }
  out.mean /= std::max(out.placed, 1);
  for (std::size_t k = 0; k < markers_.size(); ++k)
    if (placed(k))
      out.squares += (positions_.col(at(k)) - out.mean) * (positions_.col(at(k)) - out.mean).transpose();
  return out;
}

double RigidShape::least_inertia() const {
  const Eigen::Matrix3d squares = spread().squares;
  const double least = smallest_eigenvalue(inertia(squares));
  return least > kOnLine * squares.trace() ? least : 0.0;
}

double RigidShape::improve(const std::vector<std::int64_t>& frames, bool trim) {
  const double least = kInertiaShare * least_inertia();
  std::vector<FramePose> poses;
  std::vector<std::int64_t> used;
  std::vector<double> mean_squares;
  for (const std::int64_t f : frames) {
    const FramePose p = pose(f);
    if (p.visible < 3 || p.least_inertia < least) continue;
    poses.push_back(p);
    used.push_back(f);
    mean_squares.push_back(p.squares / std::max(1, 3 * p.visible - 6));
  }
  double limit = std::numeric_limits<double>::infinity();
  if (trim && !mean_squares.empty()) {
    const double usual = math::upper_median(mean_squares);
    if (usual > 0.0) limit = 25.0 * usual;
  }
  Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, positions_.cols());
  std::vector<int> counts(markers_.size(), 0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (mean_squares[i] > limit) continue;
    for (std::size_t k = 0; k < markers_.size(); ++k) {
      if (!samples_.seen(used[i], markers_[k])) continue;
      sums.col(at(k)) += poses[i].rotation.transpose() * (samples_.x(used[i], markers_[k]) - poses[i].origin);
      ++counts[k];
    }
  }
  double change = 0.0;
  for (std::size_t k = 0; k < markers_.size(); ++k) {
    if (counts[k] == 0) continue;
    const Eigen::Vector3d now = sums.col(at(k)) / counts[k];
    change = std::max(change, placed(k) ? (now - positions_.col(at(k))).norm() : 1.0);
    positions_.col(at(k)) = now;
  }
  return change;
}

void RigidShape::rotate_into_axes() {
  const Spread of = spread();
  if (of.placed == 0) return;
  positions_.colwise() -= of.mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(of.squares);
  Eigen::Matrix3d axes;
  axes.col(2) = solver.eigenvectors().col(2);
  axes.col(0) = solver.eigenvectors().col(1);
  // A sign that depends on the markers alone: the first placed marker is not on the negative side.
  for (const int axis : {2, 0}) {
    for (std::size_t k = 0; k < markers_.size(); ++k) {
      if (!placed(k)) continue;
      if (axes.col(axis).dot(positions_.col(at(k))) < 0.0) axes.col(axis) *= -1.0;
      break;
    }
  }
  axes.col(1) = axes.col(2).cross(axes.col(0));
  positions_ = (axes.transpose() * positions_).eval();
}

std::vector<std::int64_t> RigidShape::draw_frames() const {
  std::vector<std::int64_t> good;
  for (std::int64_t f = 0; f < samples_.trajectories.frames(); ++f)
    if (seen(f) >= 3) good.push_back(f);
  const auto n = static_cast<std::int64_t>(good.size());
  if (n <= kShapeFrames) return good;
  std::vector<std::int64_t> drawn;
  for (std::int64_t i = 0; i < kShapeFrames; ++i)
    drawn.push_back(good[static_cast<std::size_t>(i * n / kShapeFrames)]);
  return drawn;
}

std::int64_t RigidShape::best_start(const std::vector<std::int64_t>& frames) const {
  std::int64_t best = frames.front();
  int most = 0;
  double largest = -1.0;
  for (const std::int64_t f : frames) {
    const int n = seen(f);
    if (n < most) continue;
    const double now = smallest_eigenvalue(inertia(scatter(f)));
    if (n == most && now <= largest) continue;
    most = n;
    largest = now;
    best = f;
  }
  return best;
}

bool RigidShape::find() {
  const auto drawn = draw_frames();
  if (drawn.empty()) return false;
  start(best_start(drawn));
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const double change = improve(drawn, round > 2);
    if (change < kSettled_m || (round > 8 && change > 0.98 * before && change < 1e-6)) break;
    before = change;
  }
  rotate_into_axes();
  return true;
}

}  // namespace kinemark::skeleton::internal
