// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/internal/iwp_smoother.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/internal/iwp.h"
#include "support/dense_spline.h"

namespace kinemark::trajectory::smoothing {
namespace {

using testing_support::DenseSpline;

struct Case {
  std::vector<double> t, y, r;
  std::vector<std::uint8_t> seen;
};

Case uneven_case(int n) {
  Random random(5, 17);
  Case c;
  double t = 0.0;
  for (int i = 0; i < n; ++i) {
    t += 0.01 * random.uniform(0.5, 1.5);
    c.t.push_back(t);
    c.y.push_back(std::sin(9.0 * t) + 0.05 * random.gaussian());
    c.r.push_back(random.uniform(0.3, 3.0));
    c.seen.push_back(random.uniform() < 0.8 || i == 0 || i + 1 == n ? 1 : 0);
  }
  return c;
}

TEST(IwpSmoother, EqualsTheDenseEstimateForUnequalTimesGapsAndVariances) {
  const Case c = uneven_case(60);
  for (int m = 2; m <= 5; ++m) {
    for (const double cutoff : {2.0, 8.0}) {
      Series s{60, 1, c.y.data(), c.seen.data(), c.r.data(), c.t.data(), 0.01};
      std::vector<double> state(240), variance(240);
      const Scores scores = smooth_series(s, m, cutoff, {state.data(), variance.data()});
      std::vector<double> t, y, r;
      std::vector<std::size_t> at;
      for (std::size_t i = 0; i < 60; ++i) {
        if (c.seen[i] == 0) continue;
        t.push_back(c.t[i]);
        y.push_back(c.y[i]);
        r.push_back(c.r[i]);
        at.push_back(i);
      }
      const DenseSpline exact(t, y, r, m, 0.01 * std::pow(corner_rad_s(m, cutoff), 2 * m));
      EXPECT_NEAR(scores.rss / exact.rss, 1.0, 1e-6) << m << " " << cutoff;
      EXPECT_NEAR(scores.trace / exact.trace, 1.0, 1e-6) << m << " " << cutoff;
      EXPECT_EQ(scores.values, std::ssize(t));
      for (std::size_t i = 0; i < at.size(); ++i) {
        EXPECT_NEAR(state[4 * at[i]], exact.smooth[i], 1e-7);
        EXPECT_NEAR(variance[4 * at[i]] / exact.variance[i], 1.0, 1e-5);
      }
    }
  }
}

TEST(IwpSmoother, CriteriaEqualTheDenseTraceForEvenTimes) {
  // Woltring's criterion (GCVSPL) is (RSS / n) / (1 - tr A / n)^2 of the spline with p = sigma^2 / q.
  Case c = uneven_case(50);
  for (std::size_t i = 0; i < 50; ++i) {
    c.t[i] = 0.01 * static_cast<double>(i);
    c.r[i] = 1.0;
  }
  std::fill(c.seen.begin(), c.seen.end(), std::uint8_t{1});
  for (int m = 3; m <= 5; ++m) {
    for (const double cutoff : {3.0, 12.0, 20.0}) {
      const Series s{50, 1, c.y.data(), c.seen.data(), nullptr, nullptr, 0.01};
      const Scores scores = smooth_series(s, m, cutoff, {});
      const DenseSpline exact(c.t, c.y, c.r, m, 0.01 * std::pow(corner_rad_s(m, cutoff), 2 * m));
      const double left = 1.0 - scores.trace / 50.0;
      EXPECT_NEAR(scores.rss / 50.0 / (left * left) / exact.gcv(), 1.0, 1e-6);
    }
  }
}

TEST(IwpSmoother, KeepsPolynomialsAndTheirDerivatives) {
  for (int m = 2; m <= 5; ++m) {
    constexpr int kFrames = 300;
    std::vector<double> y, state(kFrames * 4), variance(kFrames * 4);
    const std::vector<std::uint8_t> seen(kFrames, 1);
    for (int i = 0; i < kFrames; ++i) y.push_back(1.0 + std::pow(0.01 * i, m - 1));
    const Series s{kFrames, 1, y.data(), seen.data(), nullptr, nullptr, 0.01};
    const Scores scores = smooth_series(s, m, 5.0, {state.data(), variance.data()});
    EXPECT_LT(scores.rss, 1e-12);
    for (int i = 0; i < kFrames; ++i) {
      const double t = 0.01 * i;
      EXPECT_NEAR(state[static_cast<std::size_t>(4 * i)], y[static_cast<std::size_t>(i)], 1e-7);
      EXPECT_NEAR(state[static_cast<std::size_t>(4 * i + 1)], (m - 1) * std::pow(t, m - 2), 1e-5);
      if (m > 2)
        EXPECT_NEAR(state[static_cast<std::size_t>(4 * i + 2)], (m - 1) * (m - 2) * std::pow(t, m - 3), 1e-3);
      else
        EXPECT_TRUE(std::isnan(state[static_cast<std::size_t>(4 * i + 2)]));
    }
  }
}

TEST(IwpSmoother, BlocksAndSettledGainsChangeNothing) {
  // A recording of several blocks against its own copy with one needless interval array, which never settles.
  constexpr int kFrames = 9000;
  Random random(2, 3);
  std::vector<double> y, t;
  std::vector<std::uint8_t> seen;
  for (int i = 0; i < kFrames; ++i) {
    t.push_back(i / 100.0 * (1.0 + 1e-13 * (i % 7)));
    y.push_back(std::sin(0.06 * i) + 0.01 * random.gaussian());
    seen.push_back(i % 1000 < 30 && i > 100 ? 0 : 1);
  }
  for (const int m : {3, 5}) {
    std::vector<double> state[2], variance[2];
    for (int uneven = 0; uneven < 2; ++uneven) {
      state[uneven].resize(kFrames * 4);
      variance[uneven].resize(kFrames * 4);
      Series s{kFrames, 1, y.data(), seen.data(), nullptr, uneven == 1 ? t.data() : nullptr, 0.01};
      smooth_series(s, m, 6.0, {state[uneven].data(), variance[uneven].data()});
    }
    for (std::size_t i = 0; i < state[0].size(); ++i) {
      if (std::isnan(state[0][i])) {
        EXPECT_TRUE(std::isnan(state[1][i]));
        continue;
      }
      const double unit = std::pow(corner_rad_s(m, 6.0), static_cast<double>(i % 4));
      ASSERT_NEAR(state[0][i] / unit, state[1][i] / unit, 1e-8) << i;
      ASSERT_NEAR(variance[0][i] / variance[1][i], 1.0, 1e-6) << i;
    }
  }
}

TEST(IwpSmoother, NothingReachesAcrossALongGap) {
  constexpr int kFrames = 400;
  std::vector<double> y(kFrames, 1.0), state(kFrames * 4), variance(kFrames * 4);
  std::vector<std::uint8_t> seen(kFrames, 1);
  for (int i = 100; i < 300; ++i) seen[static_cast<std::size_t>(i)] = 0;
  for (int i = 300; i < kFrames; ++i) y[static_cast<std::size_t>(i)] = 5.0;
  const Series s{kFrames, 1, y.data(), seen.data(), nullptr, nullptr, 0.01};
  smooth_series(s, 4, 6.0, {state.data(), variance.data()});
  EXPECT_NEAR(state[4 * 99], 1.0, 1e-9);
  EXPECT_NEAR(state[4 * 99 + 1], 0.0, 1e-6);
  EXPECT_NEAR(state[4 * 300], 5.0, 1e-9);
  EXPECT_TRUE(std::isnan(state[4 * 200]));
}

TEST(IwpSmoother, SingleSamplesHaveAPositionAndNothingElse) {
  const std::vector<double> y{0.7};
  const std::vector<std::uint8_t> seen{1};
  std::vector<double> state(4), variance(4);
  const Series s{1, 1, y.data(), seen.data(), nullptr, nullptr, 0.01};
  const Scores scores = smooth_series(s, 5, 6.0, {state.data(), variance.data()});
  EXPECT_NEAR(state[0], 0.7, 1e-12);
  EXPECT_NEAR(variance[0], 1.0, 1e-9);
  EXPECT_TRUE(std::isnan(state[1]) && std::isnan(state[2]) && std::isnan(state[3]));
  EXPECT_NEAR(scores.trace, 1.0, 1e-9);
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing
