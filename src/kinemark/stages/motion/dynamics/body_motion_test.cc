// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/body_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kHertz = 100.0;

/// A rod on a hinge about z, mass centre 0.3 m below it; a slide along z ends it, of no mass.
model::Model rod() {
  data::ModelDescription m;
  m.name = "rod";
  m.bodies = {{.name = "rod", .mass = 2.0, .com_in_body = {0.0, -0.3, 0.0}}, {.name = "end"}};
  m.coordinates = {{.name = "swing"}, {.name = "out", .is_rotation = false}};
  m.joints = {{.name = "hinge",
               .child_body_idx = 0,
               .axes = {{.is_rotation = true, .axis = Vector3d::UnitZ(), .coordinate_idx = 0}}},
              {.name = "slide",
               .parent_body_idx = 0,
               .child_body_idx = 1,
               .parent_from_joint = {.translation = {0, -1, 0}},
               .axes = {{.is_rotation = false, .axis = Vector3d::UnitZ(), .coordinate_idx = 1}}}};
  return model::Model::compile(m).value();
}

data::JointMotion motion_of(const model::Model& model, std::int64_t frames) {
  data::JointMotion motion;
  motion.time = {.rate_hz = kHertz, .frames = frames};
  for (const auto& c : model.description().coordinates) {
    motion.coordinates.push_back(c.name);
    motion.is_rotation.push_back(c.is_rotation);
  }
  return motion;
}

Vector3d vector(const BodyMotion& m, const Array<double>& values, std::int64_t f, int order,
                std::int64_t column) {
  return Eigen::Map<const Vector3d>(values.data() + m.index(f, order, column));
}

/// One frame: swing 0.3 rad at 2 rad/s and 5 rad/s^2, out 0.1 m at 0.4 m/s and 0.7 m/s^2.
struct RodFrame {
  model::Model model = rod();
  data::JointMotion motion = motion_of(model, 1);
  RodFrame() {
    motion.q = {0.3, 0.1};
    motion.qd = {2.0, 0.4};
    motion.qdd = {5.0, 0.7};
  }
};

TEST(BodyMotion, AHingeAndASlideByHand) {
  const RodFrame rod;
  const BodyMotionOptions options{
      .body_idx = {1, 0},
      .points = {{.name = "tip", .body_idx = 1, .x_in_body = {0, 0, 0.05}},
                 {.name = "seen", .body_idx = 1, .x_in_body = {0, 0, 0.05}, .relative_to_idx = 0},
                 {.name = "still", .x_in_body = {1, 2, 3}}},
      .error_bars = false};
  const auto m = body_motion(rod.model, rod.motion, options, {}).value();
  EXPECT_EQ(m.columns(), 6 * 2 + 3 + 3 * 3);
  EXPECT_TRUE(m.sd.empty());
  const Vector3d down(std::sin(0.3), -std::cos(0.3), 0.0), along(std::cos(0.3), std::sin(0.3), 0.0);
  const auto is = [&](int order, std::int64_t column, const Vector3d& x) {
    EXPECT_LT((vector(m, m.value, 0, order, column) - x).norm(), 1e-12) << order << " " << column;
  };
  // The mass centre of the rod: tangential 0.3 qdd, centripetal 0.3 qd^2.
  is(0, 6, 0.3 * down);
  is(1, 6, 0.3 * 2.0 * along);
  is(2, 6, 0.3 * (5.0 * along - 4.0 * down));
  is(0, 9, {0.0, 0.0, 0.3});  // attitude
  is(1, 9, {0.0, 0.0, 2.0});
  is(2, 9, {0.0, 0.0, 5.0});
  // The whole body's is the rod's: the end has no mass.
  for (int order = 0; order < 3; ++order) is(order, 12, vector(m, m.value, 0, order, 6));
  // The end turns with the rod and slides along z besides.
  is(0, 15, down + Vector3d(0, 0, 0.15));
  is(1, 15, 2.0 * along + Vector3d(0, 0, 0.4));
  is(2, 15, 5.0 * along - 4.0 * down + Vector3d(0, 0, 0.7));
  // Seen from the rod it stands below it; its velocity is that in the world along the rod's axes.
  is(0, 18, {0.0, -1.0, 0.15});
  is(1, 18, {2.0, 0.0, 0.4});
  is(2, 18, {5.0, 4.0, 0.7});
  is(0, 21, {1.0, 2.0, 3.0});
  is(1, 21, Vector3d::Zero());
  is(2, 21, Vector3d::Zero());
}

