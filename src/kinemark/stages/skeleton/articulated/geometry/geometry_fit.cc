// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/data/joint_choice.h"
#include "kinemark/stages/skeleton/articulated/chain/robust_weights.h"
#include "kinemark/stages/skeleton/articulated/chain/small_cholesky.h"
#include "kinemark/stages/skeleton/articulated/frame/modes.h"

namespace kinemark::skeleton::articulated {

namespace {

constexpr double kUnknownPosition = 1.0;  // m, SD of a parameter that no frame shows
constexpr double kDifference = 1e-5;      // m, for derivatives of log det H
constexpr double kPoseTolerance = 1e-9;   // of a frame's cost, of its pose's last step
constexpr std::int64_t kChunk = 64;       // frames that one thread takes at a time
constexpr double kGrow = 5.0;         // of the damping after a step that failed; twice as much after another
constexpr double kShrinkage = 300.0;  // residuals' degrees of freedom that the common noise weighs
constexpr double kHold =              // information of a hold over that of the prior
    data::kJointPriorSd_m / kHingeHold_m * (data::kJointPriorSd_m / kHingeHold_m);

Eigen::VectorXd geometry_of(const Chain& chain) {
  const auto& parameters = chain.geometry_parameters();
  Eigen::VectorXd out(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    const Chain::GeometryParameter& what = parameters[g];
    out[static_cast<Eigen::Index>(g)] =
        what.marker >= 0 ? chain.marker(what.axis, what.marker) : chain.joint(what.axis, what.joint);
  }
  return out;
}

// Rotations without information get a trace of it; their part of G is zero, so nothing else changes.
void hold_loose_rotations(const Chain& chain, Eigen::MatrixXd& H) {
  double largest = 0.0;
  for (Eigen::Index i = 3; i < H.rows(); ++i) largest = std::max(largest, H(i, i));
  largest = std::max(largest, 1e-6 * chain.scale() * chain.scale());
  for (Eigen::Index i = 0; i < H.rows(); ++i) H(i, i) += i < 3 ? 1e-12 : 1e-10 * largest;
}

}  // namespace

Vector3d joint_from_markers(const Chain& chain, int joint, bool in_parent) {
  const std::vector<int> markers =
      chain.layout.markers_of(in_parent ? chain.layout.parent[joint] : joint + 1);
  Vector3d mean = Vector3d::Zero();
  for (const int k : markers) mean += chain.marker.col(k);
  const Vector3d position = in_parent ? Vector3d(chain.joint.col(joint)) : Vector3d(Vector3d::Zero());
  return position - mean / static_cast<double>(markers.size());
}

GeometryFit::GeometryFit(Chain& chain, const ChainSamples& samples, PosedFrames& frames, double sigma_m,
                         int threads)
    : chain_(chain), samples_(samples), frames_(frames), solver_(chain), threads_(threads) {
  set_noise(sigma_m);
  find_columns();
}

// A marker's parameters move with the rotations of its own segment and of those between joint 0 and it; a
// joint's with those of all segments beyond it, whose markers it moves, and with theirs. Eliminating a
// frame's pose from the leaves on keeps these zeros.
void GeometryFit::find_columns() {
  const Chain& c = chain_;
  std::vector<std::vector<char>> moves(c.segments(),
                                       std::vector<char>(c.segments(), 0));  // [q][s]: s moves q
  for (int q = 0; q < c.segments(); ++q) {
    moves[q][q] = 1;
    for (const int j : c.joints_to(q)) moves[q][c.layout.parent[j]] = 1;
  }
  const auto sees = [&](int segment, const Chain::GeometryParameter& parameter) {
    if (parameter.marker >= 0) return moves[parameter.segment][segment] != 0;
    for (int q = 0; q < c.segments(); ++q) {
      const auto& path = c.joints_to(q);
      const bool beyond = std::find(path.begin(), path.end(), parameter.joint) != path.end();
      if (beyond && moves[q][segment] != 0) return true;
    }
    return false;
  };
  const auto& parameters = c.geometry_parameters();
  columns_.assign(c.segments() + 1, {});
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    columns_[0].push_back(static_cast<Eigen::Index>(g));
    for (int s = 0; s < c.segments(); ++s)
      if (sees(s, parameters[g])) columns_[s + 1].push_back(static_cast<Eigen::Index>(g));
  }
}

