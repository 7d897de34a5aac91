// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kRate = 100.0;

/// A rod of 2 kg on a hinge about z, mass centre 0.3 m below it, gravity along -y.
model::Model pendulum() {
  data::ModelDescription m;
  m.name = "pendulum";
  m.gravity = {0.0, -9.81, 0.0};
  m.bodies.push_back({.name = "rod",
                      .mass = 2.0,
                      .com_in_body = {0.0, -0.3, 0.0},
                      .inertia_about_com = Eigen::Matrix3d::Identity() * 0.02});
  m.coordinates.push_back({.name = "swing"});
  m.joints.push_back({.name = "hinge",
                      .child_body_idx = 0,
                      .axes = {{.is_rotation = true, .axis = Vector3d::UnitZ(), .coordinate_idx = 0}}});
  return model::Model::compile(m).value();
}

data::JointMotion empty_motion(const model::Model& model, std::int64_t frames) {
  data::JointMotion motion;
  motion.time = {.rate_hz = kRate, .frames = frames};
  for (const auto& c : model.description().coordinates) {
    motion.coordinates.push_back(c.name);
    motion.is_rotation.push_back(c.is_rotation);
  }
  return motion;
}

TEST(InverseDynamics, PendulumByHand) {
  const auto model = pendulum();
  auto motion = empty_motion(model, 3);
  motion.q = {0.3, -0.7, 1.2};
  motion.qd = {1.0, 2.0, -3.0};
  motion.qdd = {0.5, 0.0, -8.0};
  const auto summary = inverse_dynamics(model, motion, {.error_bars = false}).value();
  for (std::size_t f = 0; f < 3; ++f)
    EXPECT_NEAR(motion.tau[f], (0.02 + 2.0 * 0.09) * motion.qdd[f] + 2.0 * 9.81 * 0.3 * std::sin(motion.q[f]),
                1e-12);
  EXPECT_TRUE(motion.tau_sd.empty());
  EXPECT_FALSE(summary.rates_estimated);
  EXPECT_TRUE(summary.roots.empty());
}

TEST(InverseDynamics, PendulumBarsByHand) {
  const auto model = pendulum();
  auto motion = empty_motion(model, 1);
  motion.q = {0.4};
  motion.qd = {1.0};
  motion.qdd = {2.0};
  const double qq = 1e-4, qa = -2e-3, aa = 0.09;
  const RateErrors errors{.covariance = {qq, 0.0, qa, 0.04, 0.0, aa}};
  (void)inverse_dynamics(model, motion, {}, nullptr, &errors).value();
  const double by_q = 2.0 * 9.81 * 0.3 * std::cos(0.4), by_a = 0.2;
  EXPECT_NEAR(motion.tau_sd[0], std::sqrt(by_q * by_q * qq + 2 * by_q * by_a * qa + by_a * by_a * aa), 1e-6);
  motion.q_sd = {0.05};  // the SD given for q takes precedence over that from smoothing
  (void)inverse_dynamics(model, motion, {}, nullptr, &errors).value();
  EXPECT_NEAR(motion.tau_sd[0], std::sqrt(by_q * by_q * 0.0025 + 2 * by_q * by_a * qa + by_a * by_a * aa),
              1e-6);
}

/// The test body with heavier segments; frames of its motion with noise on the independent coordinates.
struct Moving {
  model::Model model;
  data::JointMotion exact, noisy;

  Moving(std::int64_t frames, double sd, std::uint64_t seed) {
    auto description = testing_body::description();
    description.gravity = {0.0, -9.81, 0.0};
    for (auto& body : description.bodies) body.com_in_body = {0.0, -0.1, 0.01};
    model = model::Model::compile(description).value();
    exact = empty_motion(model, frames);
    for (std::int64_t f = 0; f < frames; ++f) {
      const Eigen::VectorXd q = testing_body::coordinates(model, f, kRate);
      for (int c = 0; c < q.size(); ++c) {
        const double omega = 2.0 * (0.4 + 0.07 * c), phase = omega * static_cast<double>(f) / kRate + 0.9 * c;
        const int source = c == 12 ? 11 : c;
        exact.q.push_back(q[c]);
        exact.qd.push_back(source == c ? 0.5 * omega * std::cos(phase) : 0.6 * exact.qd.back());
        exact.qdd.push_back(source == c ? -0.5 * omega * omega * std::sin(phase) : 0.6 * exact.qdd.back());
      }
    }
    noisy = exact;
    noisy.qd.clear();
    noisy.qdd.clear();
    Random random(seed, 8);
    for (double& q : noisy.q) q += sd * random.gaussian();
    noisy.q_sd.assign(noisy.q.size(), sd);
    noisy.determined.assign(noisy.q.size(), 1);
    for (std::int64_t f = 0; f < frames; ++f)
      noisy.q[noisy.index(f, 12)] = 0.6 * noisy.q[noisy.index(f, 11)] + 0.05;
  }
};

