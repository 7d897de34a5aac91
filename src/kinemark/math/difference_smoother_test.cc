// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/difference_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/smoothing_choice.h"

namespace kinemark::math {
namespace {

std::vector<bool> all_but(std::int64_t n, std::int64_t first, std::int64_t count) {
  std::vector<bool> seen(at(n), true);
  for (std::int64_t i = first; i < first + count; ++i) seen[at(i)] = false;
  return seen;
}

SeriesMatrix noise(std::int64_t n, std::int64_t columns, std::uint64_t seed) {
  Random random(seed, 0);
  SeriesMatrix out(n, columns);
  for (double& value : out.reshaped()) value = random.gaussian();
  return out;
}

// The Gaussian posterior written out: covariance of the integrated Wiener process by quadrature, polynomials
// below the order free, the smoother as a dense matrix over the seen samples.
Eigen::MatrixXd dense_smoother(const std::vector<bool>& seen, int m, double half_power) {
  const auto n = static_cast<Eigen::Index>(seen.size());
  std::vector<Eigen::Index> o;
  for (Eigen::Index i = 0; i < n; ++i)
    if (seen[at(i)]) o.push_back(i);
  double factorial = 1.0;
  for (int k = 2; k < m; ++k) factorial *= k;
  const double r = std::exp(DifferenceSmoother::log_intensity(m, half_power));
  // Gauss-Legendre of four points: exact to degree 7, the product has degree 2m - 2 at most.
  const double node[] = {0.861136311594052575, 0.339981043584856265};
  const double weight[] = {0.347854845137453857, 0.652145154862546143};
  Eigen::MatrixXd k(n, n), p(n, m);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int c = 0; c < m; ++c) p(i, c) = std::pow(static_cast<double>(i) / static_cast<double>(n), c);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double end = static_cast<double>(std::min(i, j));
      double sum = 0.0;
      for (int q = 0; q < 4; ++q) {
        const double u = 0.5 * end * (1.0 + (q % 2 ? 1.0 : -1.0) * node[q / 2]);
        sum += 0.5 * end * weight[q / 2] * std::pow(static_cast<double>(i) - u, m - 1) *
               std::pow(static_cast<double>(j) - u, m - 1);
      }
      k(i, j) = r * sum / (factorial * factorial);
    }
  }
  const Eigen::MatrixXd po = p(o, Eigen::all);
  const Eigen::MatrixXd v = k(o, o) + Eigen::MatrixXd::Identity(po.rows(), po.rows());
  const Eigen::LDLT<Eigen::MatrixXd> inverse(v);
  const Eigen::MatrixXd trend =
      (po.transpose() * inverse.solve(po)).ldlt().solve(inverse.solve(po).transpose());
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(po.rows(), po.rows()) - po * trend;
  return p * trend + k(Eigen::all, o) * inverse.solve(rest);
}

TEST(DifferenceSmoother, EqualsTheDensePosteriorWithAGap) {
  const double bounds[] = {1e-11, 1e-8, 1e-5};  // the dense one loses the digits
  for (int m = 1; m <= 3; ++m) {
    const auto seen = all_but(60, 22, 6);
    const Eigen::MatrixXd dense = dense_smoother(seen, m, 0.08);
    SeriesMatrix y = noise(60, 2, 5);
    for (int i = 1; i < 60; ++i) y.row(i) += y.row(i - 1);
    Eigen::MatrixXd observed(54, 2);
    for (Eigen::Index i = 0, k = 0; i < 60; ++i)
      if (seen[at(i)]) observed.row(k++) = y.row(i);
    const Eigen::MatrixXd expected = dense * observed;
    y.middleRows(22, 6).setConstant(1e3);  // what stands in a gap does not count
    DifferenceSmoother smoother(seen, m);
    ASSERT_TRUE(smoother.factor(0.08));
    smoother.smooth(y);
    EXPECT_LT((y - expected).cwiseAbs().maxCoeff(), bounds[m - 1]) << m;
  }
}

