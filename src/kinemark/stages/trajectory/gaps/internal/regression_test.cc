// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/regression.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

constexpr Index kRows = 10;
constexpr Index kWindows = 24;
constexpr Index kFeatures = 6;

GapProblem problem(Index between) {
  GapProblem p;
  p.shape = {.length = kRows, .left = 3, .right = 3};
  p.window = p.shape;
  p.rows = Eigen::VectorX<Index>::LinSpaced(kRows, 0, kRows - 1);
  for (Index w = 0; w < kWindows; ++w) p.starts.push_back(3 + between * w);
  return p;
}

struct Data {
  Signal y, z;
  Eigen::MatrixXd truth;  // of the target in the gap
};

/// y = offset + z B + noise, where only the first two features matter.
Data linear_world(double noise_m, double offset_m) {
  Random random(9, 1);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(kFeatures, 3);
  for (double& v : B.topRows(2).reshaped()) v = random.gaussian();
  Data d;
  d.z.width = kFeatures;
  d.y.width = 3;
  const auto draw = [&](Index rows, Index cols) {
    Eigen::MatrixXd m(rows, cols);
    for (double& v : m.reshaped()) v = 0.1 * random.gaussian();
    return m;
  };
  d.z.rows = draw(kRows, kWindows * kFeatures);
  d.z.near = draw(6, kWindows * kFeatures);
  d.z.gap = draw(kRows, kFeatures);
  d.z.gap_near = draw(6, kFeatures);
  const auto target = [&](const Eigen::MatrixXd& z) {
    Eigen::MatrixXd y(z.rows(), z.cols() / kFeatures * 3);
    for (Index w = 0; w < z.cols() / kFeatures; ++w)
      y.middleCols(3 * w, 3) = (z.middleCols(kFeatures * w, kFeatures) * B).array() + offset_m;
    for (double& v : y.reshaped()) v += noise_m * random.gaussian();
    return y;
  };
  d.y.rows = target(d.z.rows);
  d.y.near = target(d.z.near);
  d.y.gap_near = target(d.z.gap_near);
  d.truth = (d.z.gap * B).array() + offset_m;
  return d;
}

const std::array<Index, 2> kWidths = {2, 6};

TEST(Regress, FindsAnExactRelationTiedOrNot) {
  const Data d = linear_world(0.0, 0.4);
  const auto folds = make_folds(problem(20));
  const Innovation y = untie(d.y);
  const Regression untied = regress(y, untie(d.z), folds, kWidths, true);
  EXPECT_LT(((untied.gap.rowwise() + y.mean) - d.truth).norm(), 1e-5);
  EXPECT_LT(untied.gap_near.norm(), 1e-5);
  EXPECT_LT(untied.errors.norm(), 1e-4);

  const Eigen::MatrixXd A = chord_operator({.length = kRows, .left = 3, .right = 3});
  const Regression tied = regress(tie(d.y, A, A), tie(d.z, A, A), folds, kWidths, false);
  EXPECT_LT((A * d.y.gap_near + tied.gap - d.truth).norm(), 1e-5);
}

TEST(Regress, SaysHowFarTheGapLiesOutsideOfWhatWasLearntFrom) {
  Data d = linear_world(0.001, 0.0);
  const auto folds = make_folds(problem(20));
  const auto stretch = [&] { return regress(untie(d.y), untie(d.z), folds, kWidths, true).stretch; };
  EXPECT_NEAR(stretch(), 1.0, 0.3);
  const double usual = stretch();
  d.z.gap *= 20.0;
  EXPECT_NEAR(stretch() / usual, 20.0, 1.0);
  // A direction in which the neighbours hardly moved counts as much as one in which they moved far.
  d = linear_world(0.001, 0.0);
  const auto shrink = [&](Eigen::MatrixXd& z) {
    for (Index k = 1; k < z.cols(); k += kFeatures) z.col(k) *= 0.05;
  };
  shrink(d.z.rows);
  shrink(d.z.near);
  EXPECT_GT(stretch(), 5.0);
}

TEST(Regress, ErrorsAreThoseOfDataThatWereLeftOut) {
  const double noise = 0.01;
  const Data d = linear_world(noise, 0.0);
  const Regression r = regress(untie(d.y), untie(d.z), make_folds(problem(20)), kWidths, true);
  EXPECT_GT(std::sqrt(r.mean_square), noise);         // never better than the noise
  EXPECT_LT(std::sqrt(r.mean_square), 1.15 * noise);  // nor much worse
}

TEST(Regress, PrefersFewFeaturesWhenTheOthersAreNoise) {
  const Data d = linear_world(0.05, 0.0);
  const std::array<Index, 1> all = {6};
  const auto folds = make_folds(problem(20));
  EXPECT_LE(regress(untie(d.y), untie(d.z), folds, kWidths, true).mean_square,
            regress(untie(d.y), untie(d.z), folds, all, true).mean_square + 1e-15);
}

TEST(Folds, NeverTrainOnWhatOverlapsTheTest) {
  for (const Index between : {1, 4, 20}) {
    const GapProblem p = problem(between);
    Index tested = 0;
    for (const Fold& fold : make_folds(p)) {
      tested += fold.end - fold.first;
      for (const Index train : fold.train)
        for (Index test = fold.first; test < fold.end; ++test)
          EXPECT_GE(std::abs(p.start(train) - p.start(test)), kRows) << between;
    }
    EXPECT_EQ(tested, kWindows);
  }
}

TEST(Regress, WithoutTrainingDataTheTemporalFillStands) {
  const Data d = linear_world(0.0, 0.0);
  const Innovation y = untie(d.y);
  const Regression r = regress(y, untie(d.z), make_folds(problem(0)), kWidths, false);
  EXPECT_TRUE(r.errors == y.rows);
}

}  // namespace
}  // namespace kinemark::trajectory::internal
