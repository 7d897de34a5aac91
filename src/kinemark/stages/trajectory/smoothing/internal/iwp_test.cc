// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace kinemark::trajectory::smoothing {
namespace {

template <int m>
using Dense = Eigen::Matrix<double, m, m, Eigen::RowMajor>;

template <int m>
Dense<m> dense(const Square<m>& a) {
  return Eigen::Map<const Dense<m>>(a.data());
}

template <int m>
Dense<m> transition(double h) {
  Dense<m> f = Dense<m>::Zero();
  for (int i = 0; i < m; ++i)
    for (int j = i; j < m; ++j) f(i, j) = std::pow(h, j - i) / factorial(j - i);
  return f;
}

template <int m>
Dense<m> noise(double density, double h) {
  Dense<m> q;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      q(i, j) = density * std::pow(h, 2 * m - 1 - i - j) /
                ((2 * m - 1 - i - j) * factorial(m - 1 - i) * factorial(m - 1 - j));
  return q;
}

/// Some lower triangular root with a positive diagonal.
template <int m>
Square<m> some_root() {
  Square<m> s{};
  for (int i = 0; i < m; ++i)
    for (int j = 0; j <= i; ++j)
      s[static_cast<std::size_t>(i * m + j)] = i == j ? 1.0 + 0.2 * i : 0.3 * (j - i) + 0.5;
  return s;
}

template <class T>
class IwpCore : public ::testing::Test {};

template <int m>
struct Order {
  static constexpr int value = m;
};
using Orders = ::testing::Types<Order<2>, Order<3>, Order<4>, Order<5>>;
TYPED_TEST_SUITE(IwpCore, Orders);

TYPED_TEST(IwpCore, AdvanceIsThePlainCovarianceStep) {
  constexpr int m = TypeParam::value;
  for (const double h : {0.05, 0.4, 1.3}) {
    const Iwp<m> model(0.3);
    Square<m> s = some_root<m>();
    const Dense<m> before = dense<m>(Iwp<m>::covariance(s));
    Step<m> step;
    model.advance(h, s, &step);
    const Dense<m> f = transition<m>(h);
    const Dense<m> ahead = f * before * f.transpose() + noise<m>(0.3, h);
    EXPECT_LT((dense<m>(Iwp<m>::covariance(s)) - ahead).norm(), 1e-12 * ahead.norm());
    const Dense<m> gain = before * f.transpose() * ahead.inverse();
    EXPECT_LT((dense<m>(step.gain) - gain).norm(), 1e-7 * gain.norm());
    const Dense<m> left = before - gain * ahead * gain.transpose();
    EXPECT_LT((dense<m>(step.left) - left).norm(), 1e-8 * before.norm());
    for (int i = 0; i < m; ++i) {
      EXPECT_GT(s[static_cast<std::size_t>(i * m + i)], 0.0);
      for (int j = i + 1; j < m; ++j) EXPECT_EQ(s[static_cast<std::size_t>(i * m + j)], 0.0);
    }
  }
}

TYPED_TEST(IwpCore, TheWayBackChangesNothingOfTheWayForward) {
  constexpr int m = TypeParam::value;
  const Iwp<m> model(0.1);
  Square<m> with = some_root<m>(), without = with;
  Step<m> step;
  model.advance(0.2, with, &step);
  model.advance(0.2, without, nullptr);
  EXPECT_EQ(with, without);
}

TYPED_TEST(IwpCore, MeasureIsThePlainUpdate) {
  constexpr int m = TypeParam::value;
  Square<m> s = some_root<m>();
  const Dense<m> before = dense<m>(Iwp<m>::covariance(s));
  std::array<double, m> gain;
  Iwp<m>::measure(0.7, s, gain);
  const Eigen::Matrix<double, m, 1> k = before.col(0) / (before(0, 0) + 0.7);
  EXPECT_LT((dense<m>(Iwp<m>::covariance(s)) - (before - k * before.row(0))).norm(), 1e-13 * before.norm());
  for (int i = 0; i < m; ++i) EXPECT_NEAR(gain[static_cast<std::size_t>(i)], k(i), 1e-14);
}

TYPED_TEST(IwpCore, BackIsTheRauchTungStriebelStep) {
  constexpr int m = TypeParam::value;
  const double h = 0.3;
  const Iwp<m> model(0.2);
  Square<m> s = some_root<m>();
  Step<m> step;
  model.advance(h, s, &step);
  Eigen::Matrix<double, m, 1> filtered, later;
  for (int i = 0; i < m; ++i) {
    filtered(i) = 1.0 + i;
    later(i) = 0.5 - 2.0 * i;
  }
  const Eigen::Matrix<double, m, 1> expected =
      filtered + dense<m>(step.gain) * (later - transition<m>(h) * filtered);
  Iwp<m>::back(h, step, 1, filtered.data(), later.data());
  EXPECT_LT((later - expected).norm(), 1e-12 * expected.norm());
}

TYPED_TEST(IwpCore, GainsSettleAndStaySo) {
  constexpr int m = TypeParam::value;
  const Iwp<m> model(0.2);
  Gains<m> gains;
  Step<m> step;
  int steps = 0;
  while (gains.move(model, 1.0, 0.2, &step)) ASSERT_LT(++steps, 2000);
  EXPECT_GT(steps, 10);
  const Square<m> root = gains.root;
  EXPECT_FALSE(gains.move(model, 1.0, 0.2, &step));
  EXPECT_EQ(gains.root, root);
  EXPECT_TRUE(gains.move(model, 0.0, 0.2, &step));  // a missing sample
  EXPECT_GT(gains.root[0], root[0]);
  steps = 0;
  while (gains.move(model, 1.0, 0.2, &step)) ASSERT_LT(++steps, 2000);
  for (std::size_t i = 0; i < root.size(); ++i) EXPECT_NEAR(gains.root[i], root[i], 1e-9);
}

TEST(Iwp, CornerGivesTheCutoff) {
  for (int m = 2; m <= 5; ++m) {
    const double ratio = 2.0 * M_PI * 6.0 / corner_rad_s(m, 6.0);
    EXPECT_NEAR(1.0 / (1.0 + std::pow(ratio, 2 * m)), std::sqrt(0.5), 1e-12);
  }
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing
