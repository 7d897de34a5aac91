// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_slide.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/math/euler.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"

namespace kinemark::skeleton {
namespace {

constexpr double kSlide_m = 0.008;  ///< of a marker at one radian, SD per axis and component

/// A ball joint in a cone of 1 rad, 0.5 mm of noise; with skin, every marker of the lower segment slides in
/// proportion to the rotation, and all of them together by as much.
testing::TestChain ball(bool with_skin, std::uint64_t seed) {
  auto chain = testing::make_chain({.frames = 300,
                                    .per_segment = 4,
                                    .stagger_m = 0.06,  // as far from the bone as on a thigh
                                    .rotations = testing::Rotations::cone,
                                    .noise_sd_m = 0.0005,
                                    .seed = seed});
  if (!with_skin) return chain;
  Random random(seed, 77);
  const auto draw = [&] {
    Eigen::Matrix3d out;
    for (int i = 0; i < 9; ++i) out(i / 3, i % 3) = 2.5 * kSlide_m * random.gaussian();
    return out;
  };
  const Eigen::Matrix3d together = draw();
  for (const int m : chain.layout.segments[1].markers) {
    const Eigen::Matrix3d own = together + draw();
    for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
      const auto& R = chain.world_from_segment[1][static_cast<std::size_t>(f)];
      const Eigen::Vector3d q =
          math::log_so3(chain.world_from_segment[0][static_cast<std::size_t>(f)].transpose() * R);
      chain.markers.x(f, m) += R * (own * q);
    }
  }
  return chain;
}

TEST(SkinSlide, IsNotFoundInFewFrames) {
  const SegmentPoses none;
  EXPECT_FALSE(measure_skin_slide(none, none, {}, Matrix6::Identity(), Vector6::Zero()).known);
}

TEST(SkinSlide, IsFoundWhereThereIsOneAndNotWhereThereIsNone) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const bool with_skin : {false, true}) {
      const testing::JointSetup setup(ball(with_skin, seed));
      const JointFit fit =
          fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, data::JointKind::ball);
      if (with_skin)
        EXPECT_GT(fit.slide_share, 0.9) << seed;
      else
        EXPECT_LT(fit.slide_share, 0.5) << seed;
    }
}

TEST(SkinSlide, IsNearerToTheErrorThanScatter) {
  double by_slide = 0.0, by_scatter = 0.0, n = 0.0;
  for (std::uint64_t seed = 11; seed <= 40; ++seed) {
    const testing::JointSetup setup(ball(true, seed));
    const JointFit fit =
        fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, data::JointKind::ball);
    Eigen::Vector3d error = Eigen::Vector3d::Zero();
    for (const std::int64_t f : setup.task.motion.frames)
      error += setup.child.to_segment(f, setup.chain.centres[0].col(f)) - fit.centre.tail<3>();
    error /= static_cast<double>(setup.task.motion.frames.size());
    for (int axis = 0; axis < 3; ++axis) {
      by_slide += error(axis) * error(axis) / fit.covariance(3 + axis, 3 + axis);
      by_scatter += error(axis) * error(axis) / fit.scatter(3 + axis, 3 + axis);
      n += 1.0;
    }
  }
  // How well it covers is asked of legs, in tests/acceptance/joints_skin.py.
  EXPECT_LT(by_slide, by_scatter);
  EXPECT_GT(by_scatter / n, 4.0) << "blocks of frames all show the same slide";
}

TEST(SkinSlide, PartsShareMostOfIt) {
  double repeated = 0.0, all = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const testing::JointSetup setup(ball(true, seed));
    const JointFit fit =
        fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, data::JointKind::ball);
    EXPECT_GT(fit.repeatability.trace(), 0.0) << seed;
    EXPECT_LT(fit.repeatability.trace(), fit.covariance.trace()) << seed;
    repeated += fit.repeatability.trace();
    all += fit.covariance.trace();
  }
  EXPECT_LT(repeated, 0.7 * all);
}

TEST(SkinSlide, WithoutASlidePartsDifferByAllThereIs) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const testing::JointSetup setup(ball(false, seed));
    const JointFit fit =
        fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, data::JointKind::ball);
    EXPECT_EQ(fit.repeatability, fit.covariance) << seed;
  }
}

TEST(SkinSlide, AHingeRepeatsToANumber) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const testing::JointSetup setup(testing::make_chain({.frames = 120,
                                                         .per_segment = 4,
                                                         .stagger_m = 0.06,
                                                         .rotations = testing::Rotations::hinge,
                                                         .range_rad = 1.2,
                                                         .noise_sd_m = 0.002,
                                                         .seed = seed}));
    const SkinSlide slide = measure_skin_slide(
        setup.parent, setup.child, setup.task.motion,
        // A direction that the motion leaves open, with the rounding that an inverse leaves there.
        Matrix6(Eigen::Matrix<double, 6, 1>(-1e-20, 0.01, 0.01, 0.01, 0.01, 0.01).asDiagonal()),
        Vector6::Zero(), data::JointKind::hinge);
    EXPECT_TRUE(slide.known && slide.repeatability.allFinite()) << seed;
  }
}

TEST(SkinSlide, AHingeWithoutNoiseHasNone) {
  // The place along the axis has no information but rounding, which may be below nothing.
  for (const double range_rad : {0.001, 0.1, 1.2})
    for (const double noise_sd_m : {0.0, 1e-12, 1e-9})
      for (const std::int64_t frames : {40, 120}) {
        const testing::JointSetup setup({.frames = frames,
                                         .per_segment = 4,
                                         .rotations = testing::Rotations::hinge,
                                         .range_rad = range_rad,
                                         .noise_sd_m = noise_sd_m});
        for (const auto kind : {data::JointKind::hinge, data::JointKind::ball}) {
          const JointFit fit = fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, kind);
          EXPECT_LT(fit.slide_share, 0.5) << range_rad << " rad, noise " << noise_sd_m << ", " << frames;
          EXPECT_TRUE(fit.covariance.allFinite() && fit.repeatability.allFinite());
        }
      }
}

TEST(SkinSlide, APriorThatExpectsMoreWidensAHinge) {
  const auto chain = testing::make_chain({.frames = 300,
                                          .per_segment = 4,
                                          .stagger_m = 0.06,
                                          .rotations = testing::Rotations::hinge,
                                          .range_rad = 1.2,
                                          .noise_sd_m = 0.002});
  const testing::JointSetup setup(chain);
  const auto axis_sd = [&](double turn) {
    return fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, data::JointKind::hinge,
                     {.turn = turn})
        .axis_sd_rad;
  };
  EXPECT_GT(axis_sd(0.2), 1.5 * axis_sd(0.05));
}

}  // namespace
}  // namespace kinemark::skeleton