void GeometryFit::set_noise(double sigma_m) { prior_weight_ = std::pow(sigma_m / data::kJointPriorSd_m, 2); }

void GeometryFit::hold(const std::vector<HingeAxis>& hinges) {
  holds_.clear();
  for (const HingeAxis& hinge : hinges)
    for (const bool in_parent : {true, false}) {
      const Vector3d& axis = in_parent ? hinge.in_parent : hinge.in_child;
      Hold hold{.by_geometry = joint_by_geometry(chain_, hinge.joint, in_parent).transpose() * axis};
      hold.offset_m = axis.dot(joint_from_markers(chain_, hinge.joint, in_parent)) -
                      hold.by_geometry.dot(geometry_of(chain_));
      holds_.push_back(std::move(hold));
    }
}

double GeometryFit::prior_cost(const Chain& chain) const {
  if (!(prior_weight_ > 0.0)) return 0.0;
  double sum = 0.0;
  for (int j = 0; j < chain.joints(); ++j)
    for (const bool in_parent : {true, false}) {
      const Vector3d d = joint_from_markers(chain, j, in_parent);
      sum += d.dot(prior_weight_ * d);
    }
  const Eigen::VectorXd geometry = geometry_of(chain);
  for (const Hold& hold : holds_)
    sum += prior_weight_ * kHold * std::pow(hold.offset_m + hold.by_geometry.dot(geometry), 2);
  return sum;
}

void GeometryFit::add_prior(Eigen::MatrixXd& S, Eigen::VectorXd& right) const {
  if (!(prior_weight_ > 0.0)) return;
  const auto& parameters = chain_.geometry_parameters();
  Eigen::Matrix3Xd by_geometry(3, static_cast<Eigen::Index>(parameters.size()));
  for (int j = 0; j < chain_.joints(); ++j)
    for (const bool in_parent : {true, false}) {
      const int s = in_parent ? chain_.layout.parent[j] : j + 1;
      const auto count = static_cast<double>(chain_.layout.markers_of(s).size());
      by_geometry.setZero();
      for (std::size_t g = 0; g < parameters.size(); ++g) {
        if (parameters[g].segment != s) continue;
        if (parameters[g].marker >= 0)
          by_geometry(parameters[g].axis, static_cast<Eigen::Index>(g)) = -1.0 / count;
        else if (in_parent && parameters[g].joint == j)
          by_geometry(parameters[g].axis, static_cast<Eigen::Index>(g)) = 1.0;
      }
      const Eigen::MatrixX3d weighed = prior_weight_ * by_geometry.transpose();
      S.noalias() += weighed * by_geometry;
      right.noalias() -= weighed * joint_from_markers(chain_, j, in_parent);
    }
  if (holds_.empty()) return;
  const Eigen::VectorXd geometry = geometry_of(chain_);
  for (const Hold& hold : holds_) {
    S.noalias() += prior_weight_ * kHold * hold.by_geometry * hold.by_geometry.transpose();
    right -= prior_weight_ * kHold * (hold.offset_m + hold.by_geometry.dot(geometry)) * hold.by_geometry;
  }
}

double GeometryFit::refine_all(const Chain& chain, std::vector<ChainPose>& poses, int iterations) const {
  std::vector<double> cost(frames_.size());
  parallel_for(std::ssize(cost), kChunk, threads_, [&](std::int64_t begin, std::int64_t end) {
    PoseSolver solver(chain);
    for (std::int64_t i = begin; i < end; ++i) {
      solver.set(samples_.frame(frames_.frame[i]), frames_.weight[i]);
      cost[i] = solver.refine(poses[i], {}, iterations, kPoseTolerance);
    }
  });
  return std::accumulate(cost.begin(), cost.end(), 0.0);
}