TEST(BodyMotion, RatesInTheBodysOwnAxes) {
  const RodFrame rod;
  const auto m =
      body_motion(rod.model, rod.motion, {.body_idx = {0}, .rates_in_body = true, .error_bars = false}, {})
          .value();
  EXPECT_LT((vector(m, m.value, 0, 1, 0) - Vector3d(0.6, 0, 0)).norm(), 1e-12);
  EXPECT_LT((vector(m, m.value, 0, 2, 0) - Vector3d(1.5, 1.2, 0)).norm(), 1e-12);
  EXPECT_LT((vector(m, m.value, 0, 0, 0) - 0.3 * Vector3d(std::sin(0.3), -std::cos(0.3), 0)).norm(), 1e-12)
      << "positions stay in the world";
}

TEST(BodyMotion, DeviationsByHand) {
  const RodFrame rod;
  // Swing: SD 0.01 rad, 0.2 rad/s, 3 rad/s^2, speed and acceleration correlated by 0.5. Out: 1 mm alone.
  const RateErrors errors{.covariance = {1e-4, 0, 0, 0.04, 0.3, 9.0, 1e-6, 0, 0, 0, 0, 0}};
  const auto m = body_motion(rod.model, rod.motion,
                             {.body_idx = {0}, .points = {{.name = "tip", .body_idx = 1}}}, errors)
                     .value();
  const Vector3d tip = vector(m, m.sd, 0, 0, 9);
  EXPECT_NEAR(tip.x(), 0.01 * std::cos(0.3), 1e-8);
  EXPECT_NEAR(tip.y(), 0.01 * std::sin(0.3), 1e-8);
  EXPECT_NEAR(tip.z(), 1e-3, 1e-9);
  EXPECT_NEAR(vector(m, m.sd, 0, 0, 3).z(), 0.01, 1e-9) << "attitude";
  EXPECT_NEAR(vector(m, m.sd, 0, 1, 3).z(), 0.2, 1e-9);
  EXPECT_NEAR(vector(m, m.sd, 0, 2, 3).z(), 3.0, 1e-9);
  // x of the tip's acceleration: qdd cos - qd^2 (-sin)..., by hand from down = (sin, -cos), along = (cos,
  // sin).
  const double by_q = -5.0 * std::sin(0.3) - 4.0 * std::cos(0.3), by_v = -4.0 * std::sin(0.3),
               by_a = std::cos(0.3);
  EXPECT_NEAR(vector(m, m.sd, 0, 2, 9).x(),
              std::sqrt(1e-4 * by_q * by_q + 0.04 * by_v * by_v + 2 * 0.3 * by_v * by_a + 9.0 * by_a * by_a),
              1e-5);
}

TEST(BodyMotion, TheMotionsOwnDeviationCountsWhereItIsTheLarger) {
  RodFrame rod;
  rod.motion.q_sd = {0.05, 0.0};
  const RateErrors errors{.covariance = {1e-4, 0, 0, 0.04, 0, 9.0, 0, 0, 0, 0, 0, 0},
                          .noise_scale = {9.0, 9.0}};
  const auto sd_of = [&] {
    const auto m = body_motion(rod.model, rod.motion, {.body_idx = {0}}, errors).value();
    return vector(m, m.sd, 0, 0, 3).z();
  };
  EXPECT_NEAR(sd_of(), 0.05, 1e-9);
  rod.motion.q_sd = {1e-3, 0.0};
  EXPECT_NEAR(sd_of(), 0.01, 1e-9) << "the smoother's is larger";
  rod.motion.q_sd.clear();
  EXPECT_NEAR(sd_of(), 9.0, 1e-3) << "none given: the noise that the smoother found";
}

