// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/priority_solver.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>

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

MatrixXd random_mass(Random& random, int n) {
  const MatrixXd a = random_matrix(random, n, n);
  return a * a.transpose() + 0.5 * MatrixXd::Identity(n, n);
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
VectorXd textbook(const Tasks& t, const VectorXd& posture) {
  const auto n = t.M.rows();
  const MatrixXd inverse = t.M.inverse();
  MatrixXd N = MatrixXd::Identity(n, n);
  VectorXd force = VectorXd::Zero(n);
  for (std::size_t i = 0; i < t.J.size(); ++i) {
    const MatrixXd J = t.J[i] * N;  // J restricted to what the levels above leave
    const MatrixXd lambda = (J * inverse * J.transpose()).inverse();
    const VectorXd rest = t.r[i] - t.J[i] * inverse * force;
    force += J.transpose() * lambda * rest;
    N = N * (MatrixXd::Identity(n, n) - inverse * J.transpose() * lambda * J);
  }
  return inverse * (force + N.transpose() * t.M * (posture - inverse * force));
}

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
      const VectorXd expected = textbook(t, posture);
      EXPECT_LT((solver.acceleration() - expected).norm(), 1e-9 * expected.norm()) << levels << ' ' << seed;
      EXPECT_EQ(solver.rank(), 3 * levels);
    }
}

TEST(PrioritySolver, LowerLevelsAndPostureDoNotMoveHigherOnes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Tasks t = random_tasks(3, seed);
    PrioritySolver solver(12);
    ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
    solver.add_level(t.J[0], t.r[0], kExact);
    const VectorXd alone = t.J[0] * solver.acceleration();
    solver.add_level(t.J[1], 1e3 * t.r[1], kExact);
    solver.add_level(t.J[2], 1e3 * t.r[2], kExact);
    solver.add_posture(VectorXd::Constant(12, 50.0));
    EXPECT_LT((t.J[0] * solver.acceleration() - alone).norm(), 1e-9 * 1e3);
    EXPECT_LT((t.J[1] * solver.acceleration() - 1e3 * t.r[1]).norm(), 1e-6);
  }
}

TEST(PrioritySolver, ATaskThatRepeatsAnUpperOneAddsNoRankAndNoHarm) {
  Tasks t = random_tasks(1, 5);
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(t.M, kNothingHeld, VectorXd::Zero(12)));
  solver.add_level(t.J[0], t.r[0], kExact);
  const VectorXd before = solver.acceleration();
  solver.add_level(2.0 * t.J[0], VectorXd::Constant(3, 7.0), {.damping = 0.0, .truncation = 1e-4});
  EXPECT_EQ(solver.rank(), 3);
  EXPECT_LT((solver.acceleration() - before).norm(), 1e-6 * before.norm());
}

TEST(PrioritySolver, MoreRowsThanSpeedsIsLeastSquares) {
  Random random(3, 1);
  const MatrixXd M = random_mass(random, 12), J = random_matrix(random, 40, 12);
  const VectorXd r = random_matrix(random, 40, 1);
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
  solver.add_level(J, r, kExact);
  const VectorXd expected = J.bdcSvd(Eigen::ComputeThinU | Eigen::ComputeThinV).solve(r);
  EXPECT_LT((solver.acceleration() - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(solver.rank(), 12);

  const VectorXd rows = solver.acceleration();
  ASSERT_TRUE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
  ASSERT_TRUE(solver.add_full_level(J.transpose() * J, J.transpose() * r, 0.0, 1e-3));
  EXPECT_LT((solver.acceleration() - rows).norm(), 1e-9 * rows.norm());
}

TEST(PrioritySolver, DampingIsTheSameWithAndWithoutRows) {
  Random random(4, 1);
  const MatrixXd M = random_mass(random, 12), J = random_matrix(random, 40, 12);
  const VectorXd r = random_matrix(random, 40, 1);
  PrioritySolver rows(12), full(12);
  ASSERT_TRUE(rows.begin(M, kNothingHeld, VectorXd::Zero(12)));
  ASSERT_TRUE(full.begin(M, kNothingHeld, VectorXd::Zero(12)));
  rows.add_level(J, r, {.damping = 0.5, .truncation = 1e-6});
  ASSERT_TRUE(full.add_full_level(J.transpose() * J, J.transpose() * r, 0.5, 1e-3));
  EXPECT_LT((rows.acceleration() - full.acceleration()).norm(), 1e-9);
}

TEST(PrioritySolver, AFullLevelThatLeavesADirectionOpenIsRefused) {
  Random random(6, 1);
  const MatrixXd M = random_mass(random, 12);
  MatrixXd J = random_matrix(random, 40, 12);
  J.col(7) = J.col(3);  // no row tells speed 3 from speed 7
  PrioritySolver solver(12);
  ASSERT_TRUE(solver.begin(M, kNothingHeld, VectorXd::Zero(12)));
  EXPECT_FALSE(solver.add_full_level(J.transpose() * J, VectorXd::Ones(12), 0.0, 1e-3));
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
  EXPECT_LT((J * solver.acceleration() - r).norm(), 1e-9);
  const MatrixXd tall = random_matrix(random, 30, 12);
  const VectorXd wide = random_matrix(random, 30, 1);
  PrioritySolver rows(12), full(12);
  ASSERT_TRUE(rows.begin(M, held, a) && full.begin(M, held, a));
  rows.add_level(tall, wide, kExact);
  ASSERT_TRUE(full.add_full_level(tall.transpose() * tall, tall.transpose() * wide, 0.0, 1e-3));
  EXPECT_LT((rows.acceleration() - full.acceleration()).norm(), 1e-9);
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
    return solver.acceleration().sum();
  };
  const double first = once();
  const auto before = testing_support::allocations_on_this_thread();
  EXPECT_EQ(once(), first);
  EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
}

}  // namespace
}  // namespace kinemark::motion::internal