TEST(InverseDynamics, BarsCoverTheTruth) {
  int inside = 0, inside_two = 0, all = 0;
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Moving moving(200, 0.005, seed);
    (void)inverse_dynamics(moving.model, moving.exact, {.error_bars = false}).value();
    const auto summary = inverse_dynamics(moving.model, moving.noisy).value();
    EXPECT_TRUE(summary.rates_estimated);
    for (std::int64_t f = 0; f < 200; ++f)
      for (int c = 0; c < 12; ++c, ++all) {
        const auto i = moving.exact.index(f, c);
        const double z = std::abs(moving.noisy.tau[i] - moving.exact.tau[i]) / moving.noisy.tau_sd[i];
        inside += z < 1.0;
        inside_two += z < 2.0;
        squares += z * z;
      }
  }
  EXPECT_GT(inside, 0.62 * all);
  EXPECT_GT(inside_two, 0.93 * all);
  // Waves are smoother than the prior assumes, so that the error bars are too wide, within a limit.
  EXPECT_GT(std::sqrt(squares / all), 0.45);
}

/// Where the prior is true - white jerk, here in every coordinate - the bars are neither wide nor narrow.
TEST(InverseDynamics, BarsOfAMotionThatThePriorDescribesAreHonest) {
  constexpr int kFrames = 200, kSteps = 10;
  constexpr double kSd = 0.005, kJerk = 2.0;  // rad or m; per s^2.5
  int inside = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Moving moving(kFrames, kSd, seed);
    Random random(seed, 9);
    constexpr double h = 1.0 / (kRate * kSteps);
    for (int c = 0; c < 12; ++c) {
      double q = moving.exact.q[moving.exact.index(0, c)], v = 0.0, a = 0.0;
      for (std::int64_t f = 0; f < kFrames; ++f) {
        const auto i = moving.exact.index(f, c);
        moving.exact.q[i] = q;
        moving.exact.qd[i] = v;
        moving.exact.qdd[i] = a;
        moving.noisy.q[i] = q + kSd * random.gaussian();
        for (int k = 0; k < kSteps; ++k) {
          a += kJerk * std::sqrt(h) * random.gaussian();
          v += a * h;
          q += v * h;
        }
      }
    }
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (auto* motion : {&moving.exact, &moving.noisy}) {
        motion->q[motion->index(f, 12)] = 0.6 * motion->q[motion->index(f, 11)] + 0.05;
        if (motion->qd.empty()) continue;
        motion->qd[motion->index(f, 12)] = 0.6 * motion->qd[motion->index(f, 11)];
        motion->qdd[motion->index(f, 12)] = 0.6 * motion->qdd[motion->index(f, 11)];
      }
    (void)inverse_dynamics(moving.model, moving.exact, {.error_bars = false}).value();
    (void)inverse_dynamics(moving.model, moving.noisy).value();
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (int c = 6; c < 12; ++c, ++all) {  // the root's angles may pass their singular posture
        const auto i = moving.exact.index(f, c);
        inside += std::abs(moving.noisy.tau[i] - moving.exact.tau[i]) < moving.noisy.tau_sd[i];
      }
  }
  RecordProperty("inside", std::to_string(static_cast<double>(inside) / all));
  EXPECT_GT(inside, 0.60 * all);
  EXPECT_LT(inside, 0.76 * all);
}

TEST(InverseDynamics, AnyNumberOfThreadsGivesTheSameBits) {
  Moving one(60, 0.005, 1), many(60, 0.005, 1);
  (void)inverse_dynamics(one.model, one.noisy, {.threads = 1}).value();
  (void)inverse_dynamics(many.model, many.noisy, {.threads = 3}).value();
  for (std::int64_t i = 0; i < 60; ++i) {
    EXPECT_EQ(one.noisy.tau[one.noisy.index(i, 5)], many.noisy.tau[one.noisy.index(i, 5)]);
    EXPECT_EQ(one.noisy.tau_sd[one.noisy.index(i, 5)], many.noisy.tau_sd[one.noisy.index(i, 5)]);
  }
}