void GeometryFit::accumulate(std::int64_t begin, std::int64_t end, bool keep, Part& part) {
  const Eigen::Index n = static_cast<Eigen::Index>(chain_.geometry_parameters().size());
  part.S.setZero(n, n);
  part.right.setZero(n);
  PoseSolver solver(chain_);
  Eigen::MatrixXd H;
  Eigen::MatrixXd G;
  Eigen::VectorXd b;
  std::vector<Eigen::Index> rows;
  const auto size = [&](std::size_t block) {
    return block == 0 ? 3 : chain_.rotation_size(static_cast<int>(block) - 1);
  };
  std::vector<Eigen::MatrixXd> seen(columns_.size());  // U^-1 G of all frames, without its zeros
  for (std::size_t k = 0; k < seen.size(); ++k)
    seen[k].setZero((end - begin) * size(k), std::ssize(columns_[k]));
  for (std::int64_t i = begin; i < end; ++i) {
    const double* x = samples_.frame(frames_.frame[i]);
    solver.set(x, frames_.weight[i]);
    solver.normal(frames_.pose[i], {}, false, H, b);
    solver.linearize_geometry(frames_.pose[i], x, frames_.weight[i], G, &part.S, &part.right);
    hold_loose_rotations(chain_, H);
    if (!cholesky_from_leaves(H, rows)) continue;
    for (Eigen::Index c = 0; c < n; ++c) solve_from_leaves(H, G.col(c));
    solve_from_leaves(H, b);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const int offset = k == 0 ? 0 : chain_.rotation_offset(static_cast<int>(k) - 1);
      for (std::size_t c = 0; c < columns_[k].size(); ++c)
        for (int r = 0; r < size(k); ++r)
          seen[k]((i - begin) * size(k) + r, static_cast<Eigen::Index>(c)) = G(offset + r, columns_[k][c]);
    }
    part.right.noalias() -= G.transpose() * b;
    if (!keep) continue;
    eliminated_[i].factor.swap(H);
    eliminated_[i].by_geometry.swap(G);
    eliminated_[i].right.swap(b);
  }
  Eigen::MatrixXd product;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    product.setZero(seen[k].cols(), seen[k].cols());
    product.selfadjointView<Eigen::Lower>().rankUpdate(seen[k].transpose());
    for (Eigen::Index c = 0; c < product.cols(); ++c)
      for (Eigen::Index r = c; r < product.rows(); ++r)
        part.S(columns_[k][at(r)], columns_[k][at(c)]) -= product(r, c);
  }
}

void GeometryFit::accumulate(Eigen::MatrixXd& S, Eigen::VectorXd& right, bool keep) {
  const Eigen::Index n = static_cast<Eigen::Index>(chain_.geometry_parameters().size());
  eliminated_.resize(keep ? frames_.size() : 0);
  for (Eliminated& frame : eliminated_) frame.right.resize(0);
  const std::int64_t count = std::ssize(frames_.frame);
  std::vector<Part> parts((count + kChunk - 1) / kChunk);
  parallel_for(count, kChunk, threads_, [&](std::int64_t begin, std::int64_t end) {
    accumulate(begin, end, keep, parts[begin / kChunk]);
  });
  // In the order of the chunks, which does not depend on the threads.
  S.setZero(n, n);
  right.setZero(n);
  for (const Part& part : parts) {
    S += part.S;
    right += part.right;
  }
  S.triangularView<Eigen::StrictlyUpper>() = S.transpose();
  add_prior(S, right);
}

