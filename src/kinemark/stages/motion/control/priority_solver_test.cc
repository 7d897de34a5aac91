// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/priority_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kinemark/core/random.h"
#include "support/allocations.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_matrix(Random& random, int rows, int cols) {
  MatrixXd m(rows, cols);
  for (int j = 0; j < cols; ++j)
    for (int i = 0; i < rows; ++i) m(i, j) = random.gaussian();
  return m;
}

// The oracles are plain loops: they share nothing with what they judge, and a template library that unfolds
// every product of theirs anew makes this file the slowest of all.
MatrixXd times(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd out = MatrixXd::Zero(a.rows(), b.cols());
  for (int i = 0; i < a.rows(); ++i)
    for (int j = 0; j < b.cols(); ++j)
      for (int k = 0; k < a.cols(); ++k) out(i, j) += a(i, k) * b(k, j);
  return out;
}

MatrixXd transposed(const MatrixXd& a) {
  MatrixXd out(a.cols(), a.rows());
  for (int i = 0; i < a.rows(); ++i)
    for (int j = 0; j < a.cols(); ++j) out(j, i) = a(i, j);
  return out;
}

/// a + factor b.
MatrixXd plus(const MatrixXd& a, double factor, const MatrixXd& b) {
  MatrixXd out = a;
  for (int i = 0; i < a.rows(); ++i)
    for (int j = 0; j < a.cols(); ++j) out(i, j) += factor * b(i, j);
  return out;
}

double length(const MatrixXd& a) {
  double squares = 0.0;
  for (int i = 0; i < a.rows(); ++i)
    for (int j = 0; j < a.cols(); ++j) squares += a(i, j) * a(i, j);
  return std::sqrt(squares);
}

double apart(const MatrixXd& a, const MatrixXd& b) { return length(plus(a, -1.0, b)); }

MatrixXd one(int n) {
  MatrixXd out = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) out(i, i) = 1.0;
  return out;
}

/// Gauss and Jordan, with the largest pivot of each column.
MatrixXd inverse(MatrixXd a) {
  const int n = static_cast<int>(a.rows());
  MatrixXd out = one(n);
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(a(i, k)) > std::abs(a(best, k))) best = i;
    for (int j = 0; j < n; ++j) {
      std::swap(a(k, j), a(best, j));
      std::swap(out(k, j), out(best, j));
    }
    const double pivot = a(k, k);
    for (int j = 0; j < n; ++j) {
      a(k, j) /= pivot;
      out(k, j) /= pivot;
    }
    for (int i = 0; i < n; ++i) {
      const double share = i == k ? 0.0 : a(i, k);
      for (int j = 0; j < n; ++j) {
        a(i, j) -= share * a(k, j);
        out(i, j) -= share * out(k, j);
      }
    }
  }
  return out;
}

MatrixXd random_mass(Random& random, int n) {
  const MatrixXd a = random_matrix(random, n, n);
  return plus(times(a, transposed(a)), 0.5, one(n));
}

constexpr PriorityDamping kExact{.damping = 0.0, .truncation = 1e-9};
const std::vector<std::uint8_t> kNothingHeld(12, 0);

struct Tasks {
  MatrixXd M;
  std::vector<MatrixXd> J;
  std::vector<VectorXd> r;
};

Tasks random_tasks(int levels, std::uint64_t seed) {
  Random random(seed, 1);
  Tasks t;
  t.M = random_mass(random, 12);
  for (int i = 0; i < levels; ++i) {
    t.J.push_back(random_matrix(random, 3, 12));
    t.r.push_back(random_matrix(random, 3, 1));
  }
  return t;
}

