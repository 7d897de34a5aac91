// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/centre_errors.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::studies {
namespace {

using data::CentreState;

struct Example {
  simulation::LimbRecording limb;
  data::Skeleton skeleton;
  skeleton::CentreBound bound;

  /// Four frames; the centre is off along x by 0, 1, 3 and 60 mm with an SD of 2 mm per axis.
  Example() {
    limb = simulation::simulate_chain({.frames = 4}).value();
    skeleton.time = limb.markers.time;
    skeleton.joints.resize(1);
    skeleton.allocate_centres();
    bound.covariance.assign(24, 0.0);
    bound.determined.assign(4, 1);
    for (std::size_t f = 0; f < 4; ++f) {
      for (std::size_t a = 0; a < 3; ++a)
        skeleton.centre_in_world[3 * f + a] = limb.centre_in_world[3 * f + a];
      skeleton.centre_in_world[3 * f] += std::array{0.0, 0.001, 0.003, 0.060}[f];
      for (const std::size_t c : {0U, 1U, 2U, 3U, 4U, 5U}) skeleton.covariance[6 * f + c] = 0.0;
      for (const std::size_t c : math::kSymmetric3Diagonal) {
        skeleton.covariance[6 * f + c] = 4e-6;
        bound.covariance[6 * f + c] = 1e-6;
      }
      skeleton.state[f] = CentreState::determined;
    }
  }
};

TEST(CentreErrors, AddUpWhatIsAsked) {
  Example e;
  e.skeleton.state[3] = CentreState::ambiguous;
  e.bound.determined[2] = 0;
  const auto errors = judge_centres(e.skeleton, e.limb, &e.bound);
  EXPECT_EQ(errors.frames, 4);
  EXPECT_EQ(errors.answered, 4);
  EXPECT_EQ(errors.determined, 3);
  EXPECT_NEAR(errors.rms_answered_m(), std::sqrt((1e-6 + 9e-6 + 3600e-6) / 4.0), 1e-12);
  EXPECT_NEAR(errors.rms_determined_m(), std::sqrt(10e-6 / 3.0), 1e-12);
  EXPECT_EQ(errors.ambiguous, 1);
  EXPECT_EQ(errors.share_decided(), 0.75);
  EXPECT_EQ(errors.bridged, 0);
  EXPECT_TRUE(std::isnan(errors.rms_bridged_m()));
  EXPECT_EQ(errors.determined_without_bound, 1) << "left out of the ratio, and counted";
  EXPECT_EQ(errors.folded, 0);
  EXPECT_EQ(errors.bounded, 2);
  EXPECT_NEAR(errors.bound_m(), std::sqrt(3e-6), 1e-12);
  EXPECT_NEAR(errors.over_bound(), std::sqrt(1e-6 / 6e-6), 1e-9);
  EXPECT_EQ(errors.beyond_5sd, 1);
  EXPECT_EQ(errors.beyond_5sd_determined, 0);
  EXPECT_EQ(errors.coordinates, 9);
  EXPECT_EQ(errors.within_1sd, 8);
  EXPECT_EQ(errors.within_2sd, 9);
}

TEST(CentreErrors, FarOffAndCalledDetermined) {
  const Example e;
  const auto errors = judge_centres(e.skeleton, e.limb, nullptr);
  EXPECT_EQ(errors.beyond_5sd_determined, 1);
  EXPECT_EQ(errors.bounded, 0);
  EXPECT_TRUE(std::isnan(errors.over_bound()));
}

TEST(CentreErrors, NearAFoldTheCentresOwnDeviationStandsForTheBound) {
  Example e;
  for (const std::size_t c : math::kSymmetric3Diagonal) e.bound.covariance[6 + c] = 100e-6;
  const auto errors = judge_centres(e.skeleton, e.limb, &e.bound);
  EXPECT_EQ(errors.bounded, 4);
  EXPECT_EQ(errors.folded, 1);
  EXPECT_NEAR(errors.bound_squares, 3.0 * 3e-6 + 12e-6, 1e-15);
}

TEST(CentreErrors, BridgedFramesHaveAnErrorOfTheirOwn) {
  Example e;
  e.skeleton.state[2] = CentreState::bridged;
  const auto errors = judge_centres(e.skeleton, e.limb, nullptr);
  EXPECT_EQ(errors.bridged, 1);
  EXPECT_NEAR(errors.rms_bridged_m(), 0.003, 1e-12);
}

TEST(CentreErrors, WhatIsNotAnsweredIsNotCountedAndWhatHasNoCovarianceIsBeyondAll) {
  Example e;
  e.skeleton.state[0] = CentreState::undetermined;
  for (std::size_t c = 0; c < 24; ++c) e.skeleton.covariance[c] = std::nan("");
  const auto errors = judge_centres(e.skeleton, e.limb, nullptr);
  EXPECT_EQ(errors.answered, 3);
  EXPECT_EQ(errors.share_answered(), 0.75);
  EXPECT_EQ(errors.beyond_5sd, 3);
  EXPECT_EQ(errors.beyond_5sd_determined, 3);
  EXPECT_EQ(errors.coordinates, 9);
  EXPECT_EQ(errors.share_within_1sd(), 0.0);
}

TEST(CentreErrors, SumsOfTwoAreThoseOfBoth) {
  const Example e;
  const auto one = judge_centres(e.skeleton, e.limb, &e.bound);
  auto both = one;
  both += one;
  EXPECT_EQ(both.frames, 8);
  EXPECT_EQ(both.within_2sd, 2 * one.within_2sd);
  EXPECT_DOUBLE_EQ(both.rms_answered_m(), one.rms_answered_m());
  EXPECT_DOUBLE_EQ(both.over_bound(), one.over_bound());
}

TEST(CentreErrors, ShapesAgree) {
  Example e;
  e.limb = simulation::simulate_chain({.frames = 5}).value();
  EXPECT_THROW(static_cast<void>(judge_centres(e.skeleton, e.limb, nullptr)), ContractError);
}

}  // namespace
}  // namespace kinemark::studies