TEST(BodyMotion, WhatIsNotDeterminedHasNoDeviationAndWhatIsFilledNoNumber) {
  RodFrame rod;
  rod.motion.determined = {1, 0};
  const RateErrors errors{.covariance = {1e-4, 0, 0, 0.04, 0, 9.0, 1e-6, 0, 0, 0, 0, 0}};
  const BodyMotionOptions options{.body_idx = {0}, .points = {{.name = "tip", .body_idx = 1}}};
  const auto open = body_motion(rod.model, rod.motion, options, errors).value();
  EXPECT_TRUE(vector(open, open.value, 0, 0, 9).allFinite()) << "the value stays";
  EXPECT_TRUE(std::isnan(vector(open, open.sd, 0, 0, 9).z()));
  EXPECT_TRUE(std::isfinite(vector(open, open.sd, 0, 0, 9).x())) << "the slide moves z alone";
  EXPECT_TRUE(vector(open, open.sd, 0, 0, 0).allFinite()) << "the rod does not slide";
  const auto filled = body_motion(rod.model, rod.motion, options, errors, {0, 1}).value();
  EXPECT_TRUE(std::isnan(vector(filled, filled.value, 0, 0, 9).z()));
  EXPECT_TRUE(std::isnan(vector(filled, filled.sd, 0, 0, 9).z()));
  EXPECT_TRUE(vector(filled, filled.value, 0, 0, 0).allFinite());
}

/// The moving test body: rates of what is followed are the derivatives of where it is.
TEST(BodyMotion, RatesAreDerivatives) {
  auto description = testing_body::description();
  for (auto& body : description.bodies) body.com_in_body = {0.02, -0.1, 0.01};
  const auto model = model::Model::compile(description).value();
  auto motion = motion_of(model, 400);
  motion.time.rate_hz = 1000.0;
  for (std::int64_t f = 0; f < 400; ++f) {
    const Eigen::VectorXd q = testing_body::coordinates(model, f, 1000.0);
    motion.q.insert(motion.q.end(), q.begin(), q.end());
  }
  const auto errors = estimate_rates(model, motion).value();
  BodyMotionOptions options{.points = {{.name = "p", .body_idx = 1, .x_in_body = {0.1, 0.2, 0.3}}},
                            .error_bars = false};
  for (int b = 0; b < std::ssize(description.bodies); ++b) options.body_idx.push_back(b);
  const auto m = body_motion(model, motion, options, errors).value();
  double worst_v = 0.0, worst_a = 0.0;
  for (std::int64_t f = 50; f < 350; ++f)
    for (std::int64_t k = 0; k < m.columns(); k += 3) {
      if (k < 6 * m.bodies && k % 6 == 3) continue;  // attitude: angles are not the integral of the rate
      const Vector3d before = vector(m, m.value, f - 1, 0, k), here = vector(m, m.value, f, 0, k),
                     after = vector(m, m.value, f + 1, 0, k);
      worst_v = std::max(worst_v, (500.0 * (after - before) - vector(m, m.value, f, 1, k)).norm());
      worst_a = std::max(worst_a, (1e6 * (after - 2.0 * here + before) - vector(m, m.value, f, 2, k)).norm());
    }
  EXPECT_LT(worst_v, 1e-4);
  EXPECT_LT(worst_a, 2e-3);
}

