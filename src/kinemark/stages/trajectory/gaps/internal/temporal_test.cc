// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/gaps/internal/temporal.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace kinemark::trajectory::internal {
namespace {

/// Values of a polynomial beside and inside a gap.
struct Samples {
  Eigen::MatrixXd near, gap;
};

Samples polynomial(const GapShape& s, const Eigen::VectorXd& coefficients) {
  const auto value = [&](Index k) {
    double v = 0.0;
    const double t = 0.1 * static_cast<double>(k - s.left);
    for (Index i = coefficients.size() - 1; i >= 0; --i) v = v * t + coefficients(i);
    return v;
  };
  Samples out{Eigen::MatrixXd(s.near(), 1), Eigen::MatrixXd(s.length, 1)};
  for (Index k = 0; k < s.near(); ++k) out.near(k) = value(k < s.left ? k : k + s.length);
  for (Index k = 0; k < s.length; ++k) out.gap(k) = value(s.left + k);
  return out;
}

const Eigen::VectorXd kCubic = (Eigen::VectorXd(4) << 0.3, -1.2, 0.7, 0.4).finished();

TEST(Chord, IsStraightBetweenTheNearestSamplesAndHoldsWithOneSide) {
  const GapShape both{.length = 5, .left = 3, .right = 2};
  const Samples line = polynomial(both, kCubic.head(2));
  EXPECT_LT((chord_operator(both) * line.near - line.gap).norm(), 1e-12);
  const GapShape left{.length = 4, .left = 3};
  const GapShape right{.length = 4, .right = 3};
  const Eigen::Vector3d near(1.0, 2.0, 5.0);
  EXPECT_TRUE((chord_operator(left) * near).isConstant(5.0));
  EXPECT_TRUE((chord_operator(right) * near).isConstant(1.0));
}

TEST(Spline, ReproducesCubicsAndPassesThroughItsKnots) {
  for (const Index side : {2, 3, 10}) {
    const GapShape s{.length = 7, .left = side, .right = side + 1};
    const Samples cubic = polynomial(s, kCubic);
    EXPECT_LT((spline_operator(s) * cubic.near - cubic.gap).norm(), 1e-10) << side;
  }
  const GapShape three{.length = 4, .left = 2, .right = 1};  // a parabola
  const Samples parabola = polynomial(three, kCubic.head(3));
  EXPECT_LT((spline_operator(three) * parabola.near - parabola.gap).norm(), 1e-12);
}

TEST(Walk, IsTheLeastSquaresSolution) {
  for (const int order : {1, 2, 3}) {
    const GapShape s{.length = 9, .left = 6, .right = 8};
    const double lambda = walk_lambda(order, 5.0, 100.0);
    const Index n = s.length + s.near();
    Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n, n);
    for (int k = 0; k < order; ++k) D = (D.bottomRows(D.rows() - 1) - D.topRows(D.rows() - 1)).eval();
    Eigen::VectorXd W = Eigen::VectorXd::Ones(n);
    W.segment(s.left, s.length).setZero();
    const Eigen::MatrixXd N = Eigen::MatrixXd(W.asDiagonal()) + lambda * D.transpose() * D;
    const Eigen::MatrixXd all = N.fullPivLu().inverse();
    Eigen::MatrixXd expected(s.length, s.near());
    expected << all.block(s.left, 0, s.length, s.left),
        all.block(s.left, s.left + s.length, s.length, s.right);
    EXPECT_LT((walk_operator(s, order, lambda) - expected).norm(), 1e-7 * expected.norm()) << order;
  }
}

TEST(Walk, ReproducesPolynomialsBelowItsOrderAndExtrapolatesThem) {
  for (const int order : {1, 2, 3})
    for (const GapShape s :
         {GapShape{.length = 6, .left = 9, .right = 9}, GapShape{.length = 6, .left = 12}}) {
      const Samples p = polynomial(s, kCubic.head(order));
      EXPECT_LT((walk_operator(s, order, 100.0) * p.near - p.gap).norm(), 1e-7) << order << " " << s.right;
    }
}

TEST(Pchip, ReproducesLinesAndNeverOvershoots) {
  const GapShape s{.length = 8, .left = 4, .right = 4};
  const Eigen::VectorX<Index> rows = Eigen::VectorX<Index>::LinSpaced(8, 0, 7);
  const Samples line = polynomial(s, kCubic.head(2));
  EXPECT_LT((pchip_fill(s, line.near, rows) - line.gap).norm(), 1e-12);
  Eigen::MatrixXd near(8, 1);
  near << 0.0, 3.0, 9.0, 10.0, 11.0, 11.5, 3.0, 1.0;  // rises steeply to a flat top
  const Eigen::MatrixXd fill = pchip_fill(s, near, rows);
  EXPECT_GE(fill.minCoeff(), 10.0);
  EXPECT_LE(fill.maxCoeff(), 11.0);
  for (Index k = 0; k + 1 < 8; ++k) EXPECT_LE(fill(k), fill(k + 1));
}

TEST(WalkCacheTest, GivesTheRowsOfTheOperatorAgainAndAgain) {
  WalkCache cache;
  const GapShape s{.length = 40, .left = 8, .right = 8};
  const Eigen::VectorX<Index> rows = (Eigen::VectorX<Index>(3) << 0, 20, 39).finished();
  const Eigen::MatrixXd all = walk_operator(s, 2, 1e4);
  const auto first = cache.get(s, 2, 1e4, rows);
  EXPECT_TRUE(*first == all(rows, Eigen::indexing::all));
  EXPECT_EQ(first, cache.get(s, 2, 1e4, rows));
  EXPECT_FALSE(*cache.get(s, 2, 1e3, rows) == *first);
}

}  // namespace
}  // namespace kinemark::trajectory::internal
