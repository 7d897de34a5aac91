// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/goals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinemark/math/digital_filter.h"
#include "support/allocations.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kRate = 60.0;

/// One marker along a path, unseen in frames [gap, gap_end).
SampleWindow one_marker(int frames, auto&& path, int gap = -1, int gap_end = -1) {
  SampleWindow window(1, frames);
  Eigen::Matrix3Xd x(3, 1);
  Eigen::VectorXd weight(1);
  for (int f = 0; f < frames; ++f) {
    weight[0] = f >= gap && f < gap_end ? 0.0 : 1.0;
    x.col(0) = weight[0] > 0.0 ? Eigen::Vector3d(path(f / kRate)) : Eigen::Vector3d::Zero();
    window.push(x, weight);
  }
  window.end();
  return window;
}

Eigen::Vector3d wave(double t) {
  return {std::sin(3.0 * t), 0.5 * std::cos(2.0 * t), 1.0 + 0.2 * std::sin(5.0 * t)};
}

TEST(Goals, ParabolasPassTheFilterWithTheirDerivatives) {
  const auto parabola = [](double t) { return Eigen::Vector3d(1.0 + 2.0 * t - 3.0 * t * t, t, 4.0 * t * t); };
  const auto samples = one_marker(120, parabola);
  const GoalFilter filter(kRate, 6.0, 0.0, 0.1);
  GoalCell cell(1);
  GoalValues goal(1);
  filter.build(samples, 60, cell);
  cell.at(0.3, goal);
  const double t = 60.3 / kRate;
  EXPECT_LT((goal.x.col(0) - parabola(t)).norm(), 1e-11);
  EXPECT_LT((goal.v.col(0) - Eigen::Vector3d(2.0 - 6.0 * t, 1.0, 8.0 * t)).norm(), 1e-9);
  EXPECT_LT((goal.a.col(0) - Eigen::Vector3d(-6.0, 0.0, 8.0)).norm(), 1e-7);
  EXPECT_EQ(goal.weight[0], 1.0);
}

TEST(Goals, WithoutLowPassTheGoalsPassThroughTheSamples) {
  const auto samples = one_marker(80, wave);
  const GoalFilter filter(kRate, 0.0, 0.0, 0.1);
  GoalCell cell(1);
  GoalValues goal(1);
  for (const int f : {25, 40, 50}) {
    filter.build(samples, f, cell);
    cell.at(0.0, goal);
    EXPECT_LT((goal.x.col(0) - wave(f / kRate)).norm(), 1e-6) << f;
    cell.at(0.5, goal);
    EXPECT_LT((goal.x.col(0) - wave((f + 0.5) / kRate)).norm(), 1e-5) << f;
  }
}

TEST(Goals, TheFilterIsTheTwoPassButterworth) {
  const double pi = std::numbers::pi;
  const GoalFilter filter(kRate, 6.0, 0.4, 0.1);
  const auto sections = math::butterworth_lowpass(2, math::two_pass_cutoff(2, 0.1));
  for (const double hz : {1.0, 3.0, 6.0, 10.0}) {
    const auto samples = one_marker(
        200, [&](double t) { return Eigen::Vector3d(std::cos(2.0 * pi * hz * (t - 100 / kRate)), 0, 0); });
    GoalCell cell(1);
    GoalValues goal(1);
    filter.build(samples, 100, cell);
    cell.at(0.0, goal);
    EXPECT_NEAR(goal.x(0, 0), std::pow(math::amplitude(sections, hz / kRate), 2.0), 2e-3) << hz;
  }
}

TEST(Goals, NeighbouringCellsMeetWithTheirSecondDerivatives) {
  const auto samples = one_marker(80, wave);
  const GoalFilter filter(kRate, 6.0, 0.0, 0.1);
  GoalCell left(1), right(1);
  GoalValues end(1), start(1);
  for (const int f : {0, 30, 77}) {
    filter.build(samples, f, left);
    filter.build(samples, f + 1, right);
    left.at(1.0, end);
    right.at(0.0, start);
    EXPECT_LT((end.x - start.x).norm(), 1e-12);
    EXPECT_LT((end.v - start.v).norm(), 1e-10);
    EXPECT_LT((end.a - start.a).norm(), 1e-8);
  }
}

