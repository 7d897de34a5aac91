// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/smoother/rates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::HasSubstr;

constexpr double kRate = 100.0;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

/// The moving test body with noise on its coordinates.
data::JointMotion noisy_motion(const model::Model& model, std::int64_t frames, double sd) {
  data::JointMotion motion;
  motion.time = {.rate_hz = kRate, .frames = frames};
  for (const auto& c : model.description().coordinates) {
    motion.coordinates.push_back(c.name);
    motion.is_rotation.push_back(c.is_rotation);
  }
  Random random(4, 4);
  for (std::int64_t f = 0; f < frames; ++f) {
    Eigen::VectorXd q = testing_body::coordinates(model, f, kRate);
    for (int c = 0; c < 12; ++c) q[c] += sd * random.gaussian();
    q[12] = 0.6 * q[11] + 0.05;
    motion.q.insert(motion.q.end(), q.data(), q.data() + q.size());
  }
  motion.q_sd.assign(motion.q.size(), sd);
  motion.determined.assign(motion.q.size(), 1);
  return motion;
}

double true_rate(int c, std::int64_t f) {
  const double omega = 2.0 * (0.4 + 0.07 * c);
  return 0.5 * omega * std::cos(omega * static_cast<double>(f) / kRate + 0.9 * c);
}

TEST(Rates, AreWithinTheirBars) {
  const auto model = body();
  auto motion = noisy_motion(model, 400, 0.004);
  const auto errors = estimate_rates(model, motion).value();
  int inside = 0, all = 0;
  for (std::int64_t f = 0; f < 400; ++f)
    for (int c = 0; c < 12; ++c, ++all) {
      const double vv = errors.covariance[6 * motion.index(f, c) + 3];
      inside += std::abs(motion.qd[motion.index(f, c)] - true_rate(c, f)) < std::sqrt(vv);
    }
  EXPECT_GT(inside, 0.60 * all);
  EXPECT_LT(inside, 0.85 * all);
}

TEST(Rates, CoupledCoordinatesFollow) {
  const auto model = body();
  auto motion = noisy_motion(model, 100, 0.001);
  const auto errors = estimate_rates(model, motion).value();
  for (const std::int64_t f : {0, 50, 99}) {
    EXPECT_NEAR(motion.qd[motion.index(f, 12)], 0.6 * motion.qd[motion.index(f, 11)], 1e-12);
    EXPECT_NEAR(motion.qdd[motion.index(f, 12)], 0.6 * motion.qdd[motion.index(f, 11)], 1e-10);
    EXPECT_TRUE(std::isnan(errors.covariance[6 * motion.index(f, 12)]));
  }
}

TEST(Rates, KeepWhatIsThere) {
  const auto model = body();
  auto motion = noisy_motion(model, 50, 0.001);
  motion.qd.assign(motion.q.size(), 7.0);
  motion.qdd.assign(motion.q.size(), 8.0);
  const auto errors = estimate_rates(model, motion).value();
  EXPECT_EQ(motion.qd[10], 7.0);
  EXPECT_EQ(motion.qdd[10], 8.0);
  EXPECT_GT(errors.covariance[6 * motion.index(20, 3) + 5], 0.0);
}

TEST(Rates, CoordinatesNeverDeterminedStandStill) {
  const auto model = body();
  auto motion = noisy_motion(model, 50, 0.001);
  for (std::int64_t f = 0; f < 50; ++f) {
    motion.determined[motion.index(f, 9)] = 0;
    motion.q_sd[motion.index(f, 9)] = std::numeric_limits<double>::quiet_NaN();
  }
  const auto errors = estimate_rates(model, motion).value();
  EXPECT_EQ(motion.qdd[motion.index(25, 9)], 0.0);
  EXPECT_TRUE(std::isnan(errors.covariance[6 * motion.index(25, 9)]));
}

TEST(Rates, LockedCoordinatesHaveNone) {
  auto description = testing_body::description();
  description.coordinates[9].locked = true;
  const auto model = model::Model::compile(description).value();
  auto motion = noisy_motion(model, 50, 0.001);
  const auto errors = estimate_rates(model, motion).value();
  EXPECT_EQ(motion.qd[motion.index(25, 9)], 0.0);
  EXPECT_EQ(errors.covariance[6 * motion.index(25, 9) + 5], 0.0);
}

TEST(Rates, PrescribedCoordinatesHaveThoseOfTheirFunction) {
  auto description = testing_body::description();
  const auto elbow = math::ScalarFunction::sine(0.3, 4.0, 0.2, 0.1);
  description.coordinates[9].prescribed = elbow;
  const auto model = model::Model::compile(description).value();
  auto motion = noisy_motion(model, 50, 0.001);
  auto other = motion;  // of a motion file that somebody made by hand: it is measured as it is
  for (std::int64_t f = 0; f < 50; ++f) motion.q[motion.index(f, 9)] = elbow(motion.time.time_s(f)).f;
  const auto errors = estimate_rates(model, motion).value();
  EXPECT_EQ(motion.qd[motion.index(25, 9)], elbow(motion.time.time_s(25)).df);
  EXPECT_EQ(motion.qdd[motion.index(25, 9)], elbow(motion.time.time_s(25)).ddf);
  EXPECT_EQ(errors.covariance[6 * motion.index(25, 9) + 5], 0.0);
  const auto of_other = estimate_rates(model, other).value();
  EXPECT_NE(other.qd[other.index(25, 9)], elbow(other.time.time_s(25)).df);
  EXPECT_GT(of_other.covariance[6 * other.index(25, 9) + 5], 0.0);
}

TEST(Rates, NeedEightFrames) {
  const auto model = body();
  auto motion = noisy_motion(model, 7, 0.001);
  EXPECT_THAT(estimate_rates(model, motion).error().message, HasSubstr("7 frames"));
}

}  // namespace
}  // namespace kinemark::motion
