// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/reliability.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

// Shrout & Fleiss (1979), table 2: six targets, four judges.
const std::vector<double> kShroutFleiss{9, 2, 5, 8, 6,  1, 3, 2, 8, 4, 6, 8,
                                        7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7};

TEST(Reliability, ShroutAndFleissTheirTable) {
  const auto r = reliability({.subjects = 6, .sessions = 4, .values = kShroutFleiss});
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->agreement.value, 0.29, 0.005);
  EXPECT_NEAR(r->agreement.low, 0.019, 0.0005);
  EXPECT_NEAR(r->agreement.high, 0.761, 0.0005);
  EXPECT_NEAR(r->consistency.value, 0.71, 0.005);
  EXPECT_NEAR(r->consistency.low, 0.342, 0.0005);
  EXPECT_NEAR(r->consistency.high, 0.946, 0.0005);
  EXPECT_NEAR(r->sem.value, std::sqrt(1.02), 0.002);  // mean square of the error: 1.02
  EXPECT_NEAR(r->mdc, 1.96 * std::sqrt(2.0) * r->sem.value, 1e-4);
  EXPECT_GT(r->sem_agreement, r->sem.value);
  EXPECT_TRUE(std::isnan(r->sem_movement));
}

RepeatedMeasure simulated(std::uint64_t stream, double between, double within, double noise) {
  Random random(41, stream);
  RepeatedMeasure measure{.subjects = 15, .sessions = 3};
  for (int subject = 0; subject < 15; ++subject) {
    const double own = between * random.gaussian();
    for (int session = 0; session < 3; ++session) {
      measure.values.push_back(own + within * random.gaussian() + noise * random.gaussian());
      measure.noise_sd.push_back(noise);
    }
  }
  return measure;
}

TEST(Reliability, IntervalsCoverTheTruth) {
  int sem = 0, consistency = 0, agreement = 0;
  double movement = 0.0;
  constexpr int kTrials = 600;
  const double truth = 4.0 / (4.0 + 1.0 + 0.25);
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const auto r = reliability(simulated(trial, 2.0, 1.0, 0.5)).value();
    sem += r.sem.low <= std::sqrt(1.25) && std::sqrt(1.25) <= r.sem.high;
    consistency += r.consistency.low <= truth && truth <= r.consistency.high;
    agreement += r.agreement.low <= truth && truth <= r.agreement.high;
    movement += r.sem_movement * r.sem_movement / kTrials;
  }
  EXPECT_NEAR(sem, 570, 27);  // 5 SD of a binomial
  EXPECT_NEAR(consistency, 570, 27);
  EXPECT_NEAR(agreement, 570, 27);
  EXPECT_NEAR(movement, 1.0, 0.06);
}

TEST(Reliability, NoiseThatExplainsAllLeavesNoMovement) {
  auto measure = simulated(1, 2.0, 0.0, 0.5);
  for (double& sd : measure.noise_sd) sd = 1.0;
  const auto r = reliability(measure);
  EXPECT_EQ(r->sem_movement, 0.0);
  EXPECT_EQ(r->consistency_movement, 1.0);
  EXPECT_NEAR(r->noise, 1.0, 1e-12);
}

TEST(Reliability, SubjectsWithAMissingSessionAreLeftOut) {
  auto values = kShroutFleiss;
  values.insert(values.end(), {5, kNaN, 5, 5});
  const auto r = reliability({.subjects = 7, .sessions = 4, .values = values});
  EXPECT_EQ(r->subjects, 6);
  EXPECT_EQ(r->left_out, 1);
  EXPECT_NEAR(r->consistency.value, 0.71, 0.005);
}

TEST(Reliability, EqualSessionsAgreeWholly) {
  const auto r = reliability({.subjects = 3, .sessions = 2, .values = {1, 1, 2, 2, 3, 3}});
  EXPECT_EQ(r->agreement.value, 1.0);
  EXPECT_EQ(r->sem.value, 0.0);
  const auto shifted = reliability({.subjects = 3, .sessions = 2, .values = {1, 2, 2, 3, 3, 4}});
  EXPECT_EQ(shifted->consistency.value, 1.0);
  EXPECT_TRUE(std::isnan(shifted->agreement.value));
}

TEST(Reliability, WhatCannotBeWorkedOutIsSaid) {
  EXPECT_EQ(reliability({.subjects = 2, .sessions = 2, .values = {1, 2, 3}}).error().message,
            "2 subjects in 2 sessions have 3 values and 0 deviations; need 4, and as many or no deviations");
  EXPECT_EQ(reliability({.subjects = 2, .sessions = 2, .values = {1, 2, 3, kNaN}}).error().message,
            "1 subjects have a value in each of 2 sessions; need at least 2 subjects and 2 sessions");
  EXPECT_EQ(reliability({.subjects = 3, .sessions = 1, .values = {1, 2, 3}}).error().code, Code::bad_input);
  EXPECT_EQ(reliability({.subjects = 2, .sessions = 2, .values = {1, 2, 3, 4}}, 0.0).error().code,
            Code::usage);
}

}  // namespace
}  // namespace kinemark::analysis