TEST(DifferenceSmoother, DeterminantGivesTheTrace) {
  for (int m = 1; m <= 3; ++m) {
    const auto seen = all_but(60, 22, 6);
    const Eigen::MatrixXd dense = dense_smoother(seen, m, 0.08);
    double trace = 0.0;
    for (Eigen::Index i = 0, k = 0; i < 60; ++i)
      if (seen[at(i)]) trace += dense(i, k++);
    DifferenceSmoother smoother(seen, m);
    const double step = std::exp(0.01 / m / 2);
    ASSERT_TRUE(smoother.factor(0.08 * step));
    const double above = smoother.log_determinant();
    ASSERT_TRUE(smoother.factor(0.08 / step));
    EXPECT_NEAR(m + (above - smoother.log_determinant()) / 0.02, trace, 2e-4) << m;
  }
}

TEST(DifferenceSmoother, KeepsPolynomialsBelowItsOrderWhateverIsMissing) {
  for (int m = 1; m <= 5; ++m)
    for (const auto& seen : {all_but(40, 0, 0), all_but(40, 0, 7), all_but(40, 31, 9), all_but(40, 12, 1)}) {
      SeriesMatrix y(40, 1);
      for (int i = 0; i < 40; ++i) y(i, 0) = 3.0 + std::pow(0.1 * i, m - 1);
      SeriesMatrix out = y;
      DifferenceSmoother smoother(seen, m);
      ASSERT_TRUE(smoother.factor(0.1));
      smoother.smooth(out);
      // Each order costs a digit, and the ends are continued.
      EXPECT_LT((out - y).cwiseAbs().maxCoeff(), 1e-10 * std::pow(10.0, m)) << m;
    }
}

TEST(DifferenceSmoother, HalvesItsHalfPowerFrequency) {
  const int n = 4000;
  for (int m = 2; m <= 5; ++m) {
    SeriesMatrix y(n, 1);
    for (int i = 0; i < n; ++i) y(i, 0) = std::sin(2.0 * std::numbers::pi * 0.05 * i);
    SeriesMatrix out = y;
    DifferenceSmoother smoother(all_but(n, 0, 0), m);
    ASSERT_TRUE(smoother.factor(0.05));
    smoother.smooth(out);
    EXPECT_NEAR(out.middleRows(1000, 2000).norm() / y.middleRows(1000, 2000).norm(), 0.5, 5e-3) << m;
  }
}

TEST(DifferenceSmoother, ColumnsDoNotTouchEachOther) {
  const auto seen = all_but(50, 20, 3);
  DifferenceSmoother smoother(seen, 4);
  ASSERT_TRUE(smoother.factor(0.1));
  SeriesMatrix both = noise(50, 2, 9);
  SeriesMatrix one = both.col(1);
  smoother.smooth(both);
  smoother.smooth(one);
  EXPECT_EQ(both.col(1), one.col(0));
}

TEST(DifferenceSmoother, OfALongSeriesIsThatOfItsParts) {
  // Rows that repeat are copied: far from the ends nothing differs from a shorter recording about the place.
  const std::int64_t n = 3000;
  auto seen = all_but(n, 2000, 12);
  for (const int order : {3, 5}) {
    const SeriesMatrix y = noise(n, 3, 11);
    SeriesMatrix whole = y, part = y.middleRows(1500, 1000);
    DifferenceSmoother smoother(seen, order), of_part({seen.begin() + 1500, seen.begin() + 2500}, order);
    ASSERT_TRUE(smoother.factor(0.08));
    ASSERT_TRUE(of_part.factor(0.08));
    smoother.smooth(whole);
    of_part.smooth(part);
    EXPECT_LT((whole.middleRows(1700, 600) - part.middleRows(200, 600)).cwiseAbs().maxCoeff(), 1e-8) << order;
  }
}

TEST(DifferenceSmoother, DeterminantOfALongSeriesGrowsEvenly) {
  // Per sample it is the mean of a logarithm over the spectrum: the same for each thousand samples.
  std::vector<double> found;
  for (const std::int64_t n : {1000, 2000, 3000}) {
    DifferenceSmoother smoother(all_but(n, 0, 0), 4);
    ASSERT_TRUE(smoother.factor(0.1));
    found.push_back(smoother.log_determinant());
  }
  EXPECT_NEAR(found[2] - found[1], found[1] - found[0], 1e-8 * found[2]);
}

TEST(DifferenceSmoother, SaysWhereDoublePrecisionEnds) {
  DifferenceSmoother smoother(all_but(50, 0, 0), 5);
  EXPECT_FALSE(smoother.factor(0.005));  // (2 pi 0.005)^10 = 9e-16
  EXPECT_TRUE(smoother.factor(0.02));
}

