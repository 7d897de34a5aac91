// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/skin_slide.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/testing/joint_setup.h"
#include "kinemark/stages/skeleton/functional/testing/swinging_joint.h"

namespace kinemark::skeleton {
namespace {

TEST(SkinPrior, DefaultsAreUsable) { EXPECT_TRUE(SkinPrior{}.check()); }

TEST(SkinPrior, RefusesWhatIsNoSize) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(SkinPrior{.ball = bad}.check());
    EXPECT_FALSE(SkinPrior{.hinge = bad}.check());
    EXPECT_FALSE(SkinPrior{.misfit = bad}.check());
    EXPECT_FALSE(SkinPrior{.anywhere = bad}.check());
  }
  EXPECT_FALSE(SkinPrior{.ball_factor = 1.0}.check());
  EXPECT_FALSE(SkinPrior{.hinge_factor = 0.5}.check());
  EXPECT_FALSE(SkinPrior{.anywhere = 1.0}.check());
}

/// A joint found by least squares, and what skin does to it.
struct Fitted {
  testing::JointSetup setup;
  JointFit score;
  SkinSlide slide;

  explicit Fitted(const testing::SwingSetup& swings, const SkinPrior& prior = {})
      : setup(testing::make_swings(swings)),
        score(fit_score(setup.samples, setup.parent, setup.child, setup.task.motion,
                        swings.hinge ? data::JointKind::hinge : data::JointKind::ball)),
        slide(measure_skin_slide(setup.samples, setup.parent, setup.child, setup.task.motion, score, prior)) {
  }

  /// Error of the expected place, and covariance about the place of least squares.
  [[nodiscard]] Eigen::Vector3d expected_error() const { return error() + slide.shift.tail<3>(); }
  [[nodiscard]] Matrix6 about() const { return slide.covariance + slide.shift * slide.shift.transpose(); }

  /// Error of least squares in the child's axes; for a hinge across the axis.
  [[nodiscard]] Eigen::Vector3d error() const {
    Eigen::Vector3d truth = Eigen::Vector3d::Zero();
    for (const std::int64_t f : setup.task.motion.frames)
      truth += setup.child.to_segment(f, setup.chain.centres[0].col(f));
    const Eigen::Vector3d off =
        score.centre.tail<3>() - truth / static_cast<double>(setup.task.motion.frames.size());
    return off - score.axis_in_child * score.axis_in_child.dot(off);
  }
};

TEST(SkinSlide, IsNotLookedForInFewFramesOrInExactOnes) {
  const testing::JointSetup exact(testing::make_swings({.noise_sd_m = 0.0}));
  const auto fit =
      fit_score(exact.samples, exact.parent, exact.child, exact.task.motion, data::JointKind::ball);
  EXPECT_FALSE(measure_skin_slide(exact.samples, exact.parent, exact.child, exact.task.motion, fit).known);
  const testing::JointSetup few({.frames = 39, .per_segment = 4, .noise_sd_m = 0.001});
  const auto of_few = fit_score(few.samples, few.parent, few.child, few.task.motion, data::JointKind::ball);
  EXPECT_FALSE(measure_skin_slide(few.samples, few.parent, few.child, few.task.motion, of_few).known);
  JointFit kept = of_few;
  widen_by_skin(few.samples, few.parent, few.child, few.task.motion, kept);
  EXPECT_EQ(kept.covariance, of_few.covariance);
}

TEST(SkinSlide, RigidMarkersHaveTheErrorOfNoise) {
  for (const bool hinge : {false, true}) {
    double squares = 0.0, stated = 0.0, least = 0.0, wider = 0.0;
    int by_noise = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Fitted fitted({.hinge = hinge, .noise_sd_m = 0.001, .seed = seed});
      ASSERT_TRUE(fitted.slide.known);
      EXPECT_GT(fitted.slide.none, 0.3) << seed;
      by_noise += fitted.slide.prior_share == 0.0;
      squares += fitted.expected_error().squaredNorm();
      stated += fitted.slide.covariance.bottomRightCorner<3, 3>().trace();
      least += fitted.error().squaredNorm();
      wider += fitted.about().bottomRightCorner<3, 3>().trace();
    }
    EXPECT_GE(by_noise, 7) << hinge << ": where the markers hide no slide of a size that matters";
    EXPECT_GT(std::sqrt(stated / squares), 0.7) << hinge;
    EXPECT_LT(std::sqrt(stated / squares), 1.6) << hinge;
    EXPECT_GT(std::sqrt(wider / least), 0.7) << hinge;
    EXPECT_LT(std::sqrt(wider / least), 2.2) << hinge;
  }
}

