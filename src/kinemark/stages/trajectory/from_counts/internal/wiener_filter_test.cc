// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/internal/wiener_filter.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::trajectory::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Sight<1>> noisy_wave(int n, double sd, bool gap) {
  Random random(11, 1);
  std::vector<Sight<1>> out(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    auto& s = out[static_cast<std::size_t>(k)];
    const double jitter = random.uniform(0.0, 0.003), noise = random.gaussian();
    s.time_s = 0.01 * k + jitter;
    s.information(0) = gap && k > 20 && k < 30 ? 0.0 : 1.0 / (sd * sd);
    s.value(0) = 0.2 * std::sin(9.0 * s.time_s) + sd * noise;
  }
  return out;
}

/// The same posterior by dense linear algebra: covariance of values of the process between sights, from its
/// Green's function, with polynomials of any size added.
struct Dense {
  VectorXd mean, variance;
};

Dense dense(const std::vector<Sight<1>>& sights, int order, double q) {
  const auto n = static_cast<Eigen::Index>(sights.size());
  const double begin = sights.front().time_s, unit = 0.1;
  MatrixXd prior(n, n);
  double factorial = 1.0;
  for (int i = 2; i < order; ++i) factorial *= i;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const double a = sights[static_cast<std::size_t>(i)].time_s - begin,
                   b = sights[static_cast<std::size_t>(j)].time_s - begin;
      // Integral of (a - s)^(m-1) (b - s)^(m-1) over s up to the earlier: Simpson's rule, exact enough at 400
      // steps.
      const double end = std::min(a, b);
      double sum = 0.0;
      for (int s = 0; s <= 400; ++s) {
        const double at = end * s / 400.0, weight = s == 0 || s == 400 ? 1.0 : s % 2 == 1 ? 4.0 : 2.0;
        sum += weight * std::pow((a - at) * (b - at), order - 1);
      }
      prior(i, j) = q * sum * end / 1200.0 / (factorial * factorial);
      for (int p = 0; p < order; ++p) prior(i, j) += 1e2 * std::pow(a / unit, p) * std::pow(b / unit, p);
    }
  MatrixXd h = MatrixXd::Zero(n, n);
  VectorXd z(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    h(i, i) = sights[static_cast<std::size_t>(i)].information(0);
    z[i] = sights[static_cast<std::size_t>(i)].value(0);
  }
  // posterior = prior (I + H prior)^-1
  const MatrixXd posterior = (MatrixXd::Identity(n, n) + prior * h).fullPivLu().solve(prior);
  return {posterior * (h * z), posterior.diagonal()};
}

template <int kOrder>
void compare_with_dense(bool gap) {
  const auto sights = noisy_wave(60, 1e-2, gap);
  const double q = std::pow(25.0, 2 * kOrder) * 0.01 * 1e-4;
  const Dense expected = dense(sights, kOrder, q);
  WienerFilter<kOrder, 1> filter(q, 1.0 / 25.0);
  filter.smooth(sights, true, [&](std::size_t k, const auto& x, const auto* p) {
    const auto i = static_cast<Eigen::Index>(k);
    // The start counts the first sights 1 % too much: that much may differ.
    EXPECT_NEAR(x(0), expected.mean[i], 0.03 * std::sqrt(expected.variance[i])) << kOrder << " at " << k;
    EXPECT_NEAR((*p)(0, 0), expected.variance[i], 0.02 * expected.variance[i]) << kOrder << " at " << k;
  });
}

TEST(WienerFilter, AgreesWithDenseAlgebra) {
  compare_with_dense<3>(false);
  compare_with_dense<4>(false);
}

TEST(WienerFilter, AgreesWithDenseAlgebraOverAGap) {
  compare_with_dense<3>(true);
  compare_with_dense<4>(true);
}

