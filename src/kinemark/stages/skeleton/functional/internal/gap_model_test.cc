// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/gap_model.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton::internal {
namespace {

GapModel model_of(const testing::JointSetup& setup) {
  const auto& frames = setup.task.motion.frames;
  return gap_model(setup.parent, setup.child, setup.task.motion,
                   posture_of(setup.parent, setup.child, setup.task.motion, frames, 50.0));
}

Eigen::Vector3d truth_in_child(const testing::JointSetup& setup) {
  return setup.child.to_segment(0, setup.chain.centres[0].col(0));
}

TEST(GapModel, IsLinearisedAtTheJoint) {
  const testing::JointSetup setup(testing::make_swings({.noise_sd_m = 0.0}));
  const auto model = model_of(setup);
  // Its prior weighs a ten-thousandth of a frame.
  EXPECT_LT((model.about.tail<3>() - truth_in_child(setup)).norm(), 3e-3);
  EXPECT_EQ(model.design.cols(), kGapSize);
  EXPECT_EQ(model.blocks.rows(), 3 * (800 / model.posture.block));
  EXPECT_GT(model.posture.block, 1);
}

TEST(GapModel, AChangeOfTheJointExplainsWhatIsLeft) {
  const testing::JointSetup setup(testing::make_swings({.noise_sd_m = 0.0}));
  const auto model = model_of(setup);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(kGapSize);
  change.head<3>() = setup.parent.to_segment(0, setup.chain.centres[0].col(0)) - model.about.head<3>();
  change.segment<3>(3) = truth_in_child(setup) - model.about.tail<3>();
  EXPECT_LT(model.residual(change).cwiseAbs().maxCoeff(), 2e-4)
      << "the smoothed posture is nearly the measured one";
  EXPECT_GT(model.residual(Eigen::VectorXd::Zero(kGapSize)).norm(), model.residual(change).norm());
}

TEST(GapModel, ASlideOfTheJointIsALinearTerm) {
  const testing::JointSetup setup(testing::make_swings({.noise_sd_m = 0.0, .joint_slide_m = 0.02}));
  const auto model = model_of(setup);
  const Eigen::MatrixXd linear = model.design.leftCols(6 + 3 * kLinearTerms);
  const Eigen::VectorXd x = linear.colPivHouseholderQr().solve(model.gap);
  EXPECT_LT((model.gap - linear * x).norm(), 0.1 * model.gap.norm());
}

}  // namespace
}  // namespace kinemark::skeleton::internal
