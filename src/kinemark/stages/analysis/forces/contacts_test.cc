// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/forces/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kinemark::analysis {
namespace {

using Eigen::VectorXd;

/// A step as a sum of two sinusoids: humps at equal heights, a valley between.
VectorXd step(int n) {
  VectorXd load(n);
  for (int i = 0; i < n; ++i) {
    const double u = std::numbers::pi * i / (n - 1.0);
    load[i] = 800.0 * std::sin(u) + 300.0 * std::sin(3.0 * u);
  }
  return load;
}

TEST(Contacts, BeginAndEndWithTheLoad) {
  VectorXd load = VectorXd::Zero(100);
  load.segment(20, 30).setConstant(500.0);
  load[50] = 12.0;  // still on the way out
  load.segment(70, 3).setConstant(100.0);
  load.tail(10).setConstant(400.0);
  const auto contacts = find_contacts(load, 100.0);
  ASSERT_EQ(contacts.size(), 2u) << "three frames are a knock";
  EXPECT_EQ(contacts[0].first, 20);
  EXPECT_EQ(contacts[0].count, 31);
  EXPECT_TRUE(contacts[0].whole);
  EXPECT_EQ(contacts[1].first, 90);
  EXPECT_FALSE(contacts[1].whole) << "it lasts beyond the recording";
  load[51] = kNaN;
  EXPECT_FALSE(find_contacts(load, 100.0)[0].whole) << "nobody saw its end";
}

TEST(Contacts, HumpsOfAStepAreItsExtremes) {
  const VectorXd load = step(1001);
  // 800 sin u + 300 sin 3u = 1700 s - 1200 s^3: largest where s^2 = 17 / 36.
  const double s = std::sqrt(17.0 / 36.0);
  const auto humps = load_humps(load);
  EXPECT_NEAR(humps.first, 1700.0 * s - 1200.0 * s * s * s, 0.01);
  EXPECT_NEAR(humps.second, humps.first, 1e-6);
  EXPECT_NEAR(humps.valley, 500.0, 1e-9);
  VectorXd one(101);
  for (int i = 0; i < 101; ++i) one[i] = std::sin(std::numbers::pi * i / 100.0);
  EXPECT_TRUE(std::isnan(load_humps(one).first)) << "a run has one hump";
}

TEST(Contacts, TheLoadingRateOfARampIsItsSlope) {
  VectorXd load(41);
  for (int i = 0; i < 41; ++i) load[i] = i <= 20 ? 50.0 * i : 1000.0 - 50.0 * (i - 20);
  EXPECT_NEAR(loading_rate(load, 100.0), 5000.0, 1e-9);
  load.setConstant(900.0);
  EXPECT_TRUE(std::isnan(loading_rate(load, 100.0)));
}

TEST(Contacts, ImpulsesOfOneTurnCancel) {
  VectorXd along(101);
  for (int i = 0; i < 101; ++i) along[i] = -100.0 * std::sin(2.0 * std::numbers::pi * i / 100.0);
  const auto both = braking_propulsion(along, 200.0);
  // Half a turn of 0.25 s: 100 x 2 / pi x 0.25.
  EXPECT_NEAR(both.braking, -100.0 * 2.0 / std::numbers::pi * 0.25, 0.01);
  EXPECT_NEAR(both.propulsion, -both.braking, 1e-9);
}

TEST(Contacts, TheCentreOfPressureRunsForwards) {
  Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(60, 3);
  for (int i = 0; i < 60; ++i) x(i, 1) = -0.004 * i;
  x.row(3).setConstant(kNaN);
  EXPECT_LT((direction_of_travel(x, VectorXd::Constant(60, 700.0)) + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(direction_of_travel(0.01 * x, VectorXd::Constant(60, 700.0)).norm(), 0.0);
  EXPECT_EQ(direction_of_travel(x.topRows(2), VectorXd::Constant(2, 700.0)).norm(), 0.0);
}

}  // namespace
}  // namespace kinemark::analysis
