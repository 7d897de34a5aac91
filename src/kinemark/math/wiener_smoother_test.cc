// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/wiener_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"

namespace kinemark::math {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using MatrixXl = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using VectorXl = Eigen::Vector<long double, Eigen::Dynamic>;
template <int kAxes>
using Observations = std::vector<PositionObservation<kAxes>>;
template <int kAxes>
using Estimates = std::vector<WienerEstimate<kAxes>>;

template <int kAxes>
Estimates<kAxes> smooth(const WienerProcess& process, const Observations<kAxes>& observations,
                        const WienerOptions<kAxes>& options = {}) {
  Estimates<kAxes> out(observations.size());
  std::size_t visited = observations.size();
  smooth_wiener<kAxes>(process, observations, options, [&](std::size_t k, const WienerEstimate<kAxes>& at) {
    EXPECT_EQ(k, --visited) << "last to first";
    out[k] = at;
  });
  EXPECT_EQ(visited, 0U);
  return out;
}

/// A wave seen at uneven times.
Observations<1> noisy_wave(int n, double sd, bool gap) {
  Random random(11, 1);
  Observations<1> out(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    auto& o = out[static_cast<std::size_t>(k)];
    const double jitter = random.uniform(0.0, 0.003), noise = random.gaussian();
    o.time_s = 0.01 * k + jitter;
    o.information(0) = gap && k > 20 && k < 30 ? 0.0 : 1.0 / (sd * sd);
    o.position(0) = 0.2 * std::sin(9.0 * o.time_s) + sd * noise;
  }
  return out;
}

/// Points in space at uneven times, of which an instant shows any number of directions, from none to three.
Observations<3> partly_seen(int n) {
  Random random(5, 2);
  Observations<3> out(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    auto& o = out[static_cast<std::size_t>(k)];
    o.time_s = 0.01 * k + random.uniform(0.0, 0.004);
    for (int i = 0; i < 3; ++i) o.position(i) = 0.2 * std::sin(7.0 * o.time_s + i) + 1e-3 * random.gaussian();
    for (int rank = 0; rank < k % 4; ++rank) {
      Eigen::Vector3d seen;
      for (double& x : seen) x = random.gaussian();
      o.information += 1e5 * seen * seen.transpose();
    }
  }
  return out;
}

constexpr double kDigits = 1e-7;  // of a standard deviation

template <class Real>
Real power_over_factorial(Real t, int n) {
  Real out = 1.0;
  for (int i = 1; i <= n; ++i) out *= t / i;
  return n < 0 ? Real(0.0) : out;
}

/// Everything at once: the posterior of all states as a least squares problem, solved by orthogonal
/// transformations. Rows: the prior, every step of the process and every observation, each divided by its
/// standard deviation. Unlike covariances or normal equations this keeps half of the digits that a wide prior
/// costs.
struct WholeRecording {
  VectorXl mean;        ///< derivatives 0 to order - 1 of each instant, the axes of a derivative side by side
  MatrixXl covariance;  ///< of `mean`
  long double log_likelihood = 0.0;
};

/// Cholesky factor of the process noise of derivatives 0 to order - 1 over an interval.
MatrixXl step_noise_factor(const WienerProcess& process, long double dt_s) {
  const int m = process.order;
  MatrixXl unit(m, m);
  VectorXl size(m);
  for (int i = 0; i < m; ++i) {
    size[i] = std::sqrt(static_cast<long double>(process.spectral_density)) * std::pow(dt_s, m - i - 0.5L);
    for (int j = 0; j < m; ++j)
      unit(i, j) = power_over_factorial(1.0L, m - 1 - i) * power_over_factorial(1.0L, m - 1 - j) /
                   static_cast<long double>(2 * m - 1 - i - j);
  }
  return size.asDiagonal() * MatrixXl(unit.llt().matrixL());
}

template <int kAxes>
WholeRecording solve_whole(const WienerProcess& process, const Observations<kAxes>& observations,
                           const WienerPrior<kAxes>& prior) {
  const int m = process.order, each = m * kAxes;
  const auto n = static_cast<Eigen::Index>(observations.size());
  MatrixXl rows = MatrixXl::Zero((each + kAxes) * n, each * n);
  VectorXl right = VectorXl::Zero(rows.rows());
  long double log_prior = 0.0L;  // logarithm of the root of the determinant of the prior information
  for (int i = 0; i < m; ++i)
    for (int a = 0; a < kAxes; ++a) {
      const long double sd = prior.sd[static_cast<std::size_t>(i)];
      rows(kAxes * i + a, kAxes * i + a) = 1.0L / sd;
      if (i == 0) right[a] = prior.position[a] / sd;
      log_prior -= std::log(sd);
    }
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& o = observations[static_cast<std::size_t>(k)];
    if (k > 0) {
      const long double dt =
          static_cast<long double>(o.time_s) - observations[static_cast<std::size_t>(k) - 1].time_s;
      const MatrixXl factor = step_noise_factor(process, dt);
      MatrixXl transition = MatrixXl::Zero(m, m);
      for (int i = 0; i < m; ++i)
        for (int j = i; j < m; ++j) transition(i, j) = power_over_factorial(dt, j - i);
      const auto whitened = factor.triangularView<Eigen::Lower>();
      const MatrixXl from = whitened.solve(transition), to = whitened.solve(MatrixXl::Identity(m, m).eval());
      for (int a = 0; a < kAxes; ++a)
        for (int i = 0; i < m; ++i)
          for (int j = 0; j < m; ++j) {
            rows(each * k + kAxes * i + a, each * (k - 1) + kAxes * j + a) = -from(i, j);
            rows(each * k + kAxes * i + a, each * k + kAxes * j + a) = to(i, j);
          }
      log_prior -= kAxes * factor.diagonal().array().log().sum();
    }
    if (!(o.information.trace() > 0.0)) continue;
    const Eigen::Matrix<long double, kAxes, kAxes> information = o.information.template cast<long double>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<long double, kAxes, kAxes>> eigen(information);
    const MatrixXl root =
        eigen.eigenvalues().cwiseMax(0.0L).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
    rows.block(each * n + kAxes * k, each * k, kAxes, kAxes) = root;
    right.segment(each * n + kAxes * k, kAxes) = root * o.position.template cast<long double>();
  }
  const Eigen::HouseholderQR<MatrixXl> qr(rows);
  const MatrixXl r = qr.matrixQR().topRows(each * n).template triangularView<Eigen::Upper>();
  const VectorXl turned = qr.householderQ().transpose() * right;
  const MatrixXl inverse =
      r.template triangularView<Eigen::Upper>().solve(MatrixXl::Identity(each * n, each * n));
  return {.mean = inverse * turned.head(each * n),
          .covariance = inverse * inverse.transpose(),
          .log_likelihood = -0.5L * turned.tail(kAxes * n).squaredNorm() -
                            (r.diagonal().cwiseAbs().array().log().sum() - log_prior)};
}