double GeometryFit::run(int iterations, const Eigen::VectorXd& extra_gradient,
                        const std::function<bool(int round, double gain_m2)>& give_up) {
  const Eigen::Index n = static_cast<Eigen::Index>(chain_.geometry_parameters().size());
  double cost = refine_all(chain_, frames_.pose, 40) + prior_cost(chain_);
  double lambda = 1e-6, grow = kGrow;
  Eigen::MatrixXd S;
  Eigen::VectorXd right;
  Chain trial = chain_;
  std::vector<ChainPose> poses;
  Eigen::VectorXd frame_step;
  for (int round = 0; round < iterations; ++round) {
    accumulate(S, right, true);
    if (extra_gradient.size() == n) right -= extra_gradient;
    const Eigen::MatrixXd gauge = chain_.gauge();
    const double mean = S.trace() / static_cast<double>(n);
    S.noalias() += mean * gauge * gauge.transpose();
    bool better = false;
    double gain = 0.0;
    while (lambda < 1e5) {
      Eigen::MatrixXd damped = S;
      damped.diagonal().array() += (lambda + 1e-10) * mean;
      const Eigen::VectorXd step = damped.ldlt().solve(right);
      if (!step.allFinite()) break;
      trial.marker = chain_.marker;
      trial.joint = chain_.joint;
      trial.move_geometry(step);
      poses = frames_.pose;
      for (std::size_t i = 0; i < frames_.size(); ++i) {
        const Eliminated& frame = eliminated_[i];
        if (frame.right.size() == 0) continue;
        frame_step = frame.right;
        frame_step.noalias() -= frame.by_geometry * step;
        solve_to_leaves(frame.factor, frame_step);
        const double big = frame_step.tail(frame_step.size() - 3).cwiseAbs().maxCoeff();
        if (big > 0.5) frame_step *= 0.5 / big;
        move_pose(trial, frame_step, poses[i]);
      }
      const double value = refine_all(trial, poses, 20) + prior_cost(trial);
      const double extra_cost = extra_gradient.size() == n ? 2.0 * extra_gradient.dot(step) : 0.0;
      if (value + extra_cost <= cost + 1e-18) {
        gain = cost - value - extra_cost;
        chain_.marker = trial.marker;
        chain_.joint = trial.joint;
        frames_.pose.swap(poses);
        cost = value;
        // As far as the quadratic was right (as in PoseSolver::refine).
        const double expected = step.dot(right) + lambda * mean * step.squaredNorm();
        lambda *= std::max(1.0 / 6.0, 1.0 - std::pow(2.0 * gain / std::max(expected, gain) - 1.0, 3));
        lambda = std::max(lambda, 1e-10);
        grow = kGrow;
        better = true;
        break;
      }
      lambda = std::max(grow * lambda, 1e-6);
      grow *= 2.0;
    }
    if (!better || gain < 1e-9 * cost + 1e-20 || (give_up && give_up(round, gain))) break;
  }
  return cost - prior_cost(chain_);
}

Eigen::VectorXd GeometryFit::integrated_gradient(double sigma_m) {
  const Eigen::Index n = static_cast<Eigen::Index>(chain_.geometry_parameters().size());
  Eigen::VectorXd gradient(n);
  const auto half_log_det = [&](Eigen::Index g, double change) {
    Chain trial = chain_;
    trial.move_geometry(change * Eigen::VectorXd::Unit(n, g));
    PoseSolver trial_solver(trial);
    Eigen::MatrixXd H;
    Eigen::VectorXd b;
    double sum = 0.0;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      trial_solver.set(samples_.frame(frames_.frame[i]), frames_.weight[i]);
      ChainPose pose = frames_.pose[i];
      trial_solver.refine(pose, {}, 8, 1e-14);
      trial_solver.normal(pose, {}, true, H, b);
      // Rotations of a segment that is not seen are left out: their pivot is set to a constant.
      for (Eigen::Index k = 3; k < H.rows(); ++k) {
        if (H(k, k) < 1e-15) H(k, k) = 1.0;
      }
      if (cholesky(H)) sum += H.diagonal().array().log().sum();
    }
    return sum;
  };
  parallel_for(n, 1, threads_, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t g = begin; g < end; ++g) {
      const double up = half_log_det(g, kDifference);
      const double down = half_log_det(g, -kDifference);
      gradient[g] = sigma_m * sigma_m * (up - down) / (2.0 * kDifference);
    }
  });
  return gradient;
}