/// The paper's recursion, literally: Lambda, Jbar and N of the dynamically consistent inverse.
struct Textbook {
  explicit Textbook(const Tasks& t, std::size_t levels) : mobility(inverse(t.M)), N(one(12)) {
    force = MatrixXd::Zero(12, 1);
    for (std::size_t i = 0; i < levels; ++i) {
      const MatrixXd J = times(t.J[i], N);  // J restricted to what the levels above leave
      const MatrixXd lambda = inverse(times(times(J, mobility), transposed(J)));
      Jbar = times(times(mobility, transposed(J)), lambda);
      const MatrixXd rest = plus(t.r[i], -1.0, times(t.J[i], times(mobility, force)));
      force = plus(force, 1.0, times(transposed(J), times(lambda, rest)));
      N = times(N, plus(one(12), -1.0, times(Jbar, J)));
    }
  }
  /// Accelerations with a posture in what the levels leave.
  [[nodiscard]] MatrixXd acceleration(const Tasks& t, const MatrixXd& posture) const {
    const MatrixXd wish = plus(posture, -1.0, times(mobility, force));
    return times(mobility, plus(force, 1.0, times(transposed(N), times(t.M, wish))));
  }
  MatrixXd mobility, N, Jbar, force;  ///< M^-1; null space of all levels; inverse of the last
};

TEST(PrioritySolver, AgreesWithTheTextbookForOneToFourLevels) {
  for (int levels = 1; levels <= 4; ++levels)
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Tasks t = random_tasks(levels, seed);
      Random random(seed, 2);
      const VectorXd posture = random_matrix(random, 12, 1);
      PrioritySolver solver(12);
      ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
      for (int i = 0; i < levels; ++i) solver.add_level(t.J[i], t.r[i], kExact);
      solver.add_posture(posture);
      const MatrixXd expected = Textbook(t, t.J.size()).acceleration(t, posture);
      EXPECT_LT(apart(solver.acceleration(), expected), 1e-9 * length(expected)) << levels << ' ' << seed;
      EXPECT_EQ(solver.rank(), 3 * levels);
    }
}

// What makes the inverse dynamically consistent: Jbar answers its own task exactly, its null space moves no
// task and is a projection, and forces in it accelerate none.
TEST(PrioritySolver, TheTextbookKeepsItsOwnLaws) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Tasks t = random_tasks(1, seed);
    const Textbook book(t, 1);
    EXPECT_LT(apart(times(t.J[0], book.Jbar), one(3)), 1e-10);
    EXPECT_LT(apart(times(book.N, book.N), book.N), 1e-10);
    EXPECT_LT(length(times(t.J[0], book.N)), 1e-10);
    EXPECT_LT(length(times(times(t.J[0], book.mobility), transposed(book.N))), 1e-10);
  }
}

// Gauss's principle: of all accelerations that meet the task, the one with the least q'' M q''.
TEST(PrioritySolver, OneLevelIsTheLeastMotionThatMeetsIt) {
  const Tasks t = random_tasks(1, 8);
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
  solver.add_level(t.J[0], t.r[0], kExact);
  const MatrixXd a = solver.acceleration();
  const auto effort = [&](const MatrixXd& q) { return times(transposed(q), times(t.M, q))(0, 0); };
  const Textbook book(t, 1);
  Random random(8, 5);
  for (int i = 0; i < 10; ++i) {
    const MatrixXd other = plus(a, 0.1, times(book.N, random_matrix(random, 12, 1)));
    EXPECT_LT(apart(times(t.J[0], other), t.r[0]), 1e-9);
    EXPECT_GT(effort(other), effort(a));
  }
}

TEST(PrioritySolver, ALevelWithoutRowsOrWithNothingLeftChangesNothing) {
  const Tasks t = random_tasks(4, 2);
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
  solver.add_level(MatrixXd(0, 12), VectorXd(0), kExact);
  EXPECT_EQ(solver.rank(), 0);
  for (int i = 0; i < 4; ++i) solver.add_level(t.J[i], t.r[i], kExact);
  EXPECT_EQ(solver.rank(), 12);
  const VectorXd before = solver.acceleration();
  solver.add_level(t.J[0], VectorXd::Constant(3, 1e6), kExact);
  solver.add_posture(VectorXd::Constant(12, 1e6));
  EXPECT_EQ(solver.acceleration(), before);
}

TEST(PrioritySolver, LowerLevelsAndPostureDoNotMoveHigherOnes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Tasks t = random_tasks(3, seed);
    PrioritySolver solver(12);
    ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
    solver.add_level(t.J[0], t.r[0], kExact);
    const MatrixXd alone = times(t.J[0], solver.acceleration());
    const VectorXd second = plus(t.r[1], 999.0, t.r[1]), third = plus(t.r[2], 999.0, t.r[2]);
    solver.add_level(t.J[1], second, kExact);
    solver.add_level(t.J[2], third, kExact);
    solver.add_posture(VectorXd::Constant(12, 50.0));
    EXPECT_LT(apart(times(t.J[0], solver.acceleration()), alone), 1e-9 * 1e3);
    EXPECT_LT(apart(times(t.J[1], solver.acceleration()), second), 1e-6);
  }
}