template <int kAxes>
void expect_whole(const WienerProcess& process, const Observations<kAxes>& observations,
                  const WienerPrior<kAxes>& prior) {
  const WholeRecording whole = solve_whole(process, observations, prior);
  const auto smoothed = smooth<kAxes>(process, observations, {.prior = prior});
  constexpr int kEach = 3 * kAxes;
  for (std::size_t k = 0; k < smoothed.size(); ++k) {
    const auto at = process.order * kAxes * static_cast<Eigen::Index>(k);
    const MatrixXd c = whole.covariance.block<kEach, kEach>(at, at).template cast<double>();
    const VectorXd sd = c.diagonal().cwiseSqrt();
    for (int i = 0; i < kEach; ++i) {
      const double x = smoothed[k].derivative(i / kAxes)(i % kAxes);
      EXPECT_NEAR(x, static_cast<double>(whole.mean[at + i]), kDigits * sd[i])
          << "order " << process.order << ", " << k << ' ' << i;
      for (int j = 0; j < kEach; ++j)
        EXPECT_NEAR(smoothed[k].covariance(i, j), c(i, j), kDigits * sd[i] * sd[j])
            << process.order << ' ' << k << ' ' << i << ' ' << j;
    }
  }
  EXPECT_NEAR(wiener_log_likelihood<kAxes>(process, observations, prior),
              static_cast<double>(whole.log_likelihood),
              1e-9 * std::abs(static_cast<double>(whole.log_likelihood)));
}

double density(int order) { return std::pow(25.0, 2 * order) * 0.01 * 1e-4; }

TEST(WienerSmoother, IsThePosteriorOfTheProcess) {
  for (const int order : {3, 4, 5})
    expect_whole<1>({.order = order, .spectral_density = density(order), .time_scale_s = 1.0 / 25.0},
                    noisy_wave(40, 1e-2, true),
                    {.position = Eigen::Matrix<double, 1, 1>(0.1), .sd = {0.3, 3.0, 30.0, 600.0, 1.5e4}});
}

