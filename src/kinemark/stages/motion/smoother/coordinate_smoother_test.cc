// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"

namespace kinemark::motion {
namespace {

constexpr double kRate = 100.0;

struct Wave {
  [[nodiscard]] double value(double t) const {
    return 0.4 * std::sin(3.0 * t) + 0.1 * std::cos(9.0 * t + 1.0);
  }
  [[nodiscard]] double rate(double t) const {
    return 1.2 * std::cos(3.0 * t) - 0.9 * std::sin(9.0 * t + 1.0);
  }
  [[nodiscard]] double acceleration(double t) const {
    return -3.6 * std::sin(3.0 * t) - 8.1 * std::cos(9.0 * t + 1.0);
  }
};

std::vector<double> sampled(int frames, double noise_sd, std::uint64_t seed) {
  std::vector<double> y;
  Random random(seed, 9);
  for (int f = 0; f < frames; ++f) y.push_back(Wave{}.value(f / kRate) + noise_sd * random.gaussian());
  return y;
}

TEST(CoordinateSmoother, FivePointRatesAreExactOnAParabola) {
  Eigen::VectorXd y(7), rate, acceleration;
  for (int f = 0; f < 7; ++f) y[f] = 1.0 + 2.0 * (f / kRate) - 3.0 * (f / kRate) * (f / kRate);
  five_point_rates(y, kRate, rate, acceleration);
  for (int f = 0; f < 7; ++f) {
    EXPECT_NEAR(rate[f], 2.0 - 6.0 * f / kRate, 1e-11);
    EXPECT_NEAR(acceleration[f], -6.0, 1e-9);
  }
}

// A path as rough as noise, measured a thousand times better than it is rough.
TEST(CoordinateSmoother, WhatIsRougherThanTheNoiseCanBeIsMotion) {
  constexpr double kNoise = 1e-5;
  const auto rough = sampled(200, 0.01, 7);
  const std::vector<double> sd(200, kNoise);
  const auto any = smooth_coordinate(rough, sd, kRate), bounded = smooth_coordinate(rough, sd, kRate, 1.0);
  EXPECT_GT(any.noise_scale, 300.0) << "unbounded, the roughness is noise";
  EXPECT_LE(bounded.noise_scale, 1.0 + 1e-12);
  for (Eigen::Index f = 0; f < bounded.value.size(); ++f)
    EXPECT_NEAR(bounded.value[f], rough[static_cast<std::size_t>(f)], 10.0 * kNoise);
  // Where noise is below the bound nothing changes.
  const auto fine = sampled(200, 0.01, 8);
  const std::vector<double> wide(200, 0.03);
  EXPECT_EQ(smooth_coordinate(fine, wide, kRate).value, smooth_coordinate(fine, wide, kRate, 1.0).value);
}

// The same estimate by dense matrices: posterior mean, and the covariance of three-point rates.
TEST(CoordinateSmoother, IsTheDensePosterior) {
  constexpr int kFrames = 40;
  const auto y = sampled(kFrames, 0.01, 1);
  std::vector<double> sd(kFrames, 0.01);
  for (int f = 12; f < 20; ++f) sd[static_cast<std::size_t>(f)] = kNaN;
  for (int f = 25; f < 30; ++f) sd[static_cast<std::size_t>(f)] = 0.02;
  const auto smooth = smooth_coordinate(y, sd, kRate);
  ASSERT_TRUE(smooth.known);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(kFrames - 3, kFrames);
  for (int k = 0; k + 3 < kFrames; ++k) D.block<1, 4>(k, k) << -1.0, 3.0, -3.0, 1.0;
  Eigen::MatrixXd A = D.transpose() * D / (smooth.step_sd * smooth.step_sd);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    const double s = smooth.noise_scale * sd[static_cast<std::size_t>(f)];
    if (std::isnan(s)) continue;
    A(f, f) += 1.0 / (s * s);
    b[f] += y[static_cast<std::size_t>(f)] / (s * s);
  }
  const Eigen::MatrixXd C = A.inverse();
  EXPECT_LT((C * b - smooth.value).cwiseAbs().maxCoeff(), 1e-8);
  Eigen::RowVectorXd second_difference = Eigen::RowVectorXd::Zero(kFrames);
  for (const int f : {1, 15, 27, 38}) {
    second_difference.setZero();
    second_difference[f - 1] = second_difference[f + 1] = kRate * kRate;
    second_difference[f] = -2.0 * kRate * kRate;
    const double expected = second_difference * C * second_difference.transpose();
    EXPECT_NEAR(smooth.covariance(5, f), expected, 1e-5 * expected);
    EXPECT_NEAR(smooth.covariance(0, f), C(f, f), 1e-7 * C(f, f));
    EXPECT_NEAR(smooth.covariance(2, f), second_difference.dot(C.col(f)),
                1e-5 * std::sqrt(expected * C(f, f)));
  }
}

TEST(CoordinateSmoother, FindsTheNoiseAndItsBarsCover) {
  double noise = 0.0;
  std::vector<int> inside(3, 0);
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto smooth = smooth_coordinate(sampled(500, 0.01, seed), {}, kRate);
    noise += smooth.noise_scale / 8.0;
    for (int f = 0; f < 500; ++f, ++all) {
      const double t = f / kRate;
      inside[0] += std::abs(smooth.value[f] - Wave{}.value(t)) < std::sqrt(smooth.covariance(0, f));
      inside[1] += std::abs(smooth.rate[f] - Wave{}.rate(t)) < std::sqrt(smooth.covariance(3, f));
      inside[2] +=
          std::abs(smooth.acceleration[f] - Wave{}.acceleration(t)) < std::sqrt(smooth.covariance(5, f));
    }
  }
  EXPECT_NEAR(noise, 0.01, 4e-4);
  // A wave is smoother than the prior believes: the bars of its acceleration are wide, never narrow.
  for (const int count : inside) EXPECT_GT(count, 0.60 * all);
  EXPECT_LT(inside[0], 0.82 * all);
  EXPECT_LT(inside[1], 0.92 * all);
  EXPECT_LT(inside[2], 0.99 * all);
}

