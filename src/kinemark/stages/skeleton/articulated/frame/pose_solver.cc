// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/pose_solver.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/chain/small_cholesky.h"

namespace kinemark::skeleton::articulated {

namespace {

// A segment's markers determine its pose alone when their second extent exceeds the noise by this
// (chi-square).
constexpr double kWide = 50.0;
constexpr double kGrow =
    6.0;  // of the damping after a step that made things worse; twice as much after another

Matrix3d skew(const Vector3d& v) {
  Matrix3d S;
  S << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return S;
}

// Lower triangle of H at (row, column) += block; block rows and columns beyond the sizes are left out.
void add(Eigen::MatrixXd& H, int row, int rows, int column, int columns, const Matrix3d& block) {
  if (row < column) {
    for (int c = 0; c < columns; ++c) {
      for (int r = 0; r < rows; ++r) H(column + c, row + r) += block(r, c);
    }
    return;
  }
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) H(row + r, column + c) += block(r, c);
  }
}

void add(Eigen::VectorXd& b, int row, int rows, const Vector3d& part) {
  for (int r = 0; r < rows; ++r) b[row + r] += part[r];
}

}  // namespace

PoseSolver::PoseSolver(const Chain& chain) : chain_(&chain) {
  const int n = chain.frame_parameters();
  sums_.segment.resize(chain.segments());
  H_.resize(n, n);
  factor_.resize(n, n);
  b_.resize(n);
  step_.resize(n);
  damping_.resize(n);
  origin_.resize(chain.segments());
  residual_.resize(chain.segments());
  lever_.resize(chain.joints());
  weight_beyond_.resize(chain.joints());
  residual_beyond_.resize(chain.joints());
  trial_.rotation.resize(chain.segments());
  by_frame_.resize(3, n);
  by_geometry_.resize(3, static_cast<Eigen::Index>(chain.geometry_parameters().size()));
}

void PoseSolver::set(const double* x, std::span<const double> weights) {
  const Chain& c = *chain_;
  for (FrameSums::Segment& s : sums_.segment) s = {};
  sums_.centre.setZero();
  sums_.seen = 0;
  const auto used = [&](int k) { return !std::isnan(x[3 * k]) && (weights.empty() || weights[k] > 0.0); };
  for (int k = 0; k < c.markers(); ++k) {
    if (!used(k)) continue;
    sums_.centre += Eigen::Map<const Vector3d>(x + 3 * k);
    ++sums_.seen;
  }
  if (sums_.seen > 0) sums_.centre /= sums_.seen;
  for (int k = 0; k < c.markers(); ++k) {
    if (!used(k)) continue;
    const double w = weights.empty() ? 1.0 : weights[k];
    FrameSums::Segment& s = sums_.segment[c.layout.segment_of_marker[k]];
    const Vector3d y = Eigen::Map<const Vector3d>(x + 3 * k) - sums_.centre;
    const Vector3d m = c.marker.col(k);
    s.w += w;
    s.m += w * m;
    s.x += w * y;
    s.mm += w * m * m.transpose();
    s.xm += w * y * m.transpose();
    s.xx += w * y.squaredNorm();
    ++s.seen;
  }
}

bool PoseSolver::shows_pose(int segment, double sigma_m) const {
  const FrameSums::Segment& s = sums_.segment[segment];
  if (chain_->kind[segment] == data::SegmentKind::line) return s.seen >= 2;
  if (s.seen < 3) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> spread(s.mm - s.m * s.m.transpose() / s.w,
                                                       Eigen::EigenvaluesOnly);
  return spread.eigenvalues()[1] > kWide * sigma_m * sigma_m;
}

bool PoseSolver::shows_all_joints(double sigma_m) const {
  for (int j = 0; j < chain_->joints(); ++j)
    if (!shows_pose(chain_->layout.parent[j], sigma_m) && !shows_pose(j + 1, sigma_m)) return false;
  return true;
}

