// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/filler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr Index kWindows = 32;
constexpr Index kRows = 20;

GapProblem problem() {
  GapProblem p;
  p.shape = {.length = kRows, .left = 10, .right = 10};
  p.window = p.shape;
  p.rows = Eigen::VectorX<Index>::LinSpaced(kRows, 0, kRows - 1);
  p.all_rows = p.rows;
  for (Index w = 0; w < kWindows; ++w) p.starts.push_back(10 + 100 * w);
  return p;
}

/// A candidate with independent errors: N(0, sd) on the windows and in the gap, where the truth is 0.
Fill candidate(FillKind kind, double sd_m, std::uint64_t stream) {
  Random random(5, stream);
  Fill f{.kind = kind, .gap = Eigen::MatrixXd(kRows, 3), .errors = Eigen::MatrixXd(kRows, 3 * kWindows)};
  for (double& v : f.gap.reshaped()) v = sd_m * random.gaussian();
  for (double& v : f.errors.reshaped()) v = sd_m * random.gaussian();
  return f;
}

TEST(SimplexWeights, AreThoseOfInverseVariancesForIndependentErrors) {
  const Eigen::Vector3d variance(1.0, 2.0, 4.0);
  const Eigen::VectorXd w = simplex_weights(variance.asDiagonal());
  EXPECT_NEAR(w(0), 4.0 / 7.0, 1e-12);
  EXPECT_NEAR(w(1), 2.0 / 7.0, 1e-12);
  EXPECT_NEAR(w(2), 1.0 / 7.0, 1e-12);
}

TEST(SimplexWeights, NoOtherConvexWeightsAreMuchBetter) {
  Random random(3, 1);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Matrix<double, 3, 6> A;
    for (double& v : A.reshaped()) v = random.gaussian() + 0.7;
    const Eigen::Matrix3d M = A * A.transpose();
    const Eigen::Vector3d w = simplex_weights(M);
    EXPECT_NEAR(w.sum(), 1.0, 1e-12);
    EXPECT_GE(w.minCoeff(), 0.0);
    for (int i = 0; i <= 20; ++i)
      for (int k = 0; i + k <= 20; ++k) {
        const Eigen::Vector3d v = Eigen::Vector3d(i, k, 20 - i - k) / 20.0;
        EXPECT_LE(w.dot(M * w), v.dot(M * v) * (1.0 + 1e-9) + 1e-12);
      }
  }
}

TEST(Combine, IsBetterThanEveryCandidateAndKnowsHowGoodItIs) {
  const std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.002, 1),
                                   candidate(FillKind::regression_walk, 0.002, 2),
                                   candidate(FillKind::pca_chord, 0.002, 3)};
  const Combination c = combine(problem(), fills, false);
  for (const double w : c.weights) EXPECT_NEAR(w, 1.0 / 3.0, 0.05);
  const double rms = std::sqrt(c.gap.squaredNorm() / static_cast<double>(c.gap.size()));
  EXPECT_NEAR(rms, 0.002 / std::sqrt(3.0), 0.0004);
  EXPECT_NEAR(c.sd_m.mean(), rms, 0.3 * rms);
}

TEST(Combine, LeavesOutWhatIsFarWorse) {
  const std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1),
                                   candidate(FillKind::chord, 0.02, 2)};
  const Combination c = combine(problem(), fills, false);
  EXPECT_EQ(c.weights, (std::vector<double>{1.0, 0.0}));
}

TEST(Combine, GuardsAgainstACandidateThatStraysInThisGap) {
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.002, 1),
                             candidate(FillKind::regression_walk, 0.002, 2),
                             candidate(FillKind::pca_untied, 0.002, 3)};
  fills[2].gap.array() += 0.5;
  const Combination c = combine(problem(), fills, false);
  EXPECT_TRUE(c.guarded[2]);
  EXPECT_EQ(c.weights[2], 0.0);
  EXPECT_LT(c.gap.cwiseAbs().maxCoeff(), 0.01);
}

TEST(Combine, AnUntiedCandidateErrsInTheGapAsItDoesBesideIt) {
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.002, 1),
                             candidate(FillKind::regression_untied, 0.002, 2)};
  fills[1].near_rms_m = 0.003;  // less than its 3D error on the windows
  const Combination usual = combine(problem(), fills, false);
  EXPECT_NEAR(usual.weights[1], 0.5, 0.05);
  fills[1].near_rms_m = 0.05;
  EXPECT_EQ(combine(problem(), fills, false).weights[1], 0.0);
  // Nothing else to take: its SD is as large as the miss says.
  fills = {fills[1]};
  const double wide = combine(problem(), fills, false).sd_m.mean();
  fills[0].near_rms_m = 0.0;
  EXPECT_NEAR(wide / combine(problem(), fills, false).sd_m.mean(), 0.05 / (0.002 * std::sqrt(3.0)), 1.0);
}

TEST(Combine, SdGrowsWithWhatTheNeighboursDoInTheGap) {
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1)};
  const double calm = combine(problem(), fills, false).sd_m.mean();
  fills[0].stretch = 0.2;  // quieter than the windows: nothing is taken off
  EXPECT_EQ(combine(problem(), fills, false).sd_m.mean(), calm);
  fills[0].stretch = 7.0;
  EXPECT_NEAR(combine(problem(), fills, false).sd_m.mean(), 7.0 * calm, 1e-9);
}