TEST(Goals, WeightsFadeBesideAGapAndNotAtTheEnds) {
  const auto samples = one_marker(120, wave, 50, 80);
  const GoalFilter filter(kRate, 6.0, 0.0, 0.1);  // 6 frames
  GoalCell cell(1);
  GoalValues goal(1);
  const auto weight = [&](double frame) {
    const auto first = std::min<std::int64_t>(118, static_cast<std::int64_t>(frame));
    filter.build(samples, first, cell);
    cell.at(frame - static_cast<double>(first), goal);
    return goal.weight[0];
  };
  EXPECT_EQ(weight(0.0), 1.0);
  EXPECT_EQ(weight(119.0), 1.0);
  EXPECT_EQ(weight(42.9), 1.0);
  EXPECT_NEAR(weight(46.0), 0.5, 1e-12);
  EXPECT_EQ(weight(48.9999999) > 1e-6, false);
  EXPECT_EQ(weight(60.0), 0.0);
  EXPECT_NEAR(weight(83.0), 0.5, 1e-12);
  EXPECT_EQ(weight(86.1), 1.0);
  double before = weight(40.0);
  for (double f = 40.0; f < 90.0; f += 0.1) {
    EXPECT_LT(std::abs(weight(f) - before), 0.03) << f;  // no jump
    before = weight(f);
  }
}

TEST(Goals, AStreamGetsTheSameGoalsAsAFileOnceItHasSeenEnough) {
  const auto whole = one_marker(150, wave, 60, 75);
  const GoalFilter filter(kRate, 6.0, 0.0, 0.1);
  SampleWindow stream(1, filter.window_frames());
  GoalCell live(1), file(1);
  GoalValues a(1), b(1);
  Eigen::Matrix3Xd x(3, 1);
  Eigen::VectorXd weight(1);
  for (int f = 0; f < 150; ++f) {
    weight[0] = whole.weight(f, 0);
    x.col(0) = whole.x(f, 0);
    stream.push(x, weight);
    const std::int64_t first = f - filter.delay_frames() - 1;
    if (first < 0) continue;
    filter.build(stream, first, live);
    filter.build(whole, first, file);
    live.at(0.4, a);
    file.at(0.4, b);
    EXPECT_TRUE(a.x == b.x && a.v == b.v && a.a == b.a && a.weight == b.weight) << f;
  }
}

TEST(Goals, GivenDerivativesAreMetAtBothEnds) {
  const auto samples = one_marker(10, wave);
  data::Derivatives d;
  d.velocity.resize(60);
  d.acceleration.resize(60);
  for (int f = 0; f < 10; ++f) {  // two markers in the file, ours is the second
    const double t = f / kRate;
    const Eigen::Vector3d v(3.0 * std::cos(3.0 * t), -std::sin(2.0 * t), std::cos(5.0 * t));
    const Eigen::Vector3d a(-9.0 * std::sin(3.0 * t), -2.0 * std::cos(2.0 * t), -5.0 * std::sin(5.0 * t));
    for (int i = 0; i < 3; ++i) {
      d.velocity[static_cast<std::size_t>(f * 6 + 3 + i)] = v[i];
      d.acceleration[static_cast<std::size_t>(f * 6 + 3 + i)] = a[i];
    }
  }
  const GoalFilter filter(kRate, 6.0, 0.0, 0.1);
  GoalCell cell(1);
  GoalValues goal(1);
  filter.build(samples, 4, d, {1}, 2, 0, cell);
  cell.at(1.0, goal);
  EXPECT_LT((goal.x.col(0) - wave(5.0 / kRate)).norm(), 1e-12);
  EXPECT_NEAR(goal.v(0, 0), 3.0 * std::cos(15.0 / kRate), 1e-9);
  EXPECT_NEAR(goal.a(0, 0), -9.0 * std::sin(15.0 / kRate), 1e-7);
  cell.at(0.5, goal);
  EXPECT_LT((goal.x.col(0) - wave(4.5 / kRate)).norm(), 1e-8);
  d.velocity[4 * 6 + 3] = NAN;
  filter.build(samples, 4, d, {1}, 2, 0, cell);
  cell.at(0.5, goal);
  EXPECT_EQ(goal.weight[0], 0.0);
}

TEST(Goals, BuildingACellAllocatesNothing) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  const auto samples = one_marker(80, wave, 30, 40);
  const GoalFilter filter(kRate, 6.0, 0.0, 0.1);
  GoalCell cell(1);
  GoalValues goal(1);
  const auto before = testing_support::allocations_on_this_thread();
  for (int f = 0; f < 79; ++f) {
    filter.build(samples, f, cell);
    cell.at(0.5, goal);
  }
  EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
}

}  // namespace
}  // namespace kinemark::motion::internal