double PoseSolver::cost(const ChainPose& pose, std::span<const JointPrior> priors) {
  double total = 0.0;
  for (int q = 0; q < chain_->segments(); ++q) {
    const FrameSums::Segment& s = sums_.segment[q];
    if (s.seen == 0) continue;
    const Vector3d o = chain_->origin(pose, q) - sums_.centre;
    const Matrix3d& R = pose.rotation[q];
    total += s.xx + s.mm.trace() + s.w * o.squaredNorm() - 2.0 * o.dot(s.x) -
             2.0 * R.cwiseProduct(s.xm).sum() + 2.0 * o.dot(R * s.m);
  }
  for (const JointPrior& prior : priors) {
    const Vector3d off = chain_->joint_centre(pose, prior.joint) - prior.target;
    total += off.dot(prior.weight * off);
  }
  return std::max(total, 0.0);
}

void PoseSolver::add_priors(const ChainPose& pose, std::span<const JointPrior> priors) {
  for (const JointPrior& prior : priors) {
    joint_jacobian(pose, prior.joint, by_frame_, by_geometry_);
    const Vector3d off = prior.target - chain_->joint_centre(pose, prior.joint);
    H_.noalias() += by_frame_.transpose() * (prior.weight * by_frame_);
    b_.noalias() += by_frame_.transpose() * (prior.weight * off);
  }
}

void PoseSolver::normal(const ChainPose& pose, std::span<const JointPrior> priors, bool observed,
                        Eigen::MatrixXd& H, Eigen::VectorXd& b) {
  const Chain& c = *chain_;
  H_.setZero();
  b_.setZero();
  for (int j = 0; j < c.joints(); ++j) {
    lever_[j] = skew(c.joint.col(j)) * pose.rotation[c.layout.parent[j]].transpose();
    weight_beyond_[j] = 0.0;
    residual_beyond_[j].setZero();
  }
  for (int q = 0; q < c.segments(); ++q) {
    const FrameSums::Segment& s = sums_.segment[q];
    if (s.seen == 0) continue;
    const Matrix3d& R = pose.rotation[q];
    const Vector3d o = c.origin(pose, q) - sums_.centre;
    const int at = c.rotation_offset(q);
    const int size = c.rotation_size(q);
    const Vector3d residual = s.x - s.w * o - R * s.m;
    add(b_, 0, 3, residual);
    for (int i = 0; i < 3; ++i) H_(i, i) += s.w;
    // x moves by -R [m] eta with the segment's own rotation eta,
    const Matrix3d own = skew(s.m);
    add(H_, at, size, 0, 3, own * R.transpose());
    add(H_, at, size, at, size, s.mm.trace() * Matrix3d::Identity() - s.mm);
    const Matrix3d B = R.transpose() * (s.xm - o * s.m.transpose());
    add(b_, at, size, {B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1)});
    if (observed && size == 2) {
      const double more = B(2, 2) - s.mm(2, 2);
      H_(at, at) += more;
      H_(at + 1, at + 1) += more;
    }
    // and by -R_i [l] eta_i with the rotation of every segment i between joint 0 and this one.
    const Matrix3d turned = own * R.transpose();
    for (const int j : c.joints_to(q)) {
      const int i = c.layout.parent[j];
      add(H_, at, size, c.rotation_offset(i), c.rotation_size(i), turned * lever_[j].transpose());
      weight_beyond_[j] += s.w;
      residual_beyond_[j] += residual;
    }
  }
  // All segments beyond a joint move with the same lever.
  for (int j = 1; j < c.joints(); ++j) {
    if (!(weight_beyond_[j] > 0.0)) continue;
    const int i = c.layout.parent[j];
    const int at = c.rotation_offset(i);
    const int size = c.rotation_size(i);
    const Vector3d v = c.joint.col(j);
    const Vector3d in_segment = pose.rotation[i].transpose() * residual_beyond_[j];
    const Matrix3d weighed = weight_beyond_[j] * lever_[j];
    add(b_, at, size, v.cross(in_segment));
    add(H_, at, size, 0, 3, weighed);
    for (const int j2 : c.joints_to(j + 1)) {
      const int i2 = c.layout.parent[j2];
      add(H_, at, size, c.rotation_offset(i2), c.rotation_size(i2), weighed * lever_[j2].transpose());
    }
    if (observed && size == 2) {
      const double more = v[2] * in_segment[2];
      H_(at, at) += more;
      H_(at + 1, at + 1) += more;
    }
  }
  const Eigen::Index n = H_.rows();
  for (Eigen::Index col = 0; col < n; ++col) {
    for (Eigen::Index row = col + 1; row < n; ++row) H_(col, row) = H_(row, col);
  }
  add_priors(pose, priors);
  if (&H != &H_) {
    H = H_;
    b = b_;
  }
}