TEST(PrioritySolver, ATaskThatRepeatsAnUpperOneAddsNoRankAndNoHarm) {
  Tasks t = random_tasks(1, 5);
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
  solver.add_level(t.J[0], t.r[0], kExact);
  const VectorXd before = solver.acceleration();
  solver.add_level(plus(t.J[0], 1.0, t.J[0]), VectorXd::Constant(3, 7.0),
                   {.damping = 0.0, .truncation = 1e-4});
  EXPECT_EQ(solver.rank(), 3);
  EXPECT_LT(apart(solver.acceleration(), before), 1e-6 * length(before));
}

TEST(PrioritySolver, MoreRowsThanSpeedsIsLeastSquares) {
  Random random(3, 1);
  const MatrixXd M = random_mass(random, 12), J = random_matrix(random, 40, 12);
  const VectorXd r = random_matrix(random, 40, 1);
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
  solver.add_level(J, r, kExact);
  const MatrixXd normal = times(transposed(J), J), right = times(transposed(J), r);
  const MatrixXd expected = times(inverse(normal), right);
  EXPECT_LT(apart(solver.acceleration(), expected), 1e-9 * length(expected));
  EXPECT_EQ(solver.rank(), 12);

  const VectorXd rows = solver.acceleration();
  ASSERT_TRUE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
  ASSERT_TRUE(solver.add_full_level(normal, right, 0.0, 1e-3));
  EXPECT_LT(apart(solver.acceleration(), rows), 1e-9 * length(rows));
}

TEST(PrioritySolver, DampingIsTheSameWithAndWithoutRows) {
  Random random(4, 1);
  const MatrixXd M = random_mass(random, 12), J = random_matrix(random, 40, 12);
  const VectorXd r = random_matrix(random, 40, 1);
  PrioritySolver rows(12), full(12);
  ASSERT_TRUE(rows.begin(M, kNothingHeld, VectorXd::Zero(12)));
  ASSERT_TRUE(full.begin(M, kNothingHeld, VectorXd::Zero(12)));
  rows.add_level(J, r, {.damping = 0.5, .truncation = 1e-6});
  ASSERT_TRUE(full.add_full_level(times(transposed(J), J), times(transposed(J), r), 0.5, 1e-3));
  EXPECT_LT(apart(rows.acceleration(), full.acceleration()), 1e-9);
  // The minimum of |J q'' - r|^2 + d^2 q'' M q''.
  const MatrixXd damped = times(inverse(plus(times(transposed(J), J), 0.25, M)), times(transposed(J), r));
  EXPECT_LT(apart(rows.acceleration(), damped), 1e-9 * length(damped));
}

TEST(PrioritySolver, AFullLevelThatLeavesADirectionOpenIsRefused) {
  Random random(6, 1);
  const MatrixXd M = random_mass(random, 12);
  MatrixXd J = random_matrix(random, 40, 12);
  for (int i = 0; i < 40; ++i) J(i, 7) = J(i, 3);  // no row tells speed 3 from speed 7
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
  EXPECT_FALSE(solver.add_full_level(times(transposed(J), J), VectorXd::Ones(12), 0.0, 1e-3));
  EXPECT_EQ(solver.rank(), 0);
  solver.add_level(J, VectorXd::Ones(40), {.damping = 0.0, .truncation = 1e-4});
  EXPECT_EQ(solver.rank(), 11);
}