TEST(WienerSmoother, IsThePosteriorWhereInstantsShowSomeDirectionsOnly) {
  for (const int order : {3, 4, 5})
    expect_whole<3>({.order = order, .spectral_density = density(order), .time_scale_s = 1.0 / 25.0},
                    partly_seen(24), {.position = {0.1, -0.1, 0.0}, .sd = {0.3, 3.0, 30.0, 600.0, 1.5e4}});
}

TEST(WienerSmoother, AnyScaleOfTimeGivesTheSameAnswer) {
  const auto wave = noisy_wave(40, 1e-2, true);
  const WienerOptions<1> options{.prior = WienerPrior<1>{.sd = {1.0, 10.0, 1000.0}}};
  const WienerProcess process{.order = 3, .spectral_density = density(3), .time_scale_s = 0.02};
  const auto one = smooth<1>(process, wave, options), other = smooth<1>({3, density(3), 1.0}, wave, options);
  for (std::size_t k = 0; k < wave.size(); ++k) {
    EXPECT_NEAR(one[k].derivatives(0), other[k].derivatives(0), 1e-9);
    EXPECT_LT((one[k].covariance - other[k].covariance).norm(), 1e-7 * one[k].covariance.norm());
  }
}

// Without a prior: the start counts the first observations 1 % too much, and that much may differ from a
// process of which nothing is known before.
TEST(WienerSmoother, WithoutAPriorTheDataAloneCount) {
  for (const bool gap : {false, true})
    for (const int order : {3, 4, 5}) {
      const auto wave = noisy_wave(60, 1e-2, gap);
      const WienerProcess process{
          .order = order, .spectral_density = density(order), .time_scale_s = 1.0 / 25.0};
      const WholeRecording whole = solve_whole<1>(process, wave, {.sd = {1e2, 1e4, 1e6, 1e8, 1e10}});
      const auto smoothed = smooth<1>(process, wave);
      for (std::size_t k = 0; k < wave.size(); ++k) {
        const auto at = order * static_cast<Eigen::Index>(k);
        const auto variance = static_cast<double>(whole.covariance(at, at)),
                   mean = static_cast<double>(whole.mean[at]);
        EXPECT_NEAR(smoothed[k].derivatives(0), mean, 0.03 * std::sqrt(variance)) << order << ' ' << k;
        EXPECT_NEAR(smoothed[k].covariance(0, 0), variance, 0.02 * variance) << order << ' ' << k;
      }
    }
}

// No process noise: a polynomial of degree order - 1 by weighted least squares.
TEST(WienerSmoother, WithoutNoiseItFitsAPolynomial) {
  for (const int order : {3, 4, 5}) {
    const auto wave = noisy_wave(50, 1e-2, true);
    const WienerPrior<1> prior{.sd = {10.0, 1e2, 1e3, 1e4, 1e5}};
    const auto smoothed = smooth<1>({.order = order, .time_scale_s = 0.25}, wave, {.prior = prior});
    MatrixXd square = MatrixXd::Zero(order, order);
    VectorXd right = VectorXd::Zero(order);
    const auto row = [&](double t, int derivative) {
      VectorXd out(order);
      for (int p = 0; p < order; ++p) out[p] = power_over_factorial(t - wave[0].time_s, p - derivative);
      return out;
    };
    for (int p = 0; p < order; ++p) square(p, p) = std::pow(prior.sd[static_cast<std::size_t>(p)], -2.0);
    for (const auto& o : wave) {
      square += o.information(0) * row(o.time_s, 0) * row(o.time_s, 0).transpose();
      right += o.information(0) * o.position(0) * row(o.time_s, 0);
    }
    const MatrixXd covariance = square.inverse();
    for (std::size_t k = 0; k < wave.size(); ++k)
      for (int d = 0; d < 3; ++d) {
        const VectorXd r = row(wave[k].time_s, d);
        const double variance = r.dot(covariance * r);
        EXPECT_NEAR(smoothed[k].derivatives(d), r.dot(covariance * right), 1e-4 * std::sqrt(variance));
        EXPECT_NEAR(smoothed[k].covariance(d, d), variance, 1e-4 * variance) << order << ' ' << k << ' ' << d;
      }
  }
}