/// A movement like those of walks: its spectrum rises no further below 3 Hz. Of SD 1.
Eigen::VectorXd movement(std::uint64_t seed, int frames) {
  constexpr int kBefore = 300;
  const double kept = std::exp(-2.0 * M_PI * 3.0 / kRate);
  Random random(seed, 12);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(kBefore + frames);
  for (Eigen::Index k = 3; k < x.size(); ++k)
    x[k] = 3.0 * kept * x[k - 1] - 3.0 * kept * kept * x[k - 2] + kept * kept * kept * x[k - 3] +
           random.gaussian();
  x = x.tail(frames).eval();
  x.array() -= x.mean();
  return x / std::sqrt(x.squaredNorm() / frames);
}

constexpr int kWalk = 400;

Eigen::VectorXd with_noise(Eigen::VectorXd y, double noise_sd, std::uint64_t seed) {
  Random random(seed, 11);
  for (double& value : y) value += noise_sd * random.gaussian();
  return y;
}

/// Value and bars of a curve with this variance of a step, by dense matrices.
struct DenseCurve {
  Eigen::VectorXd value, variance;
  DenseCurve(const Eigen::VectorXd& y, double noise_sd, double step_variance) {
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(kWalk - 3, kWalk);
    for (int k = 0; k + 3 < kWalk; ++k) D.block<1, 4>(k, k) << -1.0, 3.0, -3.0, 1.0;
    const double information = 1.0 / (noise_sd * noise_sd);
    Eigen::MatrixXd A = D.transpose() * D / step_variance;
    A.diagonal().array() += information;
    const Eigen::MatrixXd C = A.inverse();
    value = C * (information * y);
    variance = C.diagonal();
  }
};

struct Held {
  double one = 0.0, two = 0.0, squares = 0.0;
  void add(const DenseCurve& curve, const Eigen::VectorXd& spread, const Eigen::VectorXd& truth) {
    for (int f = 0; f < kWalk; ++f) {
      const double off = curve.value[f] - truth[f];
      const double z = std::abs(off) / std::sqrt(curve.variance[f] + spread[f]);
      one += z < 1.0, two += z < 1.96, squares += off * off;
    }
  }
};

TEST(CoordinateSmoother, TheNearestCurveOfAWalkIsHeldByItsBarsWhereTheLikeliestIsNot) {
  constexpr double kNoise = 0.5;
  constexpr int kDraws = 12;
  Held nearest, likeliest;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const auto truth = movement(seed, kWalk), y = with_noise(truth, kNoise, seed);
    const Eigen::VectorXd weight = Eigen::VectorXd::Constant(kWalk, 1.0 / (kNoise * kNoise));
    const auto likely = smooth_coordinate({y.data(), kWalk}, std::vector<double>(kWalk, kNoise), kRate, 1.0);
    const double first = likely.step_sd * likely.step_sd;
    const auto curve = nearest_curve(y, weight, first);
    nearest.add(DenseCurve(y, kNoise, curve.step_variance), curve.spread, truth);
    likeliest.add(DenseCurve(y, kNoise, first), Eigen::VectorXd::Zero(kWalk), truth);
    // The search finds it from wherever it begins.
    EXPECT_NEAR(std::log(nearest_curve(y, weight, 100.0 * first).step_variance / curve.step_variance), 0.0,
                0.3);
  }
  EXPECT_GT(nearest.one, 0.62 * kDraws * kWalk);
  EXPECT_LT(nearest.one, 0.76 * kDraws * kWalk);
  EXPECT_GT(nearest.two, 0.92 * kDraws * kWalk);
  EXPECT_LT(nearest.two, 0.98 * kDraws * kWalk);
  EXPECT_LT(likeliest.two, 0.91 * kDraws * kWalk) << "without it this movement shows nothing";
  EXPECT_LT(nearest.squares, likeliest.squares);
}

