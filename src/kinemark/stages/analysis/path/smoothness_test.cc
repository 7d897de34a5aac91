// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/smoothness.h"
#include "kinemark/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "kinemark/stages/analysis/path/spectrum.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using testing::kTurn;
using testing::minimum_jerk_speed;

struct Row {
  const char* what;
  double rate_hz;
  int last;  // samples 0 .. last
  std::function<double(int)> speed;
  double sparc, ldlj;
};

// Ten speed profiles with the values that the authors' own program gives them.
const std::vector<Row> kRows{
    {"Gaussian", 100, 199,
     [](int k) {
       const double t = -1.0 + 0.01 * k;
       return std::exp(-5.0 * t * t);
     },
     -1.414031261710, -5.816357414756},
    {"reach", 100, 100, [](int k) { return minimum_jerk_speed(k / 100.0); }, -1.405829324421,
     -5.301633248098},
    {"reach, 60 Hz", 60, 60, [](int k) { return minimum_jerk_speed(k / 60.0); }, -1.400407742538,
     -5.287586537542},
    {"reach, 240 Hz", 240, 240, [](int k) { return minimum_jerk_speed(k / 240.0); }, -1.400407412273,
     -5.313631067785},
    {"reach, 128 Hz", 128, 127, [](int k) { return minimum_jerk_speed(k / 127.0); }, -1.392315993110,
     -5.306285552067},
    {"reach between rests", 100, 100, [](int k) { return minimum_jerk_speed((k / 100.0 - 0.2) / 0.6); },
     -1.400531236992, -6.841826213034},
    {"two", 100, 100,
     [](int k) { return minimum_jerk_speed(k / 60.0) + 0.7 * minimum_jerk_speed((k / 100.0 - 0.4) / 0.6); },
     -1.680906661718, -7.045224378499},
    {"three", 200, 300,
     [](int k) {
       double sum = 0.0;
       for (int i = 0; i < 3; ++i) sum += minimum_jerk_speed((k / 200.0 - 0.5 * i) / 0.5);
       return sum;
     },
     -2.703840956731, -9.709330387917},
    {"tremulous", 120, 120,
     [](int k) { return minimum_jerk_speed(k / 120.0) * (1.0 + 0.3 * std::sin(6.0 * kTurn * k / 120.0)); },
     -1.882068201036, -10.082041952565},
    {"wave", 100, 399, [](int k) { return 1.0 + 0.5 * std::sin(kTurn * k / 100.0); }, -2.701797982652,
     -10.005636243505},
};

TEST(Smoothness, EqualsTheAuthorsValues) {
  for (const auto& row : kRows) {
    Eigen::VectorXd speed(row.last + 1);
    for (int k = 0; k <= row.last; ++k) speed[k] = row.speed(k);
    EXPECT_NEAR(spectral_arc(speed, row.rate_hz).value, row.sparc, 1e-9 * std::abs(row.sparc)) << row.what;
    EXPECT_NEAR(log_dimensionless_jerk_of_speed(speed, row.rate_hz), row.ldlj, 1e-9 * std::abs(row.ldlj))
        << row.what;
  }
}