TEST(WienerSmoother, ASingleObservationUpdatesThePrior) {
  const Observations<3> one{{.information = 1e4 * Eigen::Matrix3d::Identity(), .position = {1.0, 2.0, 3.0}}};
  const WienerPrior<3> prior{.position = {1.0, 1.0, 1.0}, .sd = {0.01, 3.0, 50.0}};
  const auto at = smooth<3>({.spectral_density = 1.0}, one, {.prior = prior})[0];
  EXPECT_LT((at.derivative(0) - Eigen::Vector3d(1.0, 1.5, 2.0)).norm(), 1e-12) << "halfway: both know 10 mm";
  EXPECT_EQ(at.derivative(1).norm() + at.derivative(2).norm(), 0.0);
  Eigen::Matrix<double, 9, 1> variance;
  variance << Eigen::Vector3d::Constant(0.5e-4), Eigen::Vector3d::Constant(9.0),
      Eigen::Vector3d::Constant(2500.0);
  EXPECT_LT((at.covariance - Eigen::Matrix<double, 9, 9>(variance.asDiagonal())).norm(), 1e-9);
}

TEST(WienerSmoother, WhatIsNotSeenFollowsThePrior) {
  Observations<1> nothing(4);
  for (std::size_t k = 0; k < nothing.size(); ++k) {
    nothing[k].time_s = 0.1 * static_cast<double>(k * k);
    nothing[k].position(0) = std::numeric_limits<double>::quiet_NaN();
  }
  const WienerPrior<1> prior{.position = Eigen::Matrix<double, 1, 1>(7.0), .sd = {1.0, 2.0, 3.0}};
  const auto smoothed = smooth<1>({.spectral_density = 5.0}, nothing, {.prior = prior});
  for (std::size_t k = 0; k < nothing.size(); ++k) {
    const double t = nothing[k].time_s, t2 = t * t;
    EXPECT_DOUBLE_EQ(smoothed[k].derivatives(0), 7.0);
    EXPECT_NEAR(smoothed[k].covariance(0, 0), 1.0 + 4.0 * t2 + 9.0 * t2 * t2 / 4.0 + 5.0 * t2 * t2 * t / 20.0,
                1e-12);
    EXPECT_NEAR(smoothed[k].covariance(1, 1), 4.0 + 9.0 * t2 + 5.0 * t2 * t / 3.0, 1e-12);
    EXPECT_NEAR(smoothed[k].covariance(2, 2), 9.0 + 5.0 * t, 1e-12);
  }
  EXPECT_EQ(wiener_log_likelihood<1>({.spectral_density = 5.0}, nothing, prior), 0.0);
}

TEST(WienerSmoother, KeepsAPolynomialAndItsDerivatives) {
  const auto x = [](double t) { return 0.1 + 0.5 * t - 2.0 * t * t; };
  Observations<1> parabola(80);
  for (std::size_t k = 0; k < parabola.size(); ++k) {
    parabola[k].time_s = 0.01 * static_cast<double>(k);
    parabola[k].information(0) = 1e8;
    parabola[k].position(0) = x(parabola[k].time_s);
  }
  for (const double shift_s : {0.0, 0.004, -0.003}) {
    const auto smoothed = smooth<1>({4, 1e3, 0.05}, parabola,
                                    {.covariance = WienerCovariance::none, .prior = {}, .shift_s = shift_s});
    for (std::size_t k = 0; k < parabola.size(); ++k) {
      const double t = parabola[k].time_s + shift_s;
      EXPECT_NEAR(smoothed[k].derivatives(0), x(t), 1e-9);
      EXPECT_NEAR(smoothed[k].derivatives(1), 0.5 - 4.0 * t, 1e-7);
      EXPECT_NEAR(smoothed[k].derivatives(2), -4.0, 1e-5);
      EXPECT_EQ(smoothed[k].covariance.norm(), 0.0) << "not asked for";
    }
  }
}

// Where nothing wanders, an estimate between two instants is that of the path itself.
TEST(WienerSmoother, AShiftedEstimateIsThatOfAnotherTime) {
  const auto wave = noisy_wave(30, 1e-2, false);
  auto inserted = wave;
  inserted.insert(inserted.begin() + 11, PositionObservation<1>{.time_s = wave[10].time_s + 0.004});
  const WienerPrior<1> prior{.sd = {1.0, 10.0, 100.0, 1e3}};
  const auto shifted = smooth<1>({4, 0.0, 0.1}, wave, {.prior = prior, .shift_s = 0.004});
  const auto exact = smooth<1>({4, 0.0, 0.1}, inserted, {.prior = prior});
  EXPECT_NEAR((shifted[10].derivatives - exact[11].derivatives).norm(), 0.0, 1e-9);
  EXPECT_LT((shifted[10].covariance - exact[11].covariance).norm(), 1e-9 * exact[11].covariance.norm());
}