TEST(PrioritySolver, HeldSpeedsKeepTheirAccelerationAndTheOthersAllowForIt) {
  Random random(7, 1);
  const MatrixXd M = random_mass(random, 12), J = random_matrix(random, 4, 12);
  const VectorXd r = random_matrix(random, 4, 1);
  auto held = kNothingHeld;
  held[2] = held[9] = 1;
  VectorXd a = VectorXd::Zero(12);
  a[2] = 3.0;
  a[9] = -2.0;
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(M, held, a));
  solver.add_level(J, r, kExact);
  EXPECT_EQ(solver.acceleration()[2], 3.0);
  EXPECT_EQ(solver.acceleration()[9], -2.0);
  EXPECT_LT(apart(times(J, solver.acceleration()), r), 1e-9);
  const MatrixXd tall = random_matrix(random, 30, 12);
  const VectorXd wide = random_matrix(random, 30, 1);
  PrioritySolver rows(12), full(12);
  ASSERT_TRUE(rows.begin(M, held, a) && full.begin(M, held, a));
  rows.add_level(tall, wide, kExact);
  ASSERT_TRUE(full.add_full_level(times(transposed(tall), tall), times(transposed(tall), wide), 0.0, 1e-3));
  EXPECT_LT(apart(rows.acceleration(), full.acceleration()), 1e-9);
}

TEST(PrioritySolver, RefusesAMassMatrixThatIsNone) {
  PrioritySolver solver(12);
  MatrixXd M = MatrixXd::Identity(12, 12);
  M(4, 4) = 0.0;
  EXPECT_FALSE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
}

TEST(PrioritySolver, AllocatesNothingOnceItKnowsTheSizes) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  const Tasks t = random_tasks(3, 9);
  const VectorXd posture = VectorXd::Ones(12), zero = VectorXd::Zero(12);
  PrioritySolver solver(12);
  const auto once = [&] {
    solver.begin(t.M, kNothingHeld, zero);
    for (int i = 0; i < 3; ++i) solver.add_level(t.J[i], t.r[i], {});
    solver.add_posture(posture);
    return solver.acceleration()[0];
  };
  const double first = once();
  const auto before = testing_support::allocations_on_this_thread();
  EXPECT_EQ(once(), first);
  EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
}

// The oracle is the constrained motion M a = f + C' l with C a = 0, by the inverse of its matrix.
TEST(PrioritySolver, AForceFromOutsideMovesNoConstraintAndNothingThatIsHeld) {
  constexpr int kSpeeds = 12, kRows = 4, kHeld = 7;
  Random random(11, 1);
  const MatrixXd M = random_mass(random, kSpeeds), C = random_matrix(random, kRows, kSpeeds);
  const MatrixXd J = random_matrix(random, 5, kSpeeds), force = random_matrix(random, kSpeeds, 1);
  std::vector<std::uint8_t> held = kNothingHeld;
  held[kHeld] = 1;
  PrioritySolver solver(kSpeeds);
  const auto solve = [&](bool pushed) {
    EXPECT_TRUE(solver.begin(M, held, VectorXd::Zero(kSpeeds)));
    solver.add_level(C, VectorXd::Zero(kRows), kExact);
    const int constrained = solver.rank();
    solver.add_level(J, VectorXd::Ones(5), kExact);
    solver.add_posture(VectorXd::Ones(kSpeeds));
    if (pushed) solver.add_outside_force(force, constrained);
    return VectorXd(solver.acceleration());
  };
  const VectorXd alone = solve(false), added = solve(true) - alone;
  MatrixXd all = MatrixXd::Zero(kSpeeds + kRows + 1, kSpeeds + kRows + 1);
  MatrixXd right = MatrixXd::Zero(kSpeeds + kRows + 1, 1);
  for (int i = 0; i < kSpeeds; ++i) {
    right(i, 0) = force(i, 0);
    for (int j = 0; j < kSpeeds; ++j) all(i, j) = M(i, j);
    for (int k = 0; k < kRows; ++k) all(i, kSpeeds + k) = all(kSpeeds + k, i) = C(k, i);
  }
  all(kHeld, kSpeeds + kRows) = all(kSpeeds + kRows, kHeld) = 1.0;
  const MatrixXd expected = times(inverse(all), right);
  for (int i = 0; i < kSpeeds; ++i) EXPECT_NEAR(added[i], expected(i, 0), 1e-9);
  EXPECT_GT(length(added), 0.1);
  EXPECT_EQ(added[kHeld], 0.0);
  EXPECT_LT(length(times(C, added)), 1e-10);
}

}  // namespace
}  // namespace kinemark::motion::internal
