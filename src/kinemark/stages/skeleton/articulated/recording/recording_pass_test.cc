// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/recording_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"
#include "kinemark/stages/skeleton/articulated/testing/known_geometry.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;
using testing_limbs::hide;
using testing_limbs::known_geometry;
using testing_limbs::make_random_chain;
using testing_limbs::RandomChain;

TEST(RecordingPass, EveryFrameOfAnyNumberOfThreadsIsTheSolversOwn) {
  RandomChain limb = make_random_chain({.frames = 60, .missing = 0.3});
  const FittedChain fit = known_geometry(limb, 0.001);
  const RecordingPass one = pass_over(fit, limb.samples, 1, {}).value();
  ChainSolver solver(fit);
  ChainFrame frame;
  std::size_t flagged = 0;
  for (std::size_t f = 0; f < 60; ++f) {
    solver.solve(limb.samples.frame(static_cast<std::int64_t>(f)), nullptr, frame);
    EXPECT_EQ(one.state[0][f], frame.state[0]) << f;
    const bool several = frame.gathered[0] == Gathered::positions;
    if (several || frame.state[0] != CentreState::determined) {
      ASSERT_LT(flagged, one.flagged.size());
      EXPECT_EQ(one.flagged[flagged].gathered[0] != 0, several);
      EXPECT_EQ(one.flagged[flagged++].frame, static_cast<std::int64_t>(f));
    }
    if (frame.state[0] != CentreState::determined) {
      EXPECT_TRUE(one.points[0][f].information.isZero(0.0)) << "no position of its own";
    } else {
      EXPECT_LT((one.points[0][f].position - frame.centre[0]).norm(), 1e-7);
      EXPECT_LT((load_symmetric(one.covariance[0].data() + 6 * f) - frame.covariance[0]).norm(), 1e-9);
    }
  }
  EXPECT_EQ(flagged, one.flagged.size());
  EXPECT_TRUE(one.misfits.empty());
}

// Of 4,001 frames every other one is sampled; the joint is seen in one between.
TEST(RecordingPass, AJointSeenBetweenTheSampledFramesHasAPose) {
  RandomChain limb = make_random_chain({.frames = 1});
  const FittedChain fit = known_geometry(limb, 0.001);
  ChainSamples long_one{.frames = 4001, .markers = limb.samples.markers, .x = {}};
  long_one.x.assign(limb.samples.x.size() * 4001, std::nan(""));
  const auto at = limb.samples.x.size() * 1301;
  std::ranges::copy(limb.samples.x, long_one.x.begin() + static_cast<std::ptrdiff_t>(at));
  const RecordingPass pass = pass_over(fit, long_one, 1, {}).value();
  ASSERT_EQ(pass.sampled.size(), 1U);
  EXPECT_EQ(pass.sampled[0].frame, 1301);
  EXPECT_EQ(pass.sampled[0].known[0], 1);
}

TEST(RecordingPass, StopsWhenAsked) {
  const RandomChain limb = make_random_chain({.frames = 10});
  const auto pass = pass_over(known_geometry(limb, 0.001), limb.samples, 1,
                              [](std::int64_t, std::int64_t) { return false; });
  ASSERT_FALSE(pass.has_value());
  EXPECT_EQ(pass.error().code, Code::cancelled);
}

TEST(RecordingPass, AMarkerElsewhereMakesAMisfit) {
  RandomChain limb = make_random_chain({.markers_per_segment = 4, .frames = 10});
  limb.samples.x[3 * 8 * 6] += 0.03;
  const RecordingPass pass = pass_over(known_geometry(limb, 0.001), limb.samples, 1, {}).value();
  EXPECT_EQ(pass.misfits, std::vector<std::int64_t>{6});
  EXPECT_FALSE(is_misfit(limb.chain, 15e-6, 0.001, 8)) << "15 for 24 - 9 degrees of freedom";
  EXPECT_TRUE(is_misfit(limb.chain, 60e-6, 0.001, 8));
}

TEST(RecordingPass, ARecordingWithoutFramesIsEmpty) {
  RandomChain limb = make_random_chain({.frames = 1});
  limb.samples.frames = 0;
  limb.samples.x.clear();
  const RecordingPass pass = pass_over(known_geometry(limb, 0.001), limb.samples, 2, {}).value();
  EXPECT_TRUE(pass.state[0].empty());
  EXPECT_TRUE(pass.sampled.empty());
  EXPECT_TRUE(pass.flagged.empty());
}

TEST(RecordingPass, MarkersThatAreGoneLeaveEveryFrameUndetermined) {
  RandomChain limb = make_random_chain({.frames = 4});
  for (int f = 0; f < 4; ++f)
    for (int k = 0; k < 6; ++k) hide(limb.samples, f, k);
  const RecordingPass pass = pass_over(known_geometry(limb, 0.001), limb.samples, 1, {}).value();
  ASSERT_EQ(pass.flagged.size(), 4U);
  for (std::size_t f = 0; f < 4; ++f) {
    EXPECT_EQ(pass.state[0][f], CentreState::undetermined);
    EXPECT_TRUE(pass.flagged[f].modes.empty());
  }
  EXPECT_TRUE(pass.sampled.empty());
}

// The geometry's part of a covariance is what a geometry without uncertainty does not have.
TEST(RecordingPass, TheCommonPartIsTheGeometrysAlone) {
  const RandomChain limb = make_random_chain({.frames = 6});
  FittedChain fit = known_geometry(limb, 0.001);
  const RecordingPass exact = pass_over(fit, limb.samples, 1, {}).value();
  const auto n = fit.geometry_covariance.rows();
  fit.geometry_covariance = 1e-6 * Eigen::MatrixXd::Identity(n, n);
  const RecordingPass known = pass_over(fit, limb.samples, 1, {}).value();
  for (std::size_t i = 0; i < exact.common[0].size(); ++i) {
    EXPECT_EQ(exact.common[0][i], 0.0);
    EXPECT_NEAR(known.covariance[0][i], exact.covariance[0][i] + known.common[0][i], 1e-15);
  }
  EXPECT_GT(known.common[0][0], 0.0);
}

TEST(RecordingPass, FlaggedFramesListTheirPositionsBestFirst) {
  RandomChain limb = make_random_chain({.frames = 30});
  for (int f = 0; f < 30; ++f)
    for (const int k : {0, 3, 4}) hide(limb.samples, f, k);
  const RecordingPass pass = pass_over(known_geometry(limb, 0.001), limb.samples, 1, {}).value();
  int pairs = 0;
  for (const FlaggedFrame& flagged : pass.flagged) {
    double sum = 0.0;
    for (const auto& mode : flagged.modes) sum += std::exp(mode.log_weight);
    EXPECT_NEAR(sum, 1.0, 1e-9);
    pairs += flagged.modes.size() >= 2 ? 1 : 0;
  }
  EXPECT_GT(pairs, 15);
}

TEST(RecordingPass, ProgressEndsWithAllFrames) {
  const RandomChain limb = make_random_chain({.frames = 12});
  std::int64_t last = 0;
  const auto count = [&last](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 12);
    last = done;
    return true;
  };
  ASSERT_TRUE(pass_over(known_geometry(limb, 0.001), limb.samples, 1, count).has_value());
  EXPECT_EQ(last, 12);
}

}  // namespace
}  // namespace kinemark::skeleton::articulated
