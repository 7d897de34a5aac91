// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/scale_free.h"

#include <gtest/gtest.h>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

Eigen::Vector4d draw(Random& random, double low, double high) {
  Eigen::Vector4d out;
  for (double& x : out) x = random.uniform(low, high);
  return out;
}

TEST(ScaleFree, BasisIsOrthonormalAndAtRightAnglesToTheShares) {
  Random random(7, 1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector4d shares = draw(random, -1.0, 1.0), readings = draw(random, 0.0, 1000.0);
    const auto free = eliminate_scale(readings, shares);
    EXPECT_LT((free.basis * free.basis.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((free.basis * shares).norm(), 1e-14);
    EXPECT_NEAR(free.residual.squaredNorm(), (readings - free.scale * shares).squaredNorm(),
                1e-9 * readings.squaredNorm());
  }
}

TEST(ScaleFree, DerivativeMeetsFiniteDifferencesOfTheMisfit) {
  Random random(7, 2);
  const Eigen::Vector4d shares = draw(random, 0.1, 0.5), readings = 1000.0 * shares + draw(random, -1.0, 1.0);
  const auto at = eliminate_scale(readings, shares);
  for (int k = 0; k < 4; ++k) {
    const double step = 1e-6;
    Eigen::Vector4d more = shares, less = shares;
    more(k) += step;
    less(k) -= step;
    const double slope = (eliminate_scale(readings, more).residual.squaredNorm() -
                          eliminate_scale(readings, less).residual.squaredNorm()) /
                         (2.0 * step);
    // The gradient of the squared misfit is exact: what the derivative leaves out is at right angles to the
    // residual.
    EXPECT_NEAR(-2.0 * at.scale * at.residual.dot(at.basis.col(k)), slope, 1e-4 * std::abs(slope) + 1e-3);
  }
}

}  // namespace
}  // namespace kinemark::math