/// With noise of known size on the coordinates, the deviations cover the truth.
TEST(BodyMotion, DeviationsCoverTheTruth) {
  const auto model = model::Model::compile(testing_body::description()).value();
  constexpr std::int64_t kFrames = 200;
  constexpr double kSd = 0.005;
  std::array<int, 3> inside{}, all{};
  for (std::uint64_t seed = 41; seed <= 43; ++seed) {
    auto exact = motion_of(model, kFrames);
    for (std::int64_t f = 0; f < kFrames; ++f) {
      const Eigen::VectorXd q = testing_body::coordinates(model, f, kHertz);
      exact.q.insert(exact.q.end(), q.begin(), q.end());
    }
    auto noisy = exact;
    Random random(seed, 3);
    for (double& q : noisy.q) q += kSd * random.gaussian();
    const BodyMotionOptions options{.points = {{.name = "p", .body_idx = 1, .x_in_body = {0.1, 0.2, 0.3}}}};
    const auto truth = body_motion(model, exact, options, estimate_rates(model, exact).value()).value();
    const auto errors = estimate_rates(model, noisy).value();
    const auto m = body_motion(model, noisy, options, errors).value();
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (int order = 0; order < 3; ++order)
        for (std::int64_t k = 3; k < 6; ++k, ++all[static_cast<std::size_t>(order)])
          inside[static_cast<std::size_t>(order)] +=
              std::abs(m.value[m.index(f, order, k)] - truth.value[m.index(f, order, k)]) <
              2.0 * m.sd[m.index(f, order, k)];
  }
  for (std::size_t order = 0; order < 3; ++order)
    EXPECT_GT(inside[order], 0.9 * all[order]) << "order " << order;
}

TEST(BodyMotion, SameBitsForAnyNumberOfThreads) {
  const auto model = model::Model::compile(testing_body::description()).value();
  auto motion = motion_of(model, 60);
  for (std::int64_t f = 0; f < 60; ++f) {
    const Eigen::VectorXd q = testing_body::coordinates(model, f, kHertz);
    motion.q.insert(motion.q.end(), q.begin(), q.end());
  }
  const auto errors = estimate_rates(model, motion).value();
  BodyMotionOptions options{.body_idx = {0, 1}};
  const auto one = body_motion(model, motion, options, errors).value();
  options.threads = 3;
  const auto three = body_motion(model, motion, options, errors).value();
  EXPECT_TRUE(std::ranges::equal(one.value, three.value,
                                 [](double a, double b) { return a == b || (a != a && b != b); }));
  EXPECT_TRUE(
      std::ranges::equal(one.sd, three.sd, [](double a, double b) { return a == b || (a != a && b != b); }));
}

TEST(BodyMotion, WhatDoesNotFitIsRefused) {
  RodFrame rod;
  const auto sentence = [&](const BodyMotionOptions& options, const RateErrors& errors = {},
                            const Array<std::uint8_t>& filled = {}) {
    const auto m = body_motion(rod.model, rod.motion, options, errors, filled);
    return m ? std::string() : m.error().message;
  };
  EXPECT_THAT(sentence({}), HasSubstr("errors of rates are needed"));
  EXPECT_THAT(sentence({.error_bars = false}, {}, {1}), HasSubstr("what is filled"));
  EXPECT_THAT(sentence({.body_idx = {2}, .error_bars = false}), HasSubstr("is not of the model"));
  EXPECT_THAT(sentence({.body_idx = {-1}, .error_bars = false}), HasSubstr("is not of the model"));
  EXPECT_THAT(sentence({.points = {{.name = "p", .body_idx = 7}}, .error_bars = false}),
              HasSubstr("point 'p'"));
  rod.motion.qd.clear();
  EXPECT_THAT(sentence({.error_bars = false}), HasSubstr("no speeds"));
  rod.motion = motion_of(rod.model, 1);
  rod.motion.coordinates.pop_back();
  rod.motion.is_rotation.pop_back();
  rod.motion.q = {0.3};
  EXPECT_THAT(sentence({.error_bars = false}), HasSubstr("1 coordinates, the model 2"));
}

}  // namespace
}  // namespace kinemark::motion
