// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Prioritised accelerations of a body tree: each level is solved in the null space of the levels above.
//
// With M = LL' and z = L'q'', a task J q'' = r becomes A z = r, A = J L^-T. Then (Demircan et al. 2008,
// equations 2 to 13)
//   Lambda^-1 = J M^-1 J' = A A',   Jbar = M^-1 J' Lambda = L^-T A^+,   N = I - Jbar J  <->  I - VV',
// V an orthonormal basis of the rows of A; null spaces of several levels are products of such projectors. In
// this form a level may have more rows than rank: z is its least-squares solution. V comes from a QR
// decomposition with column pivoting, whose diagonal follows the singular values s of A. Directions that
// hardly move the task are damped, s / (s^2 + damping^2), and discarded below a share of the largest.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <cstdint>
#include <deque>
#include <vector>

namespace kinemark::motion::internal {

struct PriorityDamping {
  double damping = 0.1;      ///< >= 0, in units of A (kg^-1/2 per metre of task)
  double truncation = 1e-4;  ///< of the largest pivot; directions below are left to lower levels
};

/// One thread's solver. Sized on the first use of each level; allocates nothing afterwards while levels keep
/// their number of rows.
class PrioritySolver {
 public:
  explicit PrioritySolver(int speeds);

  /// Start a new solution with mass matrix M (nv x nv). Speeds with held[k] != 0 get the acceleration
  /// held_a[k] and are excluded from the tasks. False when M is not positive definite.
  bool begin(const Eigen::MatrixXd& M, const std::vector<std::uint8_t>& held, const Eigen::VectorXd& held_a);

  /// The next level: J q'' = r, rows x nv.
  void add_level(const Eigen::Ref<const Eigen::MatrixXd>& J, const Eigen::Ref<const Eigen::VectorXd>& r,
                 const PriorityDamping& damping);

  /// The same for a first level that fixes every speed, from H = J'J and g = J'r alone. Returns false without
  /// effect when a singular value is below `min_singular`.
  bool add_full_level(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, double damping,
                      double min_singular);

  /// Posture accelerations in the null space of all levels; with damping, also in directions that move a
  /// level's goals so little (s near 0.005 and below) that the damping suppresses them: there the posture's
  /// share is 0.005^2 / (s^2 + 0.005^2).
  void add_posture(const Eigen::VectorXd& wished);

  /// What a generalised force (nv) from outside adds to the acceleration, after all levels and the posture:
  /// none of them knows it. The first `constrained` directions that levels fix stay as they are.
  void add_outside_force(const Eigen::VectorXd& force, int constrained);

  /// q'' of all speeds, held ones included.
  [[nodiscard]] const Eigen::VectorXd& acceleration();
  /// Rank of all levels together.
  [[nodiscard]] int rank() const { return used_; }
  /// Speeds that are not held.
  [[nodiscard]] int free_speeds() const { return free_count_; }
  /// Smallest pivot over the levels, near the smallest singular value of what they fix; infinity when they
  /// fix nothing, NaN after add_full_level(), which does not compute it.
  [[nodiscard]] double smallest_pivot() const { return smallest_; }

 private:
  struct Level {
    Eigen::MatrixXd A, B, R, G, shared;  ///< A transposed: speeds x rows
    Eigen::VectorXd r, permuted, along, workspace;
    int count = 0;  ///< directions that it fixes
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
    Eigen::LLT<Eigen::MatrixXd> llt, idle_llt;
    bool idle = false;  ///< some direction is left to the posture, entirely or in part
  };
  /// Held rows and columns of a symmetric matrix become those of the identity: sizes stay as they are.
  void detach_held(Eigen::MatrixXd& S) const;

  std::vector<std::uint8_t> held_;
  int free_count_ = 0;
  Eigen::MatrixXd M_, H_, V_;
  Eigen::LLT<Eigen::MatrixXd> llt_, normal_;
  Eigen::VectorXd z_, part_, projected_, result_, held_a_;
  std::deque<Level> levels_;
  std::size_t next_level_ = 0;
  int used_ = 0;
  bool any_held_ = false;
  double smallest_ = 0.0;
};

}  // namespace kinemark::motion::internal
