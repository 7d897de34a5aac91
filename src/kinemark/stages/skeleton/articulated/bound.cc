// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/bound.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/skeleton/articulated/chain/joint_tree.h"

namespace kinemark::skeleton {
namespace {

using articulated::JointTree;
using data::SegmentKind;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kUnit_m = 0.1;  // lengths are measured in this, so that shifts and rotations weigh alike
constexpr double kRank = 1e-9;   // of a frame's information, relative: the truth carries no noise
constexpr double kHeld = 1e-4;   // part of a joint's shift that may lie in what a frame leaves open

/// Pseudo-inverse of a symmetric matrix, and the directions that it leaves out as columns.
struct PseudoInverse {
  MatrixXd inverse, open;
};

PseudoInverse invert(const MatrixXd& H, double relative) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(H);
  const VectorXd& w = eigen.eigenvalues();
  Eigen::Index left_out = 0;
  while (left_out < w.size() && w[left_out] <= relative * w[w.size() - 1]) ++left_out;
  const MatrixXd kept = eigen.eigenvectors().rightCols(w.size() - left_out);
  return {kept * w.tail(w.size() - left_out).cwiseInverse().asDiagonal() * kept.transpose(),
          eigen.eigenvectors().leftCols(left_out)};
}

/// Unknowns of a limb: those of a frame (position of joint 0, rotations) and those common to all frames.
class Limb {
 public:
  Limb(const data::Trajectories& markers, const data::SegmentLayout& layout,
       std::span<const SegmentKind> kinds, const LimbTruth& truth)
      : markers_(markers), layout_(layout), kinds_(kinds), truth_(truth), tree_(layout) {
    const int S = static_cast<int>(layout.segments.size()), J = static_cast<int>(layout.joints.size());
    frame_unknowns_ = 3;
    for (int s = 0; s < S; ++s) {
      rotation_.push_back(frame_unknowns_);
      frame_unknowns_ += kinds[at(s)] == SegmentKind::line ? 2 : 3;
    }
    marker_parameters_.assign(static_cast<std::size_t>(markers.markers()), -1);
    for (int s = 0; s < S; ++s)
      for (const int m : layout.segments[at(s)].markers) marker_parameters_[at(m)] = take(s);
    for (int j = 0; j < J; ++j) joint_parameters_.push_back(j == 0 ? -1 : take(tree_.holder[at(j)]));
  }

  [[nodiscard]] int frame_unknowns() const { return frame_unknowns_; }
  [[nodiscard]] int geometry_parameters() const { return geometry_parameters_; }

  /// Fix each segment's axes to its points: z towards the farthest from its origin, x towards the one
  /// farthest from that line.
  Status choose_axes() {
    for (int s = 0; s < static_cast<int>(layout_.segments.size()); ++s) {
      std::vector<int> points = points_of(s);
      double far = 0.0, wide = 0.0;
      Axes axes;
      for (const int p : points)
        if (const double d = from_origin(0, s, p).norm(); d > far) far = d, axes.along = p;
      const Vector3d z = from_origin(0, s, axes.along).normalized();
      for (const int p : points)
        if (const double d = from_origin(0, s, p).cross(z).norm(); d > wide) wide = d, axes.across = p;
      const bool flat = wide < 1e-9;
      if (far < 1e-9 || (flat && kinds_[at(s)] != SegmentKind::line))
        return fail(Code::bad_input,
                    fmt::format("segment '{}' has no two directions in the truth; a line was expected",
                                layout_.segments[at(s)].name));
      if (flat) axes.across = -1;
      axes_.push_back(axes);
    }
    return {};
  }

  /// Axes of a segment in the world; a line's x and y are any.
  [[nodiscard]] Matrix3d axes(std::int64_t frame, int segment) const {
    const Axes& a = axes_[at(segment)];
    Matrix3d R;
    R.col(2) = from_origin(frame, segment, a.along).normalized();
    const Vector3d other = a.across < 0 ? R.col(2).unitOrthogonal() : from_origin(frame, segment, a.across);
    R.col(0) = (other - R.col(2).dot(other) * R.col(2)).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    return R;
  }

