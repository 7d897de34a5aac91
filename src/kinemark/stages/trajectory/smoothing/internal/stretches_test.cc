// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/stretches.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/internal/cutoff.h"

namespace kinemark::trajectory::smoothing {
namespace {

TEST(Stretches, AreTheRunsBetweenGaps) {
  const Array<std::uint8_t> present{0, 1, 1, 0, 0, 1, 0, 1, 1, 1};
  const auto found = stretches(present);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].begin, 1);
  EXPECT_EQ(found[0].end, 3);
  EXPECT_EQ(found[1].length(), 1);
  EXPECT_EQ(found[2].end, 10);
  EXPECT_TRUE(stretches({}).empty());
  EXPECT_TRUE(stretches({0, 0}).empty());
}

TEST(Stretches, LongRecordingsAreSampledEvenly) {
  const auto all = sample_of({{0, 1000}, {2000, 3000}});
  EXPECT_EQ(all.size(), 2u);
  std::int64_t total = 0, last = 0;
  for (const Stretch& s : sample_of({{0, 400000}, {500000, 1000000}})) {
    EXPECT_GE(s.begin, last);
    last = s.end;
    total += s.length();
  }
  EXPECT_NEAR(static_cast<double>(total), 16384.0, 2048.0);
  EXPECT_GT(last, 850000);
}

TEST(Stretches, DifferencesAreExactForParabolasInside) {
  std::vector<double> x;
  for (int i = 0; i < 10; ++i) x.push_back(0.01 * i * 0.01 * i);
  const auto v = differences(x, 0.01);
  for (std::size_t i = 1; i < 9; ++i) EXPECT_NEAR(v[i], 0.02 * static_cast<double>(i), 1e-12);
  EXPECT_NEAR(v[0], 0.01, 1e-12);
  EXPECT_TRUE(std::isnan(differences({1.0}, 0.01)[0]));
  EXPECT_TRUE(differences({}, 0.01).empty());
}

TEST(Stretches, DifferencePowerIsTheGainOfASine) {
  std::vector<double> x;
  for (int i = 0; i < 1000; ++i) x.push_back(std::sin(2.0 * M_PI * 0.07 * i));
  double power = 0.0;
  const auto v = differences(x, 0.01);
  for (std::size_t i = 100; i < 900; ++i) power += v[i] * v[i] / 800.0;
  EXPECT_NEAR(power / 0.5 / difference_power(0.07, 0.01), 1.0, 0.01);
}

CutoffProblem hand_problem() {
  CutoffProblem problem;
  problem.rate_hz = 100.0;
  Random random(7, 7);
  for (int column = 0; column < 3; ++column) {
    auto& x = problem.columns.emplace_back();
    for (int i = 0; i < 1000; ++i)
      x.push_back(0.2 * std::sin(2.0 * M_PI * 0.015 * i + column) + 0.02 * std::sin(2.0 * M_PI * 0.05 * i) +
                  0.0005 * random.gaussian());
  }
  return problem;
}

TEST(Cutoff, BothRulesKeepTheMovementAndDropMostNoise) {
  const CutoffProblem problem = hand_problem();
  for (const double cutoff : {winter_cutoff_hz(problem), challis_cutoff_hz(problem)}) {
    EXPECT_GT(cutoff, 5.0);
    EXPECT_LT(cutoff, 20.0);
  }
}

TEST(Cutoff, SlowRecordingsHaveSlowCutoffs) {
  CutoffProblem problem = hand_problem();
  const double at_100_hz = winter_cutoff_hz(problem);
  problem.rate_hz = 1.0;
  EXPECT_NEAR(winter_cutoff_hz(problem) / (0.01 * at_100_hz), 1.0, 0.1);
}

TEST(Cutoff, CorrectionRaisesWhatPasses) {
  std::vector<double> corrected, plain;
  for (int i = 0; i < 1000; ++i) corrected.push_back(std::sin(2.0 * M_PI * 0.06 * i));
  plain = corrected;
  butterworth(corrected, 2, 6.0, 100.0, true);
  butterworth(plain, 2, 6.0, 100.0, false);
  double c = 0.0, p = 0.0;
  for (std::size_t i = 300; i < 700; ++i) {
    c += corrected[i] * corrected[i] / 200.0;
    p += plain[i] * plain[i] / 200.0;
  }
  EXPECT_NEAR(std::sqrt(c), std::sqrt(0.5), 0.005);
  EXPECT_NEAR(std::sqrt(p), 0.5, 0.005);
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing
