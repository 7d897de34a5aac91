// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/priority_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinemark::motion::internal {

PrioritySolver::PrioritySolver(int speeds)
    : free_(static_cast<std::size_t>(speeds)),
      M_(speeds, speeds),
      H_(speeds, speeds),
      V_(speeds, speeds),
      llt_(speeds),
      normal_(speeds),
      z_(speeds),
      part_(speeds),
      projected_(speeds),
      result_(speeds),
      held_a_(speeds),
      workspace_(speeds) {}

bool PrioritySolver::begin(const Eigen::MatrixXd& M, const std::vector<std::uint8_t>& held,
                           const Eigen::VectorXd& held_a) {
  free_count_ = 0;
  for (std::size_t k = 0; k < held.size(); ++k)
    if (held[k] == 0) free_[static_cast<std::size_t>(free_count_++)] = static_cast<int>(k);
  any_held_ = free_count_ < M.rows();
  held_a_ = held_a;
  M_.resize(free_count_, free_count_);
  for (int j = 0; j < free_count_; ++j)
    for (int i = 0; i < free_count_; ++i) M_(i, j) = M(free_[i], free_[j]);
  llt_.compute(M_);
  z_.setZero(free_count_);
  V_.resize(free_count_, free_count_);
  next_level_ = 0;
  used_ = 0;
  smallest_ = std::numeric_limits<double>::infinity();
  return llt_.info() == Eigen::Success;
}

void PrioritySolver::gather(const Eigen::VectorXd& all) {
  part_.resize(free_count_);
  for (int i = 0; i < free_count_; ++i) part_[i] = all[free_[i]];
}

void PrioritySolver::add_level(const Eigen::Ref<const Eigen::MatrixXd>& J,
                               const Eigen::Ref<const Eigen::VectorXd>& r, const PriorityDamping& damping) {
  if (next_level_ == levels_.size()) levels_.emplace_back();
  Level& level = levels_[next_level_++];
  const int m = static_cast<int>(J.rows()), n = free_count_;
  if (m == 0 || used_ == n) return;
  // A = J L^-T on the free speeds, and what the task still lacks.
  level.A.resize(n, m);  // kept transposed: L A' = J'
  for (int i = 0; i < n; ++i) level.A.row(i) = J.col(free_[i]).transpose();
  level.r = r;
  if (any_held_) {
    std::size_t next = 0;
    for (int k = 0; k < J.cols(); ++k) {
      if (next < static_cast<std::size_t>(n) && free_[next] == k)
        ++next;
      else
        level.r -= held_a_[k] * J.col(k);
    }
  }
  llt_.matrixL().solveInPlace(level.A);
  level.r.noalias() -= level.A.transpose() * z_;
  const auto V = V_.leftCols(used_);
  if (used_ > 0) {
    level.shared.noalias() = V.transpose() * level.A;
    level.A.noalias() -= V * level.shared;
  }
  level.qr.compute(level.A);
  const auto& qr = level.qr.matrixQR();
  const int most = std::min({m, n - used_, n});
  const double floor = std::max(damping.truncation * std::abs(qr(0, 0)), 1e-9);
  int count = 0;
  while (count < most && std::abs(qr(count, count)) > floor) ++count;
  if (count == 0) return;
  smallest_ = std::min(smallest_, std::abs(qr(count - 1, count - 1)));
  level.B.setIdentity(n, count);
  workspace_.resize(count);
  level.qr.householderQ().applyThisOnTheLeft(level.B, workspace_);
  // A' = B R P' on what is kept, so that B'z solves (R R' + damping^2) y = R P' r.
  level.R = qr.topRows(count);
  for (int j = 0; j < count; ++j) level.R.col(j).tail(count - 1 - j).setZero();
  level.G.resize(count, count);
  level.G.noalias() = level.R * level.R.transpose();
  level.G.diagonal().array() += damping.damping * damping.damping;
  level.llt.compute(level.G);
  level.permuted.resize(m);
  for (int j = 0; j < m; ++j) level.permuted[j] = level.r[level.qr.colsPermutation().indices()[j]];
  level.along.resize(count);
  level.along.noalias() = level.R * level.permuted;
  level.llt.solveInPlace(level.along);
  z_.noalias() += level.B * level.along;
  V_.middleCols(used_, count) = level.B;
  used_ += count;
}

bool PrioritySolver::add_full_level(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, double damping,
                                    double min_singular) {
  const int n = free_count_;
  H_.resize(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) H_(i, j) = H(free_[i], free_[j]);
  // All singular values of A above s: J'J - s^2 M is positive definite.
  H_.noalias() -= (min_singular * min_singular) * M_;
  normal_.compute(H_);
  if (normal_.info() != Eigen::Success) return false;
  H_.noalias() += (min_singular * min_singular + damping * damping) * M_;
  normal_.compute(H_);
  gather(g);
  if (any_held_) {
    std::size_t next = 0;
    for (int k = 0; k < H.cols(); ++k) {
      if (next < static_cast<std::size_t>(n) && free_[next] == k) {
        ++next;
        continue;
      }
      for (int i = 0; i < n; ++i) part_[i] -= held_a_[k] * H(free_[i], k);
    }
  }
  normal_.solveInPlace(part_);
  z_.noalias() = llt_.matrixL().transpose() * part_;
  used_ = n;
  smallest_ = std::min(smallest_, min_singular);
  return true;
}

void PrioritySolver::add_posture(const Eigen::VectorXd& wished) {
  if (used_ == free_count_) return;
  gather(wished);
  projected_.resize(free_count_);
  projected_.noalias() = llt_.matrixL().transpose() * part_;
  projected_ -= z_;  // towards the wish, from what the levels made
  auto along = result_.head(used_);
  along.noalias() = V_.leftCols(used_).transpose() * projected_;
  projected_.noalias() -= V_.leftCols(used_) * along;
  z_ += projected_;
}

const Eigen::VectorXd& PrioritySolver::acceleration() {
  part_ = z_;
  llt_.matrixL().transpose().solveInPlace(part_);
  result_ = held_a_;
  for (int i = 0; i < free_count_; ++i) result_[free_[i]] = part_[i];
  return result_;
}

}  // namespace kinemark::motion::internal
