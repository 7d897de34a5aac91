// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/coordinate_smoother.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;
constexpr int kFrames = 400;
constexpr double kRate_hz = 100.0;

VectorXd swing() {
  VectorXd q(kFrames);
  for (int f = 0; f < kFrames; ++f) q[f] = 0.5 * std::sin(2.0 * M_PI * 0.9 * f / kRate_hz + 0.3);
  return q;
}

VectorXd noisy(double sd, std::uint64_t seed) {
  Random random(seed, 1);
  VectorXd q = swing();
  for (double& x : q) x += sd * random.gaussian();
  return q;
}

const std::vector<bool> kAll(kFrames, true);

TEST(CoordinateSmoother, FindsWhiteNoiseAndTakesItOff) {
  const double sd = 0.01;
  const auto s = CoordinateSmoother::create(noisy(sd, 4), kAll, kNaN, kRate_hz).value();
  EXPECT_NEAR(s.noise().white, sd, 0.1 * sd);
  EXPECT_EQ(s.noise().slow, 0.0);
  EXPECT_LT((s.estimate() - swing()).norm() / std::sqrt(kFrames), 0.5 * sd);
  EXPECT_GT(s.cut_off_hz(), 0.9);
}

TEST(CoordinateSmoother, AStatedDeviationThatIsLargerIsDrawnSlowly) {
  const double white = 0.005, stated = 0.03;
  const auto s = CoordinateSmoother::create(noisy(white, 5), kAll, stated, kRate_hz).value();
  EXPECT_NEAR(s.noise().slow, std::sqrt(stated * stated - white * white), 1e-3);
  double squares = 0.0, steps = 0.0;
  for (int k = 0; k < 200; ++k) {
    const VectorXd error = s.slow_errors(1, 7, k);
    squares += error.squaredNorm() / (200.0 * kFrames);
    steps += (error.tail(kFrames - 1) - error.head(kFrames - 1)).squaredNorm() / (200.0 * kFrames);
  }
  EXPECT_NEAR(std::sqrt(squares), s.noise().slow, 0.05 * s.noise().slow);
  // As slow as the movement: 0.9 Hz moves by 2 pi 0.9 / 100 of its size in a sample.
  EXPECT_LT(std::sqrt(steps / squares), 2.0 * 2.0 * M_PI * 0.9 / kRate_hz);
  EXPECT_EQ(CoordinateSmoother::create(noisy(white, 5), kAll, 0.8 * white, kRate_hz).value().noise().slow,
            0.0)
      << "less is no disagreement";
}

TEST(CoordinateSmoother, RefitsAreThePilotWithErrorsLikeThoseOfTheEstimate) {
  const double sd = 0.01;
  const auto s = CoordinateSmoother::create(noisy(sd, 6), kAll, kNaN, kRate_hz).value();
  double of_refits = 0.0;
  for (int k = 0; k < 40; ++k) of_refits += (s.refit(1, 3, k) - s.pilot()).squaredNorm() / 40.0;
  const double of_estimate = (s.estimate() - swing()).squaredNorm();
  EXPECT_NEAR(std::sqrt(of_refits / of_estimate), 1.0, 0.35);
  EXPECT_EQ(s.refit(1, 3, 8), s.refit(1, 3, 8));
  EXPECT_NE(s.refit(1, 3, 8), s.refit(1, 3, 9));
  EXPECT_NE(s.refit(1, 3, 8), s.refit(1, 4, 8));
}

TEST(CoordinateSmoother, RefitsAreMadeOfAPathThatRestsWhereTheCoordinateDoes) {
  Random random(12, 1);
  VectorXd q(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    const double u = std::clamp((f / kRate_hz - 1.0) / 0.8, 0.0, 1.0);
    q[f] = 0.6 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) + 0.01 * random.gaussian();
  }
  const auto s = CoordinateSmoother::create(q, kAll, kNaN, kRate_hz).value();
  const auto range = [](const VectorXd& x) { return x.maxCoeff() - x.minCoeff(); };
  EXPECT_LT(range(s.pilot().head(60)), 0.6 * range(s.estimate().head(60))) << "noise that is left";
  EXPECT_NEAR(range(s.pilot()), 0.6, 0.02);
  EXPECT_LT((s.smoothed_pilot() - s.pilot()).cwiseAbs().maxCoeff(), 0.01);
}

TEST(CoordinateSmoother, SlowErrorsGoAlongWhatMovesBesideIt) {
  auto s = CoordinateSmoother::create(noisy(0.001, 5), kAll, 0.03, kRate_hz).value();
  Eigen::MatrixXd poses(kFrames, 2);
  poses.col(0) = standardized(swing());
  for (int f = 0; f < kFrames; ++f) poses(f, 1) = std::cos(2.0 * M_PI * 3.1 * f / kRate_hz);
  poses.col(1) = standardized(poses.col(1));
  const auto along = [&] {
    double sum = 0.0;
    for (int k = 0; k < 100; ++k)
      sum += std::pow(s.slow_errors(1, 7, k).dot(poses.col(1)) / kFrames, 2) / 100.0;
    return std::sqrt(sum) / s.noise().slow;
  };
  EXPECT_LT(along(), 0.15);
  s.move_beside(std::make_shared<const Eigen::MatrixXd>(poses), 0);
  EXPECT_NEAR(along(), std::sqrt(1.0 / 3.0), 0.15);
}

TEST(CoordinateSmoother, WithoutNoiseTheSamplesStay) {
  VectorXd line(kFrames);
  for (int f = 0; f < kFrames; ++f) line[f] = 0.25 * f;
  const auto s = CoordinateSmoother::create(line, kAll, kNaN, kRate_hz).value();
  EXPECT_EQ(s.noise().white, 0.0);
  EXPECT_EQ(s.estimate(), line);
  EXPECT_EQ(s.refit(1, 0, 0), line);
  EXPECT_TRUE(std::isnan(s.cut_off_hz()));
}

TEST(CoordinateSmoother, WhatIsNotSeenDoesNotCount) {
  VectorXd q = noisy(0.002, 9);
  auto seen = kAll;
  for (int f = 100; f < 110; ++f) seen[static_cast<std::size_t>(f)] = false, q[f] = 1e3;
  const auto s = CoordinateSmoother::create(q, seen, kNaN, kRate_hz).value();
  EXPECT_LT((s.estimate() - swing()).cwiseAbs().maxCoeff(), 0.02);
  const auto with_first = [&](int count) {
    std::vector<bool> first(kFrames, false);
    std::fill_n(first.begin(), count, true);
    const auto made = CoordinateSmoother::create(q, first, kNaN, kRate_hz);
    return made ? std::string() : made.error();
  };
  EXPECT_THAT(with_first(0), HasSubstr("0 of its samples are determined, 30 are needed"));
  EXPECT_THAT(with_first(29), HasSubstr("29 of its samples are determined"));
  EXPECT_THAT(with_first(30), Not(HasSubstr("of its samples are determined")));
}

}  // namespace
}  // namespace kinemark::analysis