  /// How a marker (joint < 0) or a joint moves with the unknowns: A of the frame, B of the geometry
  /// parameters.
  void jacobian(std::int64_t frame, int segment, int marker, int joint, const std::vector<Matrix3d>& R,
                MatrixXd& A, MatrixXd& B) const {
    A.setZero(3, frame_unknowns_);
    B.setZero(3, geometry_parameters_);
    A.leftCols<3>().setIdentity();
    if (joint < 0) {
      rotate(A, segment, R[at(segment)], from_origin(frame, segment, marker));
      shift(B, marker_parameters_[at(marker)], segment, R[at(segment)]);
      joint = tree_.origin[at(segment)];
    }
    for (; joint != 0; joint = tree_.origin[at(tree_.holder[at(joint)])]) {
      const int holder = tree_.holder[at(joint)];
      rotate(A, holder, R[at(holder)], from_origin(frame, holder, -1 - joint));
      shift(B, joint_parameters_[at(joint)], holder, R[at(holder)]);
    }
  }

  /// How far the truth's distances from a segment's origin change over the recording, m.
  [[nodiscard]] double looseness(std::int64_t frame, int segment) const {
    double worst = 0.0;
    for (const int p : points_of(segment))
      worst = std::max(worst,
                       std::abs(from_origin(frame, segment, p).norm() - from_origin(0, segment, p).norm()));
    return worst * kUnit_m;
  }

 private:
  struct Axes {
    int along = 0, across = -1;
  };

  int take(int segment) {
    const int first = geometry_parameters_;
    geometry_parameters_ += kinds_[at(segment)] == SegmentKind::line    ? 1
                            : kinds_[at(segment)] == SegmentKind::plane ? 2
                                                                        : 3;
    return first;
  }

  /// Markers (their index) and joints other than the origin (-1 - index) of a segment.
  [[nodiscard]] std::vector<int> points_of(int segment) const {
    std::vector<int> points = layout_.segments[at(segment)].markers;
    for (int j = 1; j < static_cast<int>(layout_.joints.size()); ++j)
      if (tree_.holder[at(j)] == segment) points.push_back(-1 - j);
    return points;
  }

  [[nodiscard]] Vector3d position(std::int64_t frame, int point) const {
    const double* x =
        point >= 0 ? truth_.x_in_world.data() + 3 * markers_.index(frame, point)
                   : truth_.centre_in_world.data() +
                         3 * (at(static_cast<int>(layout_.joints.size())) * static_cast<std::size_t>(frame) +
                              at(-1 - point));
    return Vector3d{x[0], x[1], x[2]} / kUnit_m;
  }

  [[nodiscard]] Vector3d from_origin(std::int64_t frame, int segment, int point) const {
    return position(frame, point) - position(frame, -1 - tree_.origin[at(segment)]);
  }

  void rotate(MatrixXd& A, int segment, const Matrix3d& R, const Vector3d& arm) const {
    const int n = kinds_[at(segment)] == SegmentKind::line ? 2 : 3;
    for (int i = 0; i < n; ++i) A.col(rotation_[at(segment)] + i) = R.col(i).cross(arm);
  }

  void shift(MatrixXd& B, int first, int segment, const Matrix3d& R) const {
    switch (kinds_[at(segment)]) {
      case SegmentKind::line:
        B.col(first) = R.col(2);
        break;
      case SegmentKind::plane:
        B.col(first) = R.col(0);
        B.col(first + 1) = R.col(2);
        break;
      case SegmentKind::solid:
        B.middleCols<3>(first) = R;
        break;
    }
  }