TEST(Combine, SdFollowsDisagreementWhenThatTellsTheError) {
  // Two candidates whose errors are large together in half of the windows.
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1),
                             candidate(FillKind::regression_walk, 0.001, 2)};
  for (Fill& f : fills) f.errors.rightCols(3 * kWindows / 2) *= 8.0;
  const double calm = combine(problem(), fills, false).sd_m.mean();
  for (Fill& f : fills) f.gap *= 8.0;
  EXPECT_GT(combine(problem(), fills, false).sd_m.mean(), 3.0 * calm);
}

TEST(Combine, SdGrowsInProportionWhereCandidatesDisagreeAsOnNoWindow) {
  // Windows in a calm part: errors of one size, from which no slope can be learnt. In the gap the marker's
  // own path, too coarse to be used, is 50 times as far off: the movement there is another one.
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1), candidate(FillKind::chord, 0.004, 2)};
  const Combination calm = combine(problem(), fills, false);
  EXPECT_EQ(calm.weights[1], 0.0);
  EXPECT_NEAR(calm.sd_m.mean(), 0.001, 0.0002);
  fills[1].gap *= 50.0;
  const Combination wild = combine(problem(), fills, false);
  EXPECT_EQ(wild.weights[1], 0.0);
  EXPECT_GT(wild.sd_m.mean(), 0.02);
}

TEST(Combine, SdDoesNotShrinkBelowTheWindowsWhereCandidatesHappenToAgree) {
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1),
                             candidate(FillKind::regression_walk, 0.001, 2)};
  const double usual = combine(problem(), fills, false).sd_m.mean();
  fills[1].gap = fills[0].gap;
  EXPECT_GT(combine(problem(), fills, false).sd_m.mean(), 0.6 * usual);
}

TEST(Combine, SdIsWiderWhenWindowsOverlap) {
  const std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1)};
  GapProblem p = problem();
  const double apart = combine(p, fills, false).sd_m.norm();
  for (Index w = 0; w < kWindows; ++w) p.starts[static_cast<std::size_t>(w)] = 10 + w;  // two are apart
  const double ratio = std::sqrt((1.0 + 2.0 / 2.0) / (1.0 + 2.0 / 32.0));
  EXPECT_NEAR(combine(p, fills, false).sd_m.norm() / apart, ratio, 1e-9 * ratio);
}

TEST(Combine, ErrorsOfFewWindowsAreSpreadAlongTheGap) {
  // Errors in the last third of the rows only, as two windows happen to show.
  Fill f = candidate(FillKind::rigid_walk, 0.001, 1);
  f.errors.topRows(2 * kRows / 3).setZero();
  f.errors.bottomRows(kRows / 3).setConstant(0.002);
  GapProblem p = problem();
  p.shape.right = p.window.right = 0;
  const double sure = combine(p, {f}, false).sd_m(kRows / 3);
  for (Index w = 0; w < kWindows; ++w) p.starts[static_cast<std::size_t>(w)] = 10 + w;
  EXPECT_GT(combine(p, {f}, false).sd_m(kRows / 3), 2.0 * sure);
}

TEST(Combine, WithoutWindowsTakesTheCautiousOneAndAdmitsThatItKnowsNothing) {
  GapProblem p = problem();
  p.starts.clear();
  std::vector<Fill> fills = {candidate(FillKind::spline, 0.001, 1), candidate(FillKind::pchip, 0.001, 2)};
  for (Fill& f : fills) f.errors.resize(kRows, 0);
  const Combination c = combine(p, fills, false);
  EXPECT_EQ(c.weights, (std::vector<double>{0.0, 1.0}));
  EXPECT_TRUE(c.sd_m.array().isNaN().all());
}

TEST(Combine, ErrorsGrowFromShortWindowsToALongGap) {
  GapProblem p = problem();
  p.window.length = kRows / 2;
  p.rows = Eigen::VectorX<Index>::LinSpaced(kRows / 2, 0, kRows / 2 - 1);
  std::vector<Fill> fills = {candidate(FillKind::rigid_walk, 0.001, 1)};
  fills[0].errors = fills[0].errors.topRows(kRows / 2).eval();
  // Growth 1: twice the length, twice the error.
  const double long_sd = combine(p, fills, false).sd_m.mean();
  p.shape.length = kRows / 2;
  fills[0].gap = fills[0].gap.topRows(kRows / 2).eval();
  EXPECT_NEAR(long_sd / combine(p, fills, false).sd_m.mean(), 2.0, 0.1);
}

TEST(Combine, WithoutWindowsAFiniteCandidateIsTaken) {
  GapProblem p = problem();
  p.starts.clear();
  Fill lost = candidate(FillKind::pchip, 1e-3, 1), sound = candidate(FillKind::chord, 1e-3, 2);
  for (Fill* fill : {&lost, &sound}) fill->errors.resize(kRows, 0);
  lost.gap(3, 1) = std::numeric_limits<double>::quiet_NaN();
  const Combination taken = combine(p, {lost, sound}, false);
  EXPECT_EQ(taken.weights, (std::vector<double>{0.0, 1.0}));
  EXPECT_TRUE(taken.gap.allFinite());
  EXPECT_FALSE(combine(p, {lost}, false).gap.allFinite()) << "the caller leaves such a gap open";
}

}  // namespace
}  // namespace kinemark::trajectory::internal
