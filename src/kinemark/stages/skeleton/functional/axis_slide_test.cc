// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/axis_slide.h"

#include <gtest/gtest.h>

#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"

namespace kinemark::skeleton {
namespace {

/// A hinge without skin.
testing::TestChain hinge(std::int64_t frames, double noise_sd_m) {
  return testing::make_chain({.frames = frames,
                              .per_segment = 4,
                              .rotations = testing::Rotations::hinge,
                              .range_rad = 1.2,
                              .noise_sd_m = noise_sd_m});
}

Eigen::Matrix3d covariance_of(const testing::TestChain& chain, const Eigen::Vector3d& axis,
                              const SkinPrior& prior) {
  const testing::JointSetup setup(chain);
  return axis_slide_covariance(setup.samples, setup.parent, setup.child, setup.task.motion, axis, prior);
}

TEST(AxisSlide, TiltsAnAxisByTheTurnThatDeformationTells) {
  auto chain = testing::make_chain({.frames = 300,
                                    .per_segment = 4,
                                    .rotations = testing::Rotations::hinge,
                                    .range_rad = 1.2,
                                    .noise_sd_m = 0.0002});
  const auto tilt = [&] {
    const testing::JointSetup setup(chain);
    const JointFit fit = fit_score(setup.samples, setup.parent, setup.child, setup.task.motion,
                                   data::JointKind::hinge, {.turn = 1e-6});
    EXPECT_NEAR((fit.axis_covariance * fit.axis_in_parent).norm(), 0.0, 0.05 * fit.axis_covariance.norm());
    return fit.axis_sd_rad;
  };
  const double without = tilt();
  // One marker moves on its segment in proportion to the angle.
  const int m = chain.layout.segments[1].markers[0];
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
    const auto& R = chain.world_from_segment[1][static_cast<std::size_t>(f)];
    const double angle =
        math::log_so3(chain.world_from_segment[0][static_cast<std::size_t>(f)].transpose() * R).x();
    chain.markers.x(f, m) += R * Eigen::Vector3d(0.0, 0.0, 0.01 * angle);
  }
  EXPECT_GT(tilt(), 5.0 * without);
}

TEST(AxisSlide, RigidMarkersLeaveThePriorsShare) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  const SkinPrior prior{.turn = 0.1, .turn_weight = 4.0};
  const Eigen::Matrix3d C = covariance_of(hinge(300, 0.0), axis, prior);
  // Four markers on either side: 12 numbers that show nothing, 4 that say 0.1.
  EXPECT_NEAR(C(1, 1), 0.01 * 4.0 / 16.0, 1e-6);
  EXPECT_NEAR(C(2, 2), 0.01 * 4.0 / 16.0, 1e-6);
  EXPECT_NEAR((C * axis).norm(), 0.0, 1e-12) << "nothing along the axis";
}

TEST(AxisSlide, TooFewFramesTellNothing) {
  EXPECT_EQ(covariance_of(hinge(39, 0.001), Eigen::Vector3d::UnitX(), {}), Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace kinemark::skeleton