TEST(CoordinateSmoother, ACurveOfAGivenStepIsTheDensePosterior) {
  constexpr double kNoise = 0.5, kStep = 1e-5;
  const auto y = with_noise(movement(3, kWalk), kNoise, 3);
  const auto curve = curve_of(y, Eigen::VectorXd::Constant(kWalk, 1.0 / (kNoise * kNoise)), kStep);
  const DenseCurve dense(y, kNoise, kStep);
  EXPECT_LT((curve.value - dense.value).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((curve.variance - dense.variance).cwiseAbs().maxCoeff(), 1e-6 * dense.variance.maxCoeff());
}

TEST(CoordinateSmoother, TheNearestCurveFindsNoiseThatMayBeLarger) {
  constexpr double kNoise = 0.1;
  const auto y = with_noise(movement(5, kWalk), 3.0 * kNoise, 5);
  const Eigen::VectorXd weight = Eigen::VectorXd::Constant(kWalk, 1.0 / (kNoise * kNoise));
  const double known = nearest_curve(y, weight / 9.0, 1e-3).step_variance,
               found = nearest_curve(y, weight, 1e-3, 20.0).step_variance,
               believed = nearest_curve(y, weight, 1e-3).step_variance;
  EXPECT_NEAR(std::log(found / known), 0.0, 0.5);
  EXPECT_GT(believed, 100.0 * known) << "what noise cannot be is motion";
}

TEST(CoordinateSmoother, TheNearestCurveOfTooFewSamplesIsWhereItBegan) {
  const Eigen::VectorXd y = Eigen::VectorXd::LinSpaced(50, 0.0, 1.0);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(50);
  weight.head(7).setOnes();
  const auto curve = nearest_curve(y, weight, 0.125);
  EXPECT_EQ(curve.step_variance, 0.125);
  EXPECT_EQ(curve.spread, Eigen::VectorXd::Zero(50));
}

TEST(CoordinateSmoother, ExactDataPassThrough) {
  const auto y = sampled(300, 0.0, 1);
  const auto smooth = smooth_coordinate(y, {}, kRate);
  for (int f = 5; f < 295; ++f) {
    EXPECT_NEAR(smooth.value[f], y[static_cast<std::size_t>(f)], 1e-6);
    EXPECT_NEAR(smooth.rate[f], Wave{}.rate(f / kRate), 1e-3);
    EXPECT_NEAR(smooth.acceleration[f], Wave{}.acceleration(f / kRate), 5e-2);
  }
}

TEST(CoordinateSmoother, BridgesGapsWithGrowingBars) {
  auto y = sampled(400, 0.005, 3);
  std::vector<double> sd(400, 0.005);
  for (std::size_t f = 150; f < 190; ++f) {
    y[f] = 100.0;  // never looked at
    sd[f] = kNaN;
  }
  const auto smooth = smooth_coordinate(y, sd, kRate);
  EXPECT_GT(smooth.covariance(0, 170), 9.0 * smooth.covariance(0, 100));
  EXPECT_GT(smooth.covariance(0, 170), smooth.covariance(0, 155));
  for (int f = 150; f < 190; ++f)
    EXPECT_LT(std::abs(smooth.value[f] - Wave{}.value(f / kRate)), 4.0 * std::sqrt(smooth.covariance(0, f)));
}

TEST(CoordinateSmoother, TooFewSamplesAreLeftAlone) {
  const std::vector<double> y = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  const auto smooth = smooth_coordinate(y, {}, kRate);
  EXPECT_FALSE(smooth.known);
  EXPECT_EQ(smooth.value[3], 4.0);
  EXPECT_EQ(smooth.rate[3], 0.0);
  EXPECT_TRUE(std::isnan(smooth.covariance(0, 3)));
}

TEST(CoordinateSmoother, ANumberThatNeverMovesStaysFinite) {
  const std::vector<double> y(50, 0.7);
  const auto smooth = smooth_coordinate(y, {}, kRate);
  EXPECT_NEAR(smooth.value[20], 0.7, 1e-12);
  EXPECT_NEAR(smooth.rate[20], 0.0, 1e-9);
  EXPECT_TRUE(smooth.covariance.allFinite());
}

TEST(CoordinateSmoother, LongRecordingsAreLearntOnStretches) {
  const auto smooth = smooth_coordinate(sampled(20000, 0.01, 5), {}, kRate);
  EXPECT_NEAR(smooth.noise_scale, 0.01, 4e-4);
  EXPECT_LT(std::sqrt(smooth.covariance(0, 10000)), 0.004);
}

}  // namespace
}  // namespace kinemark::motion