Eigen::MatrixXd GeometryFit::covariance(double sigma_m) {
  Eigen::MatrixXd S;
  Eigen::VectorXd right;
  accumulate(S, right, false);
  const Eigen::MatrixXd gauge = chain_.gauge();
  const double mean = S.trace() / static_cast<double>(S.rows());
  S.diagonal().array() += std::pow(sigma_m / kUnknownPosition, 2);
  S.noalias() += mean * gauge * gauge.transpose();
  Eigen::MatrixXd inverse = S.ldlt().solve(Eigen::MatrixXd::Identity(S.rows(), S.cols()));
  // Take the gauge off on both sides.
  const Eigen::MatrixXd seen = Eigen::MatrixXd::Identity(S.rows(), S.cols()) - gauge * gauge.transpose();
  inverse = (seen * inverse * seen).eval();
  return 0.5 * (inverse + inverse.transpose());
}

double GeometryFit::cost() { return refine_all(chain_, frames_.pose, 20); }

double GeometryFit::degrees_of_freedom() {
  double dof = 0.0;
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  FrameInformation information;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    solver_.set(samples_.frame(frames_.frame[i]), frames_.weight[i]);
    solver_.normal(frames_.pose[i], {}, false, H, b);
    information.set(chain_, H);
    dof += 3.0 * solver_.sums().seen - information.rank();
  }
  return dof - static_cast<double>(chain_.geometry_parameters().size()) +
         static_cast<double>(chain_.gauge().cols());
}

double GeometryFit::coordinates() {
  double sum = 0.0;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    solver_.set(samples_.frame(frames_.frame[i]), frames_.weight[i]);
    sum += 3.0 * solver_.sums().seen;
  }
  return sum;
}

std::vector<double> GeometryFit::marker_variance(double sigma_m) {
  const Chain& c = chain_;
  std::vector<double> squares(c.markers(), 0.0);
  std::vector<double> dof(c.markers(), 0.0);
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(c.frame_parameters(), 3);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const double* x = samples_.frame(frames_.frame[i]);
    const ChainPose& pose = frames_.pose[i];
    solver_.set(x, frames_.weight[i]);
    solver_.normal(pose, {}, false, H, b);
    hold_loose_rotations(c, H);
    if (!cholesky(H)) continue;
    for (int k = 0; k < c.markers(); ++k) {
      if (std::isnan(x[3 * k])) continue;
      const int q = c.layout.segment_of_marker[k];
      const Vector3d m = c.marker.col(k);
      rows.setZero();
      rows.topRows<3>().setIdentity();
      // Transposed derivative of the marker's position by the frame's parameters.
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d own = m.cross(pose.rotation[q].transpose() * Vector3d::Unit(axis));
        for (int r = 0; r < c.rotation_size(q); ++r) rows(c.rotation_offset(q) + r, axis) = own[r];
        for (const int j : c.joints_to(q)) {
          const int p = c.layout.parent[j];
          const Vector3d lever =
              Vector3d(c.joint.col(j)).cross(pose.rotation[p].transpose() * Vector3d::Unit(axis));
          for (int r = 0; r < c.rotation_size(p); ++r) rows(c.rotation_offset(p) + r, axis) = lever[r];
        }
        solve_lower(H, rows.col(axis));
      }
      const double w = frames_.weight[i][k];
      squares[k] += w * (Eigen::Map<const Vector3d>(x + 3 * k) - c.predict(pose, k)).squaredNorm();
      dof[k] += std::max(3.0 - w * rows.squaredNorm(), 0.0);
    }
  }
  const double variance = sigma_m * sigma_m;
  std::vector<double> ratio(c.markers(), 1.0);
  for (int k = 0; k < c.markers(); ++k) {
    ratio[k] = (squares[k] / variance + kShrinkage) / (dof[k] + kShrinkage);
  }
  return ratio;
}

void GeometryFit::reweigh(const std::vector<double>& own, double dof, double sigma_m) {
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    robust_weights(chain_, frames_.pose[i], samples_.frame(frames_.frame[i]), own, dof, sigma_m,
                   frames_.weight[i]);
  }
}

}  // namespace kinemark::skeleton::articulated
