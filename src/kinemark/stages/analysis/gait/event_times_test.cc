// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/event_times.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;

constexpr DetectorTimes kNone{kNaN, kNaN, kNaN, 0.0};

TEST(EventTimes, OneDetectorGivesItsTimeLessItsBias) {
  // Bias of the middle's passing for a walk's strike -25.6 ms, constant 3.0.
  const auto fused = fuse(kNone, FootEvent::strike, false, FootSet::heel_and_toe, 0.01);
  EXPECT_NEAR(fused.after_s, 0.0256 + 0.0030, 2e-4);
}

TEST(EventTimes, DetectorsThatAgreeGiveTheirTime) {
  // All biased times 20 ms late against the middle's, once biases are off.
  const DetectorTimes strike{0.00588 + 0.02556, -0.03432 + 0.02556, -0.01051 + 0.02556, 0.0};
  const auto fused = fuse(strike, FootEvent::strike, false, FootSet::heel_and_toe, 0.01);
  EXPECT_NEAR(fused.after_s, 0.02556 + 0.00299, 1e-4);
  EXPECT_NEAR(fused.error.sd_s(), 0.0180, 1e-4);
  EXPECT_NEAR(fused.error.own_s, 0.007, 1e-5);
}

TEST(EventTimes, LongerFramesThanThoseLearntFromWidenTheSdShorterOnesDoNot) {
  const auto own = [](double rate_hz) {
    return fuse(kNone, FootEvent::off, false, FootSet::heel_and_toe, 1.0 / rate_hz).error.own_s;
  };
  EXPECT_EQ(own(200.0), own(100.0));
  EXPECT_NEAR(own(100.0), 0.007, 1e-12);
  EXPECT_NEAR(own(25.0), std::sqrt(0.007 * 0.007 + (0.04 * 0.04 - 0.01 * 0.01) / 12.0), 1e-9);
}

TEST(EventTimes, OneThatIsFarOffMovesTheTimeByItsClippedShareAndWidensTheSd) {
  DetectorTimes times{0.00588 + 0.02556, -0.03432 + 0.02556, -0.01051 + 0.02556, 0.0};
  const auto before = fuse(times, FootEvent::strike, false, FootSet::heel_and_toe, 0.01);
  times[0] += 0.3;
  const auto after = fuse(times, FootEvent::strike, false, FootSet::heel_and_toe, 0.01);
  EXPECT_NEAR(after.after_s - before.after_s, 0.4272 * 0.040, 1e-3);
  EXPECT_EQ(after.error.own_s, before.error.own_s);
  EXPECT_EQ(after.error.kind_s, before.error.kind_s);
  // Four times, one of them 300 ms away: an SD of 130 ms, of which 0.4 and all beyond 20 ms count.
  EXPECT_LT(error_of_apart(before.apart_s), 1e-5);
  const double apart = std::sqrt(3.0 / 16.0) * 0.3;
  EXPECT_NEAR(error_of_apart(after.apart_s), std::sqrt(0.16 * apart * apart + apart * apart - 0.02 * 0.02),
              1e-3);
}

TEST(EventTimes, DetectorsThatLieApartByLessThanThoseLearntFromCountForTwoFifths) {
  EXPECT_NEAR(error_of_apart({0.01, -0.01, 0.01, -0.01}), 0.004, 1e-12);
  EXPECT_NEAR(error_of_apart({0.11, 0.09, 0.11, 0.09}), 0.004, 1e-12);  // what all have tells nothing
  EXPECT_NEAR(error_of_apart({0.02, kNaN, -0.02, kNaN}), 0.008, 1e-12);
  EXPECT_EQ(error_of_apart({0.05, kNaN, kNaN, kNaN}), 0.0);
  EXPECT_EQ(error_of_apart({kNaN, kNaN, kNaN, kNaN}), 0.0);
}

TEST(EventTimes, RunningHasBiasesOfItsOwn) {
  // A toe farthest behind the pelvis is 89 ms late in running and not in walking.
  DetectorTimes times{kNaN, 0.0, kNaN, kNaN};
  const auto walk = fuse(times, FootEvent::off, false, FootSet::heel_and_toe, 0.01),
             run = fuse(times, FootEvent::off, true, FootSet::heel_and_toe, 0.01);
  EXPECT_NEAR(walk.after_s - run.after_s, 0.0888 - 0.0008 - 0.0042 - 0.0010, 1e-3);
}

TEST(EventTimes, EverySetOfMarkersHasAnSdOfFourteenMillisecondsOrMore) {
  for (const bool running : {false, true})
    for (const auto what : data::kFootEvents)
      for (const auto set : {FootSet::heel_and_toe, FootSet::ankle_and_toe, FootSet::toe_alone,
                             FootSet::rear_alone, FootSet::by_place}) {
        const auto fused = fuse(kNone, what, running, set, 0.001);
        const double sd = fused.error.sd_s();
        EXPECT_TRUE(sd >= 0.0139 && sd < 0.022) << sd;
      }
}

}  // namespace
}  // namespace kinemark::analysis