TEST(DifferenceSmoother, RefusesTooFewSamples) {
  EXPECT_THROW(DifferenceSmoother(all_but(10, 3, 7), 3), ContractError);
  EXPECT_THROW(DifferenceSmoother(all_but(10, 0, 0), 6), ContractError);
}

TEST(SmoothingChoice, RiskIsThatOfManyRecordings) {
  // SURE is unbiased: over recordings of the same path, its mean is the mean squared error.
  const int n = 300;
  SeriesMatrix truth(n, 3);
  for (int i = 0; i < n; ++i)
    for (int a = 0; a < 3; ++a) truth(i, a) = 40.0 * std::sin(0.07 * i + a);
  const auto seen = all_but(n, 100, 8);
  double said = 0.0, true_error = 0.0;
  const int recordings = 40;
  for (int k = 0; k < recordings; ++k) {
    const SeriesMatrix y = truth + noise(n, 3, 100 + static_cast<std::uint64_t>(k));
    SmoothingSearch search{.orders = {4}, .lowest = 0.03, .highest = 0.031, .frequencies = 1};
    const auto choice = choose_smoothing(y, seen, search);
    ASSERT_TRUE(choice);
    DifferenceSmoother smoother(seen, choice->order);
    ASSERT_TRUE(smoother.factor(choice->half_power));
    SeriesMatrix out = y;
    smoother.smooth(out);
    double squares = 0.0;
    for (int i = 0; i < n; ++i)
      if (seen[at(i)]) squares += (out.row(i) - truth.row(i)).squaredNorm();
    true_error += squares / (3.0 * 292.0) / recordings;
    said += choice->risk / recordings;
  }
  EXPECT_NEAR(said, true_error, 0.02);
}

TEST(SmoothingChoice, ChoosesLittleErrorAndASmallerCutOffForSlowerPaths) {
  const int n = 400;
  std::vector<double> chosen;
  for (const double speed : {0.02, 0.2}) {
    SeriesMatrix y = noise(n, 3, 3);
    for (int i = 0; i < n; ++i) y.row(i).array() += 50.0 * std::sin(speed * i);
    const auto choice = choose_smoothing(y, all_but(n, 0, 0), {.lowest = 0.004});
    ASSERT_TRUE(choice);
    EXPECT_LT(choice->risk, 0.35);
    chosen.push_back(choice->half_power);
  }
  EXPECT_LT(2.0 * chosen[0], chosen[1]);
}

TEST(SmoothingChoice, OfALongSeriesIsThatOfStretchesAllAlongIt) {
  const int n = 16000;
  SeriesMatrix y = noise(n, 3, 4);
  for (int i = 0; i < n; ++i) y.row(i).array() += 40.0 * std::sin(0.06 * i);
  std::vector<bool> seen = all_but(n, 4100, 3000);  // the whole of the second stretch
  const SmoothingSearch search{.orders = {4}, .lowest = 0.004, .samples = 10000};
  SmoothingSearch all = search;
  all.samples = n;
  const auto few = choose_smoothing(y, seen, search), every = choose_smoothing(y, seen, all);
  ASSERT_TRUE(few && every);
  EXPECT_NEAR(std::log(few->half_power / every->half_power), 0.0, 0.25);
  EXPECT_NEAR(few->risk, every->risk, 0.02);
}

TEST(SmoothingChoice, NothingOfTooFewSamples) {
  EXPECT_FALSE(choose_smoothing(noise(6, 3, 1), all_but(6, 0, 0), {.lowest = 0.01}));
}

TEST(NoiseFromDifferences, FindsTheNoiseBesideAMovement) {
  const int n = 2000;
  SeriesMatrix y = 0.4 * noise(n, 3, 8);
  for (int i = 0; i < n; ++i) y.row(i).array() += 300.0 * std::sin(0.05 * i);
  EXPECT_NEAR(noise_from_differences(y, all_but(n, 500, 20)), 0.4, 0.02);
}

TEST(NoiseFromDifferences, NeedsSevenSamplesInARow) {
  std::vector<bool> seen(60, true);
  for (std::size_t i = 0; i < 60; i += 6) seen[i] = false;
  EXPECT_TRUE(std::isnan(noise_from_differences(noise(60, 1, 2), seen)));
}

}  // namespace
}  // namespace kinemark::math