TEST(InverseDynamics, PowerIsTheRateOfEnergy) {
  Moving moving(3, 0.0, 1);
  auto& motion = moving.exact;
  (void)inverse_dynamics(moving.model, motion, {.error_bars = false}).value();
  // tau . qdot over independent coordinates against the change of kinetic and potential energy by
  // differences.
  const auto energy_at = [&](double frame) {
    const auto q_at = [&](double f) {
      Eigen::VectorXd q(13);
      for (int c = 0; c < 12; ++c)
        q[c] = 0.15 * c - 0.6 + 0.5 * std::sin(2.0 * (0.4 + 0.07 * c) * f / kRate + 0.9 * c);
      q[12] = 0.0;
      return model::state_from_coordinates(moving.model, q);
    };
    constexpr double h = 1e-3;
    Eigen::VectorXd v, far;
    model::difference(moving.model, q_at(frame - h), q_at(frame + h), v);
    model::difference(moving.model, q_at(frame - 2 * h), q_at(frame + 2 * h), far);
    v = (8.0 * v - far) * (kRate / (12.0 * h));
    model::Workspace w(moving.model);
    model::kinematics(moving.model, w, q_at(frame));
    model::velocities(moving.model, w, v);
    return model::kinetic_energy(moving.model, w) + model::potential_energy(moving.model, w);
  };
  double power = 0.0;
  for (int c = 0; c < 12; ++c) power += motion.tau[motion.index(1, c)] * motion.qd[motion.index(1, c)];
  const double slope = (energy_at(1.1) - energy_at(0.9)) / 0.2 * kRate;
  EXPECT_NEAR(power, slope, 1e-3 * std::abs(slope));
  EXPECT_TRUE(std::isnan(motion.tau[motion.index(1, 12)]));  // the kneecap is driven, not moved
}

/// A body that stands still, carried by plates under two of its segments.
struct Standing {
  model::Model model;
  data::JointMotion motion;
  data::Wrenches wrenches;

  explicit Standing(bool named) {
    auto description = testing_body::description();
    description.gravity = {0.0, -9.81, 0.0};
    description.bodies[2].name = "left_foot";
    description.bodies[4].name = "right_foot";
    model = model::Model::compile(description).value();
    motion = empty_motion(model, 2);
    const Eigen::VectorXd q = testing_body::coordinates(model, 30);
    model::Workspace w(model);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    Vector3d com = Vector3d::Zero();
    for (std::size_t b = 0; b < model.bodies().size(); ++b)
      com += model::point_in_world(w, static_cast<int>(b), model.bodies()[b].com_in_body) / 6.0;
    for (int f = 0; f < 2; ++f) motion.q.insert(motion.q.end(), q.data(), q.data() + q.size());
    motion.qd.assign(motion.q.size(), 0.0);
    motion.qdd.assign(motion.q.size(), 0.0);
    wrenches.time = motion.time;
    // Two forces and a moment that hold the weight of 6 kg at the mass centre.
    Vector3d left, right;
    for (int b = 0; b < 6; ++b) {
      const auto& name =
          model.description()
              .bodies[static_cast<std::size_t>(model.bodies()[static_cast<std::size_t>(b)].description_idx)]
              .name;
      if (name == "left_foot") left = w.position[static_cast<std::size_t>(b)];
      if (name == "right_foot") right = w.position[static_cast<std::size_t>(b)];
    }
    const Vector3d weight(0.0, 6.0 * 9.81, 0.0);
    const Vector3d moment = (com - 0.4 * left - 0.6 * right).cross(weight);
    wrenches.items.resize(2);
    for (std::size_t k = 0; k < 2; ++k) {
      auto& wrench = wrenches.items[k];
      wrench.name = k == 0 ? "plate 1" : "plate 2";
      if (named) wrench.body = k == 0 ? "left_foot" : "right_foot";
      const Vector3d force = (k == 0 ? 0.4 : 0.6) * weight, point = k == 0 ? left : right,
                     twist = k == 0 ? moment : Vector3d::Zero();
      for (int f = 0; f < 2; ++f)
        for (int axis = 0; axis < 3; ++axis) {
          wrench.force.push_back(force[axis]);
          wrench.point.push_back(point[axis]);
          wrench.moment.push_back(twist[axis]);
        }
    }
  }
};

