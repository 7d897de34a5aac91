// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/priority_solver.h"

#include "kinemark/stages/motion/internal/held_speeds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinemark::motion::internal {
namespace {

// Singular values (kg^-1/2 per metre) around which the posture smoothly takes over from a level: a direction
// that hardly moves the goals, and that damping leaves almost free, would otherwise drift away.
constexpr double kIdle = 0.005;
constexpr double kBusy = 30.0 * kIdle;  // above it the posture's share is below 0.1 %

}  // namespace

PrioritySolver::PrioritySolver(int speeds)
    : M_(speeds, speeds),
      H_(speeds, speeds),
      V_(speeds, speeds),
      llt_(speeds),
      normal_(speeds),
      z_(speeds),
      part_(speeds),
      projected_(speeds),
      result_(speeds),
      held_a_(speeds) {}

bool PrioritySolver::begin(const Eigen::MatrixXd& M, const std::vector<std::uint8_t>& held,
                           const Eigen::VectorXd& held_a) {
  held_ = held;
  held_a_ = held_a;
  free_count_ = static_cast<int>(std::count(held.begin(), held.end(), 0));
  any_held_ = free_count_ < M.rows();
  M_ = M;
  detach_held(M_);
  llt_.compute(M_);
  z_.setZero();
  next_level_ = 0;
  used_ = 0;
  for (auto& level : levels_) level.idle = false;
  smallest_ = std::numeric_limits<double>::infinity();
  return llt_.info() == Eigen::Success;
}

void PrioritySolver::detach_held(Eigen::MatrixXd& S) const {
  if (any_held_) hold_speeds(S, held_);
}

void PrioritySolver::add_level(const Eigen::Ref<const Eigen::MatrixXd>& J,
                               const Eigen::Ref<const Eigen::VectorXd>& r, const PriorityDamping& damping) {
  if (next_level_ == levels_.size()) levels_.emplace_back();
  Level& level = levels_[next_level_++];
  const int m = static_cast<int>(J.rows()), n = static_cast<int>(J.cols());
  if (m == 0 || used_ == free_count_) return;
  // A = J L^-T on the free speeds, and the remaining residual of the task.
  level.A = J.transpose();  // kept transposed: L A' = J'
  level.r = r;
  for (int k = 0; any_held_ && k < n; ++k) {
    if (held_[static_cast<std::size_t>(k)] == 0) continue;
    level.r -= held_a_[k] * J.col(k);
    level.A.row(k).setZero();
  }
  llt_.matrixL().solveInPlace(level.A);
  level.r.noalias() -= level.A.transpose() * z_;
  const auto V = V_.leftCols(used_);
  if (used_ > 0) {
    level.shared.resize(n, m);
    level.shared.topRows(used_).noalias() = V.transpose() * level.A;
    level.A.noalias() -= V * level.shared.topRows(used_);
  }
  level.qr.compute(level.A);
  const auto& qr = level.qr.matrixQR();
  const int most = std::min(m, free_count_ - used_);
  const double floor = std::max(damping.truncation * std::abs(qr(0, 0)), 1e-9);
  int count = 0;
  while (count < most && std::abs(qr(count, count)) > floor) ++count;
  if (count == 0) return;
  smallest_ = std::min(smallest_, std::abs(qr(count - 1, count - 1)));
  // A' = B R P' on what is kept, so that B'z solves (R R' + damping^2) y = R P' r. Sizes do not follow the
  // rank (that would allocate): discarded directions have zero rows in R.
  const int size = std::min(m, n), rest = size - count;
  level.B.setIdentity(n, size);
  level.workspace.resize(size);
  level.qr.householderQ().applyThisOnTheLeft(level.B, level.workspace);
  level.R = qr.topRows(size);
  for (int j = 0; j < size; ++j) level.R.col(j).tail(size - 1 - j).setZero();
  level.R.bottomRows(rest).setZero();
  level.G.resize(size, size);
  const auto factor = [&](double spread, Eigen::LLT<Eigen::MatrixXd>& llt) {
    level.G.noalias() = level.R * level.R.transpose();
    level.G.diagonal().head(count).array() += spread * spread;
    level.G.diagonal().tail(rest).setOnes();
    llt.compute(level.G);
  };
  factor(damping.damping, level.llt);
  level.idle = damping.damping > 0.0 && std::abs(qr(count - 1, count - 1)) < kBusy;
  if (level.idle) factor(kIdle, level.idle_llt);
  level.count = count;
  level.permuted.resize(m);
  for (int j = 0; j < m; ++j) level.permuted[j] = level.r[level.qr.colsPermutation().indices()[j]];
  level.along.resize(size);
  level.along.noalias() = level.R * level.permuted;
  level.llt.solveInPlace(level.along);
  z_.noalias() += level.B * level.along;
  V_.middleCols(used_, count) = level.B.leftCols(count);
  used_ += count;
}