TEST(Smoothness, JerkOfAMinimumJerkReachIsItsClosedForm) {
  // Of the speed: from its definition with n samples to the analytic value as n grows.
  Eigen::VectorXd speed(10'001);
  for (int k = 0; k <= 10'000; ++k) speed[k] = minimum_jerk_speed(k / 10'000.0);
  EXPECT_NEAR(log_dimensionless_jerk_of_speed(speed, 10'000.0), -5.322033893165, 2.1e-4);
  // Of the path, with exact derivatives; trapezoids of a quartic over 2,000 steps.
  PathSamples path{.rate_hz = 2000.0, .x = SeriesMatrix::Zero(2001, 3)};
  path.v = path.a = path.j = path.x;
  for (int k = 0; k <= 2000; ++k) {
    const double u = k / 2000.0;
    path.v(k, 0) = minimum_jerk_speed(u);
    path.j(k, 0) = 60.0 - 360.0 * u + 360.0 * u * u;
  }
  EXPECT_NEAR(log_dimensionless_jerk(path), -5.322033893165, 1e-5);
  EXPECT_NEAR(rms_jerk(path), std::sqrt(720.0), 0.03);  // the ends count in full
}

TEST(Smoothness, CircleAtConstantSpeedHasTheJerkOfItsTurns) {
  // -4 ln(2 pi N) of N turns.
  for (const auto& [turns, value] :
       {std::pair{1, -7.351508265637}, {2, -10.124096987877}, {5, -13.789259915374}}) {
    const int n = 2000 * turns;
    PathSamples path{.rate_hz = 2000.0, .x = SeriesMatrix::Zero(n + 1, 3)};
    path.v = path.a = path.j = path.x;
    for (int k = 0; k <= n; ++k) {
      const double angle = kTurn * k / 2000.0;
      path.v.row(k) << -kTurn * std::sin(angle), kTurn * std::cos(angle), 0.0;
      path.j.row(k) << std::pow(kTurn, 3) * std::sin(angle), -std::pow(kTurn, 3) * std::cos(angle), 0.0;
    }
    EXPECT_NEAR(log_dimensionless_jerk(path), value, 1e-9) << turns;
  }
}

TEST(LowAmplitudes, OfALongSeriesAreThoseOfTheWholeTransform) {
  Random random(3, 0);
  Eigen::VectorXd speed(9000);
  for (Eigen::Index i = 0; i < speed.size(); ++i)
    speed[i] = 1.0 + 0.5 * std::sin(0.01 * static_cast<double>(i)) + 0.2 * random.uniform();
  constexpr std::int64_t kLength = 1 << 15, kHighest = kLength / 24;
  const Eigen::VectorXd all = amplitudes(speed, kLength), low = low_amplitudes(speed, kLength, kHighest);
  ASSERT_EQ(low.size(), kHighest + 1);
  EXPECT_LT((low - all.head(kHighest + 1)).cwiseAbs().maxCoeff(), 1e-9 * all.maxCoeff());
  // What lies above a third of a cycle per sample cannot be thinned out.
  EXPECT_EQ(low_amplitudes(speed, kLength, kLength / 2), all);
}

TEST(Amplitudes, OfAnyEvenLengthAreThoseOfTheSum) {
  // 34 and 250 fit no FourierTransform, 40 does.
  for (const std::int64_t length : {34, 40, 250}) {
    Eigen::VectorXd series(length - 4);
    for (Eigen::Index i = 0; i < series.size(); ++i) series[i] = std::cos(0.3 * static_cast<double>(i * i));
    const auto found = amplitudes(series, length);
    ASSERT_EQ(found.size(), length / 2 + 1);
    for (Eigen::Index k = 0; k < found.size(); ++k) {
      double re = 0.0, im = 0.0;
      for (Eigen::Index i = 0; i < series.size(); ++i) {
        const double angle = kTurn * static_cast<double>(i * k) / static_cast<double>(length);
        re += series[i] * std::cos(angle), im += series[i] * std::sin(angle);
      }
      EXPECT_NEAR(found[k], std::hypot(re, im), 1e-10) << length << " " << k;
    }
  }
}

TEST(Smoothness, IsNotDeterminedOfNothing) {
  EXPECT_TRUE(std::isnan(spectral_arc(Eigen::VectorXd::Zero(50), 100.0).value));
  EXPECT_TRUE(std::isnan(spectral_arc(Eigen::VectorXd::Ones(1), 100.0).value));
  EXPECT_TRUE(std::isnan(log_dimensionless_jerk_of_speed(Eigen::VectorXd::Ones(50), 100.0)));
  EXPECT_TRUE(std::isnan(log_dimensionless_jerk_of_speed(Eigen::VectorXd::Ones(2), 100.0)));
}

}  // namespace
}  // namespace kinemark::analysis