TEST(SkinSlide, SlidingMarkersHaveTheErrorOfSlides) {
  for (const bool hinge : {false, true}) {
    double by_slide = 0.0, by_scatter = 0.0, n = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Fitted fitted({.hinge = hinge, .own_slide_m = 0.006, .common_slide_m = 0.006, .seed = seed});
      EXPECT_LT(fitted.slide.none, 1e-6) << seed;
      EXPECT_GT(fitted.slide.own_child_m, 4.0 * fitted.slide.own_parent_m) << seed;
      const Eigen::Vector3d error = fitted.error();
      by_slide += error.squaredNorm() / fitted.about().bottomRightCorner<3, 3>().trace();
      by_scatter += error.squaredNorm() / fitted.score.scatter.bottomRightCorner<3, 3>().trace();
      n += 1.0;
    }
    // How well it covers is asked of limbs, in tests/acceptance/accept_skin.cc.
    EXPECT_LT(by_slide / n, 2.0) << hinge;
    EXPECT_GT(by_scatter / n, 5.0) << hinge << ": movements all show the same slide";
  }
}

TEST(SkinSlide, HalfWayToTheExpectedPlaceIsNearerThanLeastSquares) {
  for (const bool hinge : {false, true})
    for (const double common_slide_m : {0.0, 0.008}) {
      double half_way = 0.0, expected = 0.0, least = 0.0;
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Fitted fitted(
            {.hinge = hinge, .own_slide_m = 0.004, .common_slide_m = common_slide_m, .seed = seed});
        half_way += (fitted.error() + 0.5 * fitted.slide.shift.tail<3>()).squaredNorm();
        expected += fitted.expected_error().squaredNorm();
        least += fitted.error().squaredNorm();
      }
      EXPECT_LT(half_way, least) << hinge << " " << common_slide_m;
      if (common_slide_m > 0.0) {
        EXPECT_LT(expected, half_way) << hinge << ": slides are as the model has them";
      }
    }
}

TEST(SkinSlide, MovementsShareMostOfIt) {
  // Arcs in many directions differ by more than swings about one axis, which all show the same.
  for (const auto& [hinge, share] : {std::pair{false, 0.7}, {true, 0.01}}) {
    double repeated = 0.0, all = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Fitted fitted({.hinge = hinge, .own_slide_m = 0.006, .common_slide_m = 0.006, .seed = seed});
      EXPECT_TRUE(fitted.slide.repeatability.allFinite());
      repeated += fitted.slide.repeatability.trace();
      all += fitted.about().trace();
    }
    EXPECT_GT(repeated, 0.0);
    EXPECT_LT(repeated, share * all) << hinge;
  }
}

TEST(SkinSlide, AHingeOfSmallSwingsIsPriorDominatedAndNothingIsSaidAlongIt) {
  int dominated = 0, of_a_ball = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Fitted fitted(
        {.hinge = true, .range_rad = 0.25, .own_slide_m = 0.006, .common_slide_m = 0.006, .seed = seed});
    dominated += fitted.slide.prior_share > 0.5;
    const Fitted ball({.own_slide_m = 0.006, .common_slide_m = 0.006, .seed = seed});
    of_a_ball += ball.slide.prior_share > 0.5;
    EXPECT_LT(std::abs(fitted.slide.shift.head<3>().dot(fitted.score.axis_in_parent)), 1e-12);
    EXPECT_LT((fitted.slide.covariance.topLeftCorner<3, 3>() * fitted.score.axis_in_parent).norm(), 1e-12);
  }
  EXPECT_GE(dominated, 4) << "a slide in proportion to a small angle leaves no trace";
  EXPECT_LE(of_a_ball, 1) << "arcs of many directions tell it";
}

TEST(SkinSlide, APriorThatExpectsMoreIsWider) {
  const testing::SwingSetup hinge{.hinge = true, .own_slide_m = 0.006};
  EXPECT_GT(Fitted(hinge, {.hinge = 3.0}).slide.covariance.trace(),
            1.5 * Fitted(hinge, {.hinge = 0.7}).slide.covariance.trace());
}

TEST(SkinSlide, MissingMarkersAndPosesWithoutAPathAreNoHindrance) {
  for (const auto rotations : {testing::Rotations::cone, testing::Rotations::hinge})
    for (const double range_rad : {0.001, 0.1, 1.2})
      for (const double noise_sd_m : {1e-9, 0.001}) {
        const testing::JointSetup setup({.frames = 300,
                                         .per_segment = 4,
                                         .stagger_m = 0.06,
                                         .rotations = rotations,
                                         .range_rad = range_rad,
                                         .noise_sd_m = noise_sd_m,
                                         .missing = 0.1});
        for (const auto kind : {data::JointKind::ball, data::JointKind::hinge}) {
          JointFit fit = fit_score(setup.samples, setup.parent, setup.child, setup.task.motion, kind);
          widen_by_skin(setup.samples, setup.parent, setup.child, setup.task.motion, fit);
          EXPECT_TRUE(fit.covariance.allFinite() && fit.repeatability.allFinite()) << range_rad;
          EXPECT_NE(fit.skin.verdict, data::SkinVerdict::follows) << range_rad;
        }
      }
}

}  // namespace

}  // namespace kinemark::skeleton