bool PrioritySolver::add_full_level(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, double damping,
                                    double min_singular) {
  H_ = H;
  detach_held(H_);
  // All singular values of A above s: J'J - s^2 M is positive definite.
  H_.noalias() -= (min_singular * min_singular) * M_;
  normal_.compute(H_);
  if (normal_.info() != Eigen::Success) return false;
  H_.noalias() += (min_singular * min_singular + damping * damping) * M_;
  normal_.compute(H_);
  part_ = g;
  for (Eigen::Index k = 0; any_held_ && k < H.cols(); ++k)
    if (held_[static_cast<std::size_t>(k)] != 0) part_ -= held_a_[k] * H.col(k);
  for (Eigen::Index k = 0; any_held_ && k < H.cols(); ++k)
    if (held_[static_cast<std::size_t>(k)] != 0) part_[k] = 0.0;
  normal_.solveInPlace(part_);
  z_.noalias() = llt_.matrixL().transpose() * part_;
  used_ = free_count_;
  smallest_ = std::numeric_limits<double>::quiet_NaN();
  return true;
}

void PrioritySolver::add_posture(const Eigen::VectorXd& wished) {
  bool any_idle = false;
  for (std::size_t i = 0; i < next_level_; ++i) any_idle = any_idle || levels_[i].idle;
  if (used_ == free_count_ && !any_idle) return;
  projected_.noalias() = llt_.matrixL().transpose() * wished;
  for (std::size_t i = 0; any_idle && i < next_level_; ++i) {
    auto& level = levels_[i];
    if (!level.idle) continue;
    level.along.noalias() = level.B.transpose() * projected_;
    level.along.tail(level.along.size() - level.count).setZero();
    level.idle_llt.solveInPlace(level.along);
    z_.noalias() += (kIdle * kIdle) * (level.B * level.along);
  }
  if (used_ == free_count_) return;
  projected_ -= z_;  // from the levels' solution towards the posture
  auto along = part_.head(used_);
  along.noalias() = V_.leftCols(used_).transpose() * projected_;
  projected_.noalias() -= V_.leftCols(used_) * along;
  z_ += projected_;
}

// With M = L L' and z = L' a, the acceleration M^-1 f is L^-1 f.
void PrioritySolver::add_outside_force(const Eigen::VectorXd& force, int constrained) {
  projected_ = force;
  for (Eigen::Index k = 0; any_held_ && k < projected_.size(); ++k)
    if (held_[static_cast<std::size_t>(k)] != 0) projected_[k] = 0.0;
  llt_.matrixL().solveInPlace(projected_);
  if (constrained > 0) {
    auto along = part_.head(constrained);
    along.noalias() = V_.leftCols(constrained).transpose() * projected_;
    projected_.noalias() -= V_.leftCols(constrained) * along;
  }
  z_ += projected_;
}

const Eigen::VectorXd& PrioritySolver::acceleration() {
  result_ = z_;
  llt_.matrixL().transpose().solveInPlace(result_);
  for (Eigen::Index k = 0; any_held_ && k < result_.size(); ++k)
    if (held_[static_cast<std::size_t>(k)] != 0) result_[k] = held_a_[k];
  return result_;
}

}  // namespace kinemark::motion::internal