double PoseSolver::refine(ChainPose& pose, std::span<const JointPrior> priors, int iterations,
                          double tolerance) {
  const Chain& c = *chain_;
  const int n = c.frame_parameters();
  double weight = 0.0;
  for (const FrameSums::Segment& s : sums_.segment) weight += s.w;
  const double length = c.scale();
  double best = cost(pose, priors);
  double lambda = 1e-3, grow = kGrow;
  bool fresh = true;
  for (int round = 0; round < iterations; ++round) {
    if (fresh) {
      normal(pose, priors, false, H_, b_);
      // A rotation that no marker determines is held by a small share of what one would add.
      double largest = 0.0;
      for (int i = 3; i < n; ++i) largest = std::max(largest, H_(i, i));
      largest = std::max(largest, 1e-6 * length * length);
      for (int i = 0; i < n; ++i) {
        damping_[i] = i < 3 ? std::min(H_(i, i), weight + 1e-12) : H_(i, i) + 1e-6 * largest;
      }
    }
    factor_ = H_;
    for (int i = 0; i < n; ++i) {
      factor_(i, i) += lambda * damping_[i] + (i < 3 ? 1e-13 * weight + 1e-300 : 1e-12 * damping_[i]);
    }
    if (!cholesky_from_leaves(factor_, rows_)) {
      fresh = false;
      lambda = std::max(6.0 * lambda, 1e-8);
      if (lambda > 1e7) break;
      continue;
    }
    step_ = b_;
    solve_from_leaves(factor_, step_);
    solve_to_leaves(factor_, step_);
    double big = 0.0;
    for (int i = 3; i < n; ++i) big = std::max(big, std::abs(step_[i]));
    const double expected = step_.dot(b_) + lambda * step_.cwiseAbs2().dot(damping_);
    if (big > 1.5) step_ *= 1.5 / big;
    trial_.joint0 = pose.joint0;
    trial_.rotation = pose.rotation;
    move_pose(c, step_, trial_);
    const double value = cost(trial_, priors);
    fresh = value <= best;
    if (fresh) {
      const double gain = best - value;
      std::swap(pose.joint0, trial_.joint0);
      pose.rotation.swap(trial_.rotation);
      best = value;
      // As far as the quadratic was right (Nielsen 1999, Technical University of Denmark IMM-REP-1999-05).
      lambda *= std::max(1.0 / 8.0, 1.0 - std::pow(2.0 * gain / std::max(expected, gain) - 1.0, 3));
      lambda = std::max(lambda, 1e-9);
      grow = kGrow;
      // Costs are differences of sums of the order of the squared coordinates: below their rounding there is
      // nothing to gain.
      if (gain <= tolerance * best + 1e-16 * length * length * weight) break;
    } else {
      lambda *= grow;
      grow *= 2.0;
      if (lambda > 1e7) break;
    }
  }
  return best;
}