TEST(InverseDynamics, PlatesLeaveTheRootNothingToDo) {
  for (const bool named : {true, false}) {
    Standing standing(named);
    const auto summary =
        inverse_dynamics(standing.model, standing.motion, {.error_bars = false}, &standing.wrenches).value();
    ASSERT_EQ(summary.roots.size(), 1u);
    EXPECT_EQ(summary.roots[0].body, "trunk");
    EXPECT_LT(summary.roots[0].force_max_n, 1e-9);
    EXPECT_LT(summary.roots[0].moment_max_nm, 1e-9);
    EXPECT_NEAR(summary.body_weight_n, 6.0 * 9.81, 1e-9);
    ASSERT_EQ(summary.contacts.size(), 2u);
    EXPECT_EQ(summary.contacts[0].body, "left_foot");
    EXPECT_EQ(summary.contacts[1].body, "right_foot");
    EXPECT_EQ(summary.contacts[1].last_frame, 1);
    EXPECT_THAT(summary.warnings, Each(Not(HasSubstr("frames have no torques: a force was not measured"))));
  }
}

TEST(InverseDynamics, WithoutPlatesTheRootCarriesTheWeight) {
  Standing standing(true);
  const auto summary = inverse_dynamics(standing.model, standing.motion, {.error_bars = false}).value();
  EXPECT_NEAR(summary.roots[0].force_rms_n, 6.0 * 9.81, 1e-9);
  EXPECT_NEAR(standing.motion.tau[standing.motion.index(0, 4)], 6.0 * 9.81, 1e-9);  // along ty
}

TEST(InverseDynamics, EmptyPlatesAreLeftOut) {
  Standing standing(false);
  for (auto& f : standing.wrenches.items[0].force) f *= 0.1;  // 2.4 N
  const auto summary =
      inverse_dynamics(standing.model, standing.motion, {.error_bars = false}, &standing.wrenches).value();
  EXPECT_EQ(summary.contacts.size(), 1u);
  EXPECT_NEAR(summary.roots[0].force_max_n, 0.4 * 6.0 * 9.81, 1e-9);
}

TEST(InverseDynamics, UnknownForcesMakeUnknownTorques) {
  Standing standing(true);
  standing.wrenches.items[1].force[3] = kNaN;
  const auto summary =
      inverse_dynamics(standing.model, standing.motion, {.error_bars = false}, &standing.wrenches).value();
  EXPECT_FALSE(std::isnan(standing.motion.tau[0]));
  EXPECT_TRUE(std::isnan(standing.motion.tau[standing.motion.index(1, 0)]));
  ASSERT_EQ(summary.warnings.size(), 1u);
  EXPECT_THAT(summary.warnings[0],
              HasSubstr("1 of 2 frames have no torques: a force was not measured there"));
}

TEST(InverseDynamics, BadInputIsReportedInASentence) {
  Standing standing(true);
  auto wrong = standing.wrenches;
  wrong.items[0].body = "tail";
  EXPECT_THAT(
      inverse_dynamics(standing.model, standing.motion, {.error_bars = false}, &wrong).error().message,
      HasSubstr("wrench 'plate 1' names body 'tail'"));
  wrong = standing.wrenches;
  wrong.time.rate_hz = 50.0;
  EXPECT_THAT(
      inverse_dynamics(standing.model, standing.motion, {.error_bars = false}, &wrong).error().message,
      HasSubstr("2 frames at 50 Hz, the motion 2 frames at 100 Hz"));
  EXPECT_THAT(inverse_dynamics(standing.model, standing.motion, {.error_bars = false, .feet = {"hoof"}},
                               &standing.wrenches)
                  .error()
                  .message,
              HasSubstr("'hoof'"));
  EXPECT_THAT(inverse_dynamics(standing.model, standing.motion, {.contact_force_n = -1.0}).error().message,
              HasSubstr("contact force"));
  standing.motion.qdd[3] = kNaN;
  EXPECT_THAT(inverse_dynamics(standing.model, standing.motion).error().message, HasSubstr("finite"));
  auto description = testing_body::description();
  for (auto& body : description.bodies) body.mass = 0.0;
  const auto massless = model::Model::compile(description).value();
  auto motion = empty_motion(massless, 1);
  motion.q.assign(13, 0.0);
  EXPECT_THAT(inverse_dynamics(massless, motion).error().message,
              HasSubstr("no body of the model has a mass"));
}

}  // namespace
}  // namespace kinemark::motion
