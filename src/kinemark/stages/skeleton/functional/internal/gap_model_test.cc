// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/gap_model.h"

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <cmath>
#include <numeric>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/functional/internal/cluster.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton::internal {
namespace {

struct Hinge {
  testing::JointSetup setup;
  ClusterPair clusters;
  Posture posture;
  JointFit fit;

  explicit Hinge(const testing::SwingSetup& swings)
      : setup(testing::make_swings(swings)),
        clusters(find_clusters(setup.samples, setup.parent, setup.child, setup.task.motion)),
        posture(posture_of(setup.parent, setup.child, setup.task.motion, clusters.frames, 50.0)),
        fit(fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, data::JointKind::hinge)) {}

  [[nodiscard]] Eigen::Matrix3d covariance(double own_m, double turn_m) const {
    return axis_slide_covariance({clusters.parent, 0.0, 0.0}, {clusters.child, own_m, turn_m},
                                 setup.task.motion, posture, fit);
  }
  [[nodiscard]] Eigen::Vector3d error() const {
    // The bone's axis in the axes that the markers give the segment, mean over frames: each has its noise.
    Eigen::Vector3d truth = Eigen::Vector3d::Zero();
    for (const std::int64_t f : setup.task.motion.frames) {
      const auto i = static_cast<std::size_t>(f);
      truth += setup.parent.world_from_segment[i].transpose() * setup.chain.world_from_segment[0][i].col(0);
    }
    truth.normalize();
    return fit.axis_in_parent * (fit.axis_in_parent.dot(truth) < 0.0 ? -1.0 : 1.0) - truth;
  }
};

TEST(AxisSlide, AlongTheAxisThereIsNothing) {
  const Hinge hinge({.hinge = true});
  EXPECT_LT((hinge.covariance(0.01, 0.01) * hinge.fit.axis_in_parent).norm(), 1e-15);
}

TEST(AxisSlide, ATurnOfTheClusterTiltsByItself) {
  const Hinge hinge({.hinge = true});
  const double radius = hinge.clusters.child.radius_m;
  const Eigen::Matrix3d by_turn = hinge.covariance(0.0, 0.01) - hinge.covariance(0.0, 0.0);
  EXPECT_NEAR(by_turn.trace(), 2.0 * 0.01 * 0.01 / (radius * radius), 1e-12);
  EXPECT_NEAR((hinge.covariance(0.02, 0.0) - hinge.covariance(0.0, 0.0)).trace(),
              4.0 * (hinge.covariance(0.01, 0.0) - hinge.covariance(0.0, 0.0)).trace(), 1e-12);
}

TEST(AxisSlide, WithoutSkinItIsTheErrorOfNoise) {
  double squares = 0.0, stated = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Hinge hinge({.hinge = true, .noise_sd_m = 0.001, .seed = seed});
    squares += hinge.error().squaredNorm();
    stated += hinge.covariance(0.0, 0.0).trace();
  }
  EXPECT_NEAR(std::sqrt(stated / squares), 1.0, 0.35);
}

/// Columns that keep so much of themselves from frame to frame.
Eigen::MatrixXd path(double keeps, Eigen::Index columns, std::uint64_t seed) {
  Random random(seed, 1);
  Eigen::MatrixXd out(20000, columns);
  for (Eigen::Index c = 0; c < columns; ++c)
    for (Eigen::Index i = 0; i < out.rows(); ++i)
      out(i, c) = (i == 0 ? 0.0 : keeps * out(i - 1, c)) + std::sqrt(1.0 - keeps * keeps) * random.gaussian();
  return out;
}

TEST(FramesAlike, IndependentErrorsCountEach) {
  EXPECT_NEAR(frames_alike(path(0.0, 3, 1), path(0.9, 3, 2)), 1.0, 0.15);
  EXPECT_NEAR(frames_alike(path(0.9, 3, 1), path(0.0, 3, 2)), 1.0, 0.15)
      << "a regressor that repeats nothing averages any error";
}

TEST(FramesAlike, TwoFirstOrderPathsCountByTheirProduct) {
  const double both = 0.9 * 0.8;
  EXPECT_NEAR(frames_alike(path(0.9, 6, 3), path(0.8, 6, 4)), (1.0 + both) / (1.0 - both), 0.7);
}

TEST(FramesAlike, IsOneAtLeastAndWhereNothingIsKnown) {
  EXPECT_EQ(frames_alike(path(-0.9, 1, 5), path(0.9, 1, 6)), 1.0);
  EXPECT_EQ(frames_alike(Eigen::MatrixXd::Zero(100, 3), path(0.9, 1, 6).topRows(100)), 1.0);
  EXPECT_EQ(frames_alike(Eigen::MatrixXd::Ones(5, 1), Eigen::MatrixXd::Ones(5, 1)), 1.0);
}

OwnSlide slide_of(const testing::SwingSetup& swings) {
  const testing::JointSetup setup(testing::make_swings(swings));
  const auto pair = find_clusters(setup.samples, setup.parent, setup.child, setup.task.motion);
  const auto posture = posture_of(setup.parent, setup.child, setup.task.motion, pair.frames, 50.0);
  return find_own_slide(deformation(setup.samples, setup.child, pair.child, posture.frames), posture,
                        pair.child.freedom());
}

TEST(OwnSlide, HasItsSize) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const OwnSlide found = slide_of({.own_slide_m = 0.008, .seed = seed});
    EXPECT_EQ(found.weight[0], 0.0) << seed;
    EXPECT_GE(found.limit_m, found.size_m) << seed;
    sum += found.size_m / 10.0;
  }
  EXPECT_NEAR(sum, 0.008, 0.002);
}

TEST(OwnSlide, RigidMarkersHaveNone) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const OwnSlide found = slide_of({.noise_sd_m = 0.001, .seed = seed});
    EXPECT_GT(found.weight[0], 0.5) << seed;
    EXPECT_LT(found.size_m, 0.5e-3) << seed;
    EXPECT_NEAR(std::sqrt(found.noise_variance), 0.001, 0.0002) << seed;
  }
}

TEST(OwnSlide, WhatMovesTheClusterAsOneBodyDoesNotShow) {
  EXPECT_LT(slide_of({.common_slide_m = 0.02}).size_m, 0.5e-3);
}

TEST(OwnSlide, ProbabilitiesAddUpToOne) {
  for (const double slide_m : {0.0, 0.001, 0.02}) {
    const auto found = slide_of({.own_slide_m = slide_m});
    EXPECT_NEAR(std::accumulate(found.weight.begin(), found.weight.end(), 0.0), 1.0, 1e-12);
  }
  EXPECT_EQ(slide_sizes()[0], 0.0);
  EXPECT_NEAR(slide_sizes().back(), 0.08, 1e-12);
}

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