void PoseSolver::linearize_geometry(const ChainPose& pose, const double* x, std::span<const double> weights,
                                    Eigen::MatrixXd& G, Eigen::MatrixXd* Hgg, Eigen::VectorXd* bg) const {
  const Chain& c = *chain_;
  const auto& all = c.geometry_parameters();
  G.setZero(c.frame_parameters(), static_cast<Eigen::Index>(all.size()));
  // Parameters come marker by marker, then joint by joint: find where each begins.
  std::size_t first_joint = 0;
  while (first_joint < all.size() && all[first_joint].marker >= 0) ++first_joint;
  std::size_t own = 0;
  for (int k = 0; k < c.markers(); ++k) {
    const std::size_t begin = own;
    while (own < first_joint && all[own].marker == k) ++own;
    const double w = weights.empty() ? 1.0 : weights[k];
    if (std::isnan(x[3 * k]) || w <= 0.0) continue;
    const int q = c.layout.segment_of_marker[k];
    const Matrix3d& R = pose.rotation[q];
    const Vector3d m = c.marker.col(k);
    const Vector3d residual = Eigen::Map<const Vector3d>(x + 3 * k) - c.origin(pose, q) - R * m;
    const auto couple = [&](std::size_t g, const Vector3d& d) {
      // d: derivative of this marker's position by parameter g.
      G.block<3, 1>(0, g) += w * d;
      const Vector3d by_rotation = m.cross(R.transpose() * d);
      for (int r = 0; r < c.rotation_size(q); ++r) G(c.rotation_offset(q) + r, g) += w * by_rotation[r];
      for (const int j : c.joints_to(q)) {
        const int i = c.layout.parent[j];
        const Vector3d lever = Vector3d(c.joint.col(j)).cross(pose.rotation[i].transpose() * d);
        for (int r = 0; r < c.rotation_size(i); ++r) G(c.rotation_offset(i) + r, g) += w * lever[r];
      }
      if (bg != nullptr) (*bg)[g] += w * d.dot(residual);
    };
    for (std::size_t g = begin; g < own; ++g) {
      couple(g, R.col(all[g].axis));
      if (Hgg != nullptr) (*Hgg)(g, g) += w;
    }
    if (c.joints_to(q).empty()) continue;
    for (std::size_t g = first_joint; g < all.size(); ++g) {
      if (std::find(c.joints_to(q).begin(), c.joints_to(q).end(), all[g].joint) == c.joints_to(q).end())
        continue;
      const Vector3d d = pose.rotation[all[g].segment].col(all[g].axis);
      couple(g, d);
      if (Hgg == nullptr) continue;
      for (std::size_t h = begin; h < own; ++h) {
        const double value = w * d.dot(R.col(all[h].axis));
        (*Hgg)(g, h) += value;
        (*Hgg)(h, g) += value;
      }
      for (std::size_t h = first_joint; h < all.size(); ++h) {
        if (std::find(c.joints_to(q).begin(), c.joints_to(q).end(), all[h].joint) == c.joints_to(q).end())
          continue;
        (*Hgg)(g, h) += w * d.dot(pose.rotation[all[h].segment].col(all[h].axis));
      }
    }
  }
}

void PoseSolver::joint_jacobian(const ChainPose& pose, int j, Eigen::Matrix3Xd& by_frame,
                                Eigen::Matrix3Xd& by_geometry) const {
  const Chain& c = *chain_;
  by_frame.setZero(3, c.frame_parameters());
  by_geometry.setZero(3, static_cast<Eigen::Index>(c.geometry_parameters().size()));
  by_frame.leftCols<3>().setIdentity();
  for (const int step : c.joints_to(j + 1)) {
    const int i = c.layout.parent[step];
    const Matrix3d by_rotation = -pose.rotation[i] * skew(c.joint.col(step));
    by_frame.middleCols(c.rotation_offset(i), c.rotation_size(i)) = by_rotation.leftCols(c.rotation_size(i));
    for (std::size_t g = 0; g < c.geometry_parameters().size(); ++g) {
      if (c.geometry_parameters()[g].joint == step)
        by_geometry.col(g) = pose.rotation[i].col(c.geometry_parameters()[g].axis);
    }
  }
}

}  // namespace kinemark::skeleton::articulated