TEST(WienerFilter, KeepsAPolynomialAndItsDerivatives) {
  std::vector<Sight<1>> sights(80);
  for (std::size_t k = 0; k < sights.size(); ++k) {
    const double t = 0.01 * static_cast<double>(k);
    sights[k].time_s = t;
    sights[k].information(0) = 1e8;
    sights[k].value(0) = 0.1 + 0.5 * t - 2.0 * t * t;
  }
  WienerFilter<4, 1> filter(1e3, 0.05);
  filter.smooth(sights, false, [&](std::size_t k, const auto& x, const auto*) {
    const double t = sights[k].time_s;
    EXPECT_NEAR(filter.derivative(x, 0)(0), 0.1 + 0.5 * t - 2.0 * t * t, 1e-9);
    EXPECT_NEAR(filter.derivative(x, 1)(0), 0.5 - 4.0 * t, 1e-7);
    EXPECT_NEAR(filter.derivative(x, 2)(0), -4.0, 1e-5);
    const auto ahead = filter.shifted(x, filter.taylor_shift(0.004));
    EXPECT_NEAR(filter.derivative(ahead, 0)(0), 0.1 + 0.5 * (t + 0.004) - 2.0 * (t + 0.004) * (t + 0.004),
                1e-9);
  });
}

TEST(WienerFilter, StiffFiltersKeepTheirDigits) {
  // Order 5 at 0.3 Hz: normal equations of this problem have a condition beyond 1e20.
  const auto sights = noisy_wave(400, 1e-3, false);
  const double omega = 2.0 * std::numbers::pi * 0.3;
  WienerFilter<5, 1> filter(std::pow(omega, 10) * 0.01 * 1e-6, 1.0 / omega);
  double least = 1.0;
  filter.smooth(sights, true, [&](std::size_t, const auto& x, const auto* p) {
    EXPECT_TRUE(x.allFinite());
    least = std::min(least, (*p)(0, 0));
  });
  EXPECT_GT(least, 0.0);
}

TEST(WienerFilter, BlocksDoNotShow) {
  const auto sights = noisy_wave(700, 1e-3, false);
  const double q = std::pow(30.0, 8) * 0.01 * 1e-6;
  WienerFilter<4, 1> whole(q, 1.0 / 30.0), blocks(q, 1.0 / 30.0, 64);
  std::vector<double> mean(sights.size()), variance(sights.size());
  whole.smooth(sights, true, [&](std::size_t k, const auto& x, const auto* p) {
    mean[k] = x(0), variance[k] = (*p)(0, 0);
  });
  std::size_t visited = 0;
  blocks.smooth(sights, true, [&](std::size_t k, const auto& x, const auto* p) {
    EXPECT_DOUBLE_EQ(x(0), mean[k]);
    EXPECT_DOUBLE_EQ((*p)(0, 0), variance[k]);
    ++visited;
  });
  EXPECT_EQ(visited, sights.size());
}

TEST(WienerFilter, RunsEndAtLongGaps) {
  auto sights = noisy_wave(60, 1e-3, true);  // nothing from 21 to 29
  sights.front().information.setZero();
  using Runs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(runs_between_gaps(sights, 0.05), (Runs{{1, 20}, {30, 30}}));
  EXPECT_EQ(runs_between_gaps(sights, 0.5), (Runs{{1, 59}}));
  for (auto& s : sights) s.information.setZero();
  EXPECT_TRUE(runs_between_gaps(sights, 0.5).empty());
}

TEST(WienerFilter, AxesWithoutCorrelationAreSmoothedApart) {
  const auto one = noisy_wave(50, 1e-3, false);
  std::vector<Sight<3>> three(one.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    three[k].time_s = one[k].time_s;
    three[k].information = one[k].information(0) * Eigen::Matrix3d::Identity();
    three[k].value << one[k].value(0), -one[k].value(0), 0.0;
  }
  const double q = std::pow(30.0, 6) * 0.01 * 1e-6;
  WienerFilter<3, 1> scalar(q, 1.0 / 30.0);
  WienerFilter<3, 3> vector(q, 1.0 / 30.0);
  std::vector<double> mean(one.size()), variance(one.size());
  scalar.smooth(one, true, [&](std::size_t k, const auto& x, const auto* p) {
    mean[k] = x(0), variance[k] = (*p)(0, 0);
  });
  vector.smooth(three, true, [&](std::size_t k, const auto& x, const auto* p) {
    EXPECT_NEAR(x(0), mean[k], 1e-12);
    EXPECT_NEAR(x(1), -mean[k], 1e-12);
    EXPECT_NEAR((*p)(2, 2), variance[k], 1e-6 * variance[k]);
  });
}

}  // namespace
}  // namespace kinemark::trajectory::internal
