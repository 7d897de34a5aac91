// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/internal/axis_slide.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace kinemark::skeleton::internal