  const data::Trajectories& markers_;
  const data::SegmentLayout& layout_;
  std::span<const SegmentKind> kinds_;
  const LimbTruth& truth_;
  JointTree tree_;
  std::vector<int> rotation_, marker_parameters_, joint_parameters_;
  std::vector<Axes> axes_;
  int frame_unknowns_ = 0, geometry_parameters_ = 0;
};

/// One frame: inverse information of its own unknowns, and how they depend on the geometry parameters.
struct FrameBound {
  MatrixXd inverse, open, answer;
};

Status check_shapes(const data::Trajectories& markers, const data::SegmentLayout& layout,
                    std::span<const SegmentKind> kinds, const LimbTruth& truth, double noise_sd_m) {
  if (auto s = layout.validate(markers.markers()); !s) return s;
  const auto F = static_cast<std::size_t>(markers.frames());
  if (kinds.size() != layout.segments.size() ||
      truth.x_in_world.size() != 3 * F * static_cast<std::size_t>(markers.markers()) ||
      truth.centre_in_world.size() != 3 * F * layout.joints.size())
    return fail(Code::usage, "the truth and the kinds must have the recording's frames, markers and joints");
  if (layout.joints.empty() || F == 0) return fail(Code::usage, "a bound needs a joint and a frame");
  if (!(noise_sd_m > 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage, fmt::format("noise of {} m; need more than 0", noise_sd_m));
  return articulated::check_tree(layout);
}

}  // namespace

Result<CentreBound> calc_centre_bound(const data::Trajectories& markers, const data::SegmentLayout& layout,
                                      std::span<const SegmentKind> kinds, const LimbTruth& truth,
                                      double noise_sd_m) {
  if (auto s = check_shapes(markers, layout, kinds, truth, noise_sd_m); !s) return std::unexpected(s.error());
  Limb limb(markers, layout, kinds, truth);
  if (auto s = limb.choose_axes(); !s) return std::unexpected(s.error());
  const int J = static_cast<int>(layout.joints.size()), S = static_cast<int>(layout.segments.size());
  std::vector<FrameBound> frames(static_cast<std::size_t>(markers.frames()));
  std::vector<Matrix3d> R(layout.segments.size());
  MatrixXd information = MatrixXd::Zero(limb.geometry_parameters(), limb.geometry_parameters()), A, B;
  const auto rotate_axes = [&](std::int64_t f) {
    for (int s = 0; s < S; ++s) R[at(s)] = limb.axes(f, s);
  };
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    rotate_axes(f);
    MatrixXd H = MatrixXd::Zero(limb.frame_unknowns(), limb.frame_unknowns()),
             G = MatrixXd::Zero(limb.frame_unknowns(), limb.geometry_parameters());
    for (int s = 0; s < S; ++s) {
      if (limb.looseness(f, s) > 1e-6)
        return fail(Code::bad_input, fmt::format("segment '{}' is not rigid in the truth (frame {})",
                                                 layout.segments[at(s)].name, f));
      for (const int m : layout.segments[at(s)].markers) {
        if (!markers.present(f, m)) continue;
        limb.jacobian(f, s, m, -1, R, A, B);
        H.noalias() += A.transpose() * A;
        G.noalias() += A.transpose() * B;
        information.noalias() += B.transpose() * B;
      }
    }
    FrameBound& frame = frames[static_cast<std::size_t>(f)];
    if (H.isZero(0.0)) {
      frame.inverse = H;
      frame.open = MatrixXd::Identity(H.rows(), H.cols());
    } else {
      auto inverse = invert(H, kRank);
      frame.inverse = std::move(inverse.inverse);
      frame.open = std::move(inverse.open);
    }
    frame.answer = frame.inverse * G;
    information.noalias() -= G.transpose() * frame.answer;
  }
  const MatrixXd common = invert(information, 1e-9).inverse;

  CentreBound bound;
  const std::size_t n = frames.size() * at(J);
  bound.covariance.assign(6 * n, kNaN);
  bound.known_geometry.assign(6 * n, kNaN);
  bound.determined.assign(n, 0);
  const double noise2 = noise_sd_m * noise_sd_m;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    rotate_axes(f);
    const FrameBound& frame = frames[static_cast<std::size_t>(f)];
    for (int j = 0; j < J; ++j) {
      limb.jacobian(f, -1, -1, j, R, A, B);
      if (frame.open.cols() > 0 && (A * frame.open).cwiseAbs().maxCoeff() > kHeld) continue;
      const std::size_t k = static_cast<std::size_t>(f) * at(J) + at(j);
      const MatrixXd M = B - A * frame.answer;
      const Matrix3d own = A * frame.inverse * A.transpose(), shared = M * common * M.transpose();
      bound.determined[k] = 1;
      math::pack_symmetric3(noise2 * own, bound.known_geometry.data() + 6 * k);
      math::pack_symmetric3(noise2 * (own + shared), bound.covariance.data() + 6 * k);
    }
  }
  // A length is the difference of two joints of one segment; turning that segment does not change it.
  rotate_axes(0);
  MatrixXd A2, B2;
  for (const auto& [a, b] : articulated::joint_pairs(layout)) {
    const double* x = truth.centre_in_world.data();
    const Vector3d along =
        (Eigen::Map<const Vector3d>(x + 3 * b) - Eigen::Map<const Vector3d>(x + 3 * a)).normalized();
    limb.jacobian(0, -1, -1, a, R, A, B);
    limb.jacobian(0, -1, -1, b, R, A2, B2);
    const VectorXd slope = (B2 - B).transpose() * along;
    bound.length_joint_a.push_back(a);
    bound.length_joint_b.push_back(b);
    bound.length_sd_m.push_back(noise_sd_m * std::sqrt(slope.dot(common * slope)));
  }
  return bound;
}

}  // namespace kinemark::skeleton
