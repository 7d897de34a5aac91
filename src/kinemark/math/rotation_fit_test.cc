// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/rotation_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

Vector3d draw(Random& random) {
  return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
}

Eigen::Matrix3Xd cloud(Random& random, Eigen::Index n) {
  Eigen::Matrix3Xd out(3, n);
  for (Eigen::Index i = 0; i < n; ++i) out.col(i) = draw(random);
  return out;
}

SE3 any_motion(Random& random) {
  const Vector3d v = draw(random);
  return {Eigen::AngleAxisd(3.0 * v.norm(), v.normalized()).toRotationMatrix(), draw(random)};
}

Eigen::Matrix3Xd moved(const SE3& motion, const Eigen::Matrix3Xd& x) {
  return (motion.rotation * x).colwise() + motion.translation;
}

double misfit(const SE3& motion, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& y) {
  return (y - moved(motion, x)).squaredNorm();
}

TEST(RotationFit, FindsTheMotionOfPointsWithoutNoise) {
  Random random(3, 1);
  for (int i = 0; i < 50; ++i) {
    const SE3 truth = any_motion(random);
    const auto x = cloud(random, 3 + i % 4);
    const RigidFit fit = fit_rigid(x, moved(truth, x));
    EXPECT_LT((fit.target_from_source.rotation - truth.rotation).norm(), 1e-12);
    EXPECT_LT((fit.target_from_source.translation - truth.translation).norm(), 1e-12);
    EXPECT_TRUE(fit.rotation.determined());
    // Three points lie in a plane: there, a reflection fits as well.
    if (x.cols() > 3) {
      EXPECT_FALSE(fit.rotation.mirrored);
    }
  }
}

TEST(RotationFit, NoSmallMotionFitsNoisyPointsBetter) {
  Random random(3, 2);
  for (int i = 0; i < 20; ++i) {
    const auto x = cloud(random, 6);
    const Eigen::Matrix3Xd y = moved(any_motion(random), x) + 0.3 * cloud(random, 6);
    const SE3 best = fit_rigid(x, y).target_from_source;
    EXPECT_LT((best.rotation * best.rotation.transpose() - Matrix3d::Identity()).norm(), 1e-13);
    for (int k = 0; k < 6; ++k)
      for (const double step : {-1e-3, 1e-3}) {
        SE3 other = best;
        if (k < 3)
          other.rotation = Eigen::AngleAxisd(step, Vector3d::Unit(k)).toRotationMatrix() * best.rotation;
        else
          other.translation[k - 3] += step;
        if (k < 3) other.translation = y.rowwise().mean() - other.rotation * x.rowwise().mean();
        EXPECT_GT(misfit(other, x, y), misfit(best, x, y));
      }
  }
}

TEST(RotationFit, PointsOnALineLeaveTheTurnAboutItOpen) {
  Random random(3, 3);
  Eigen::Matrix3Xd x(3, 4);
  const Vector3d along = draw(random);
  for (Eigen::Index i = 0; i < 4; ++i) x.col(i) = static_cast<double>(i * i) * along;
  const SE3 truth = any_motion(random);
  const RigidFit fit = fit_rigid(x, moved(truth, x));
  EXPECT_FALSE(fit.rotation.determined());
  EXPECT_NEAR(fit.rotation.rotation.determinant(), 1.0, 1e-12);
  EXPECT_LT((fit.rotation.rotation * along - truth.rotation * along).norm(), 1e-12);
}

TEST(RotationFit, TellsMirrorImagesAndStaysARotation) {
  Random random(3, 4);
  const auto x = cloud(random, 5);
  Eigen::Matrix3Xd y = x;
  y.row(0) *= -1.0;
  const RigidFit fit = fit_rigid(x, y);
  EXPECT_TRUE(fit.rotation.mirrored);
  EXPECT_NEAR(fit.rotation.rotation.determinant(), 1.0, 1e-12);

  // The mirror image of what is as wide in all directions: all half turns fit alike.
  EXPECT_FALSE(fit_rotation(Vector3d(-1.0, 1.0, 1.0).asDiagonal()).determined());
  EXPECT_NEAR(fit_rotation(Vector3d(-1.0, 2.0, 4.0).asDiagonal()).margin, 0.25, 1e-15);
}

TEST(RotationFit, NothingToFitIsNoRotation) {
  const RotationFit fit = fit_rotation(Matrix3d::Zero());
  EXPECT_FALSE(fit.determined());
  EXPECT_NEAR(fit.rotation.determinant(), 1.0, 1e-12);
  EXPECT_ANY_THROW((void)fit_rigid(Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0)));
}

}  // namespace
}  // namespace kinemark::math