TEST(WienerSmoother, CovarianceOfPositionsAloneIsTheSame) {
  const auto points = partly_seen(40);
  const WienerProcess process{.order = 4, .spectral_density = density(4), .time_scale_s = 0.04};
  const WienerPrior<3> prior{.sd = {1.0, 10.0, 100.0, 1e3}};
  const auto all = smooth<3>(process, points, {.prior = prior});
  const auto alone = smooth<3>(process, points, {.covariance = WienerCovariance::position, .prior = prior});
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_TRUE(alone[k].derivatives == all[k].derivatives) << k;
    EXPECT_TRUE(alone[k].covariance_of(0) == all[k].covariance_of(0)) << k;
    EXPECT_EQ(alone[k].covariance_of(1).norm(), 0.0);
    EXPECT_GT(all[k].covariance_of(1).norm(), 0.0);
  }
}

TEST(WienerSmoother, StiffFiltersKeepTheirDigits) {
  // Order 5 at 0.3 Hz: normal equations of this problem have a condition beyond 1e20.
  const double omega = 2.0 * std::numbers::pi * 0.3;
  const auto smoothed =
      smooth<1>({5, std::pow(omega, 10) * 0.01 * 1e-6, 1.0 / omega}, noisy_wave(400, 1e-3, false));
  for (const auto& at : smoothed) {
    EXPECT_TRUE(at.derivatives.allFinite());
    EXPECT_GT(at.covariance(0, 0), 0.0);
  }
}

TEST(WienerSmoother, BlocksDoNotShow) {
  const auto wave = noisy_wave(704, 1e-3, true);
  const WienerProcess process{4, std::pow(30.0, 8) * 0.01 * 1e-6, 1.0 / 30.0};
  const auto whole = smooth<1>(process, wave);
  for (const std::size_t block : {64U, 100U, 703U, 1U}) {
    const auto blocks = smooth<1>(process, wave, {.prior = {}, .block = block});
    for (std::size_t k = 0; k < wave.size(); ++k) {
      ASSERT_TRUE(blocks[k].derivatives == whole[k].derivatives) << block << ' ' << k;
      ASSERT_TRUE(blocks[k].covariance == whole[k].covariance) << block << ' ' << k;
    }
  }
}

TEST(WienerSmoother, AxesWithoutCorrelationAreSmoothedApart) {
  const auto one = noisy_wave(50, 1e-3, false);
  Observations<3> three(one.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    three[k].time_s = one[k].time_s;
    three[k].information = one[k].information(0) * Eigen::Matrix3d::Identity();
    three[k].position << one[k].position(0), -one[k].position(0), 0.0;
  }
  const WienerProcess process{3, std::pow(30.0, 6) * 0.01 * 1e-6, 1.0 / 30.0};
  const auto scalar = smooth<1>(process, one);
  const auto vector = smooth<3>(process, three);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_NEAR(vector[k].derivatives(0, 0), scalar[k].derivatives(0), 1e-12);
    EXPECT_NEAR(vector[k].derivatives(1, 0), -scalar[k].derivatives(0), 1e-12);
    EXPECT_NEAR(vector[k].covariance(2, 2), scalar[k].covariance(0, 0), 1e-6 * scalar[k].covariance(0, 0));
  }
}

TEST(WienerSmoother, RunsEndAtLongGaps) {
  auto wave = noisy_wave(60, 1e-3, true);  // nothing from 21 to 29
  wave.front().information.setZero();
  using Runs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(runs_between_gaps<1>(wave, 0.05), (Runs{{1, 20}, {30, 30}}));
  EXPECT_EQ(runs_between_gaps<1>(wave, 0.5), (Runs{{1, 59}}));
  for (auto& o : wave) o.information.setZero();
  EXPECT_TRUE(runs_between_gaps<1>(wave, 0.5).empty());
}

TEST(WienerSmoother, RefusesWhatItCannotDo) {
  auto wave = noisy_wave(20, 1e-3, false);
  EXPECT_THROW(smooth<1>({.order = 2, .spectral_density = 1.0}, wave), ContractError);
  EXPECT_THROW(smooth<1>({.order = 3, .spectral_density = -1.0}, wave), ContractError);
  EXPECT_THROW(smooth<1>({.order = 3, .spectral_density = 1.0}, wave, {.prior = {}, .block = 0}),
               ContractError);
  wave.front().information.setZero();
  EXPECT_THROW(smooth<1>({.order = 3, .spectral_density = 1.0}, wave), ContractError)
      << "nothing to begin from";
  EXPECT_TRUE(smooth<1>({.spectral_density = 1.0}, {}).empty());
}

}  // namespace
}  // namespace kinemark::math
