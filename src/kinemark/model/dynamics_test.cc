// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/model/dynamics.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"

namespace kinemark::model {
namespace {

using Eigen::MatrixXd;
using testing::random_state;
using testing::random_tree;
using testing::random_vector;
using testing::relative_error;

constexpr double kStep = 1e-5;
// Short, so that a spline's knot (a jump of the third derivative) within the stencil does no harm.
constexpr double kTimeStep = 1e-4;

// A central difference of sixth order: good to about 1e-11 on smooth functions.
template <class F>
auto slope_at(const F& f, double t, double h) {
  using Value = decltype(f(t));
  return Value(
      (45.0 * (f(t + h) - f(t - h)) - 9.0 * (f(t + 2 * h) - f(t - 2 * h)) + (f(t + 3 * h) - f(t - 3 * h))) /
      (60.0 * h));
}

// One model, with a state set and everything computed there.
struct Body {
  Model model;
  Workspace w{model};

  MatrixXd mass_at(const VectorXd& x) {
    kinematics(model, w, x);
    MatrixXd M;
    mass_matrix(model, w, M);
    return M;
  }
  VectorXd bias_at(const VectorXd& x, const VectorXd& v) {
    kinematics(model, w, x);
    velocities(model, w, v);
    VectorXd b;
    bias_forces(model, w, b);
    return b;
  }
  VectorXd gravity_at(const VectorXd& x) {
    kinematics(model, w, x);
    VectorXd g;
    gravity_forces(model, w, g);
    return g;
  }
  VectorXd moved(VectorXd x, const VectorXd& dv) const {
    integrate(model, x, dv);
    return x;
  }
};

class Dynamics : public ::testing::TestWithParam<int> {
 protected:
  std::uint64_t seed() const { return static_cast<std::uint64_t>(GetParam() / 2); }
  Random random{seed() + 200, 3};
  Body body{.model = Model::compile(random_tree(seed()), {.free_roots = GetParam() % 2 == 0}).value()};
  int n = body.model.speed_count();
};

INSTANTIATE_TEST_SUITE_P(Seeds, Dynamics, ::testing::Range(0, 16));

TEST_P(Dynamics, MassMatrixIsSymmetricPositiveDefinite) {
  const MatrixXd M = body.mass_at(random_state(body.model, random));
  EXPECT_EQ(M, M.transpose());
  EXPECT_EQ(Eigen::LLT<MatrixXd>(M).info(), Eigen::Success);
}

TEST_P(Dynamics, MassMatrixGivesTheKineticEnergyOfTheBodies) {
  for (int trial = 0; trial < 4; ++trial) {
    const VectorXd x = random_state(body.model, random), v = random_vector(n, 2.0, random);
    const MatrixXd M = body.mass_at(x);
    velocities(body.model, body.w, v);
    const double energy = kinetic_energy(body.model, body.w);
    EXPECT_NEAR(0.5 * v.dot(M * v), energy, 1e-12 * energy);
  }
}

TEST_P(Dynamics, GravityIsTheSlopeOfThePotentialEnergy) {
  const VectorXd x = random_state(body.model, random);
  const auto energy_at = [&](const VectorXd& y) {
    kinematics(body.model, body.w, y);
    return potential_energy(body.model, body.w);
  };
  VectorXd expected(n);
  for (int i = 0; i < n; ++i)
    expected[i] = (energy_at(body.moved(x, kStep * VectorXd::Unit(n, i))) -
                   energy_at(body.moved(x, -kStep * VectorXd::Unit(n, i)))) /
                  (2.0 * kStep);
  EXPECT_LT(relative_error(body.gravity_at(x), expected), 1e-7);
}

TEST(EulerRoot, BiasForcesFollowFromTheMassMatrix) {
  // Lagrange's equations in plain coordinates; the free root is compared with this parametrisation below.
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Body body{.model = Model::compile(random_tree(seed), {.free_roots = false}).value()};
    Random random(seed, 5);
    const int n = body.model.speed_count();
    const VectorXd x = random_state(body.model, random), v = random_vector(n, 2.0, random);
    const MatrixXd Mdot = (body.mass_at(x + kStep * v) - body.mass_at(x - kStep * v)) / (2.0 * kStep);
    VectorXd expected = Mdot * v;
    for (int i = 0; i < n; ++i) {
      const VectorXd step = kStep * VectorXd::Unit(n, i);
      expected[i] -= 0.5 * v.dot((body.mass_at(x + step) - body.mass_at(x - step)) * v) / (2.0 * kStep);
    }
    EXPECT_LT(relative_error(body.bias_at(x, v), expected), 1e-7);
  }
}

TEST_P(Dynamics, ForcesGiveThePowerThatChangesTheEnergy) {
  // A smooth motion of the coordinates; speeds by the exact slopes, accelerations by differences of the
  // speeds.
  const Model& model = body.model;
  const int coordinates = model.coordinate_count();
  const VectorXd a = random_vector(coordinates, 0.6, random), f = random_vector(coordinates, 2.0, random),
                 phase = random_vector(coordinates, 3.0, random);
  const VectorXd zero = VectorXd::Zero(coordinates);
  const auto state = [&](double t) {
    return state_from_coordinates(model, a.cwiseProduct((f * t + phase).array().sin().matrix()));
  };
  const auto speed = [&](double t) -> VectorXd {
    const VectorXd x = state(t);
    VectorXd q;
    coordinates_from_state(model, x, a.cwiseProduct((f * t + phase).array().sin().matrix()), q);
    kinematics(model, body.w, x);
    MatrixXd E;
    coordinate_jacobian(model, body.w, q, E);
    VectorXd rate = a.cwiseProduct(f).cwiseProduct((f * t + phase).array().cos().matrix());
    for (int c = 0; c < coordinates; ++c)  // only coordinates of their own tell the speeds
      if (model.coordinates()[static_cast<std::size_t>(c)].source >= 0 || E.row(c).isZero(0.0)) {
        E.row(c).setZero();
        rate[c] = 0.0;
      }
    return E.colPivHouseholderQr().solve(rate);
  };
  const auto energy = [&](double t) {
    const VectorXd v = speed(t);
    kinematics(model, body.w, state(t));
    velocities(model, body.w, v);
    return kinetic_energy(model, body.w) + potential_energy(model, body.w);
  };
  double worst = 0.0;
  for (const double t : {0.1, 0.45, 0.8}) {
    const VectorXd v = speed(t), vdot = slope_at(speed, t, kTimeStep);
    const VectorXd tau =
        body.mass_at(state(t)) * vdot + body.bias_at(state(t), v) + body.gravity_at(state(t));
    const double power = v.dot(tau);
    const double scale = v.cwiseAbs().dot(tau.cwiseAbs());
    worst = std::max(worst, std::abs(slope_at(energy, t, kTimeStep) - power) / scale);
  }
  EXPECT_LT(worst, 1e-8);
  RecordProperty("measured", fmt::format("{:.2e}", worst));
}

TEST(FreeRoot, AgreesWithEulerAnglesAfterMapping) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Body free{.model = Model::compile(random_tree(seed)).value()};
    Body euler{.model = Model::compile(random_tree(seed), {.free_roots = false}).value()};
    ASSERT_EQ(free.model.free_joints().size(), 1u);
    ASSERT_TRUE(euler.model.free_joints().empty());
    Random random(seed, 4);
    const VectorXd q0 = random_vector(free.model.coordinate_count(), 1.0, random);
    const VectorXd x = state_from_coordinates(free.model, q0),
                   v = random_vector(free.model.speed_count(), 1.5, random);
    const int n = free.model.speed_count();
    ASSERT_EQ(n, euler.model.speed_count());

    VectorXd q;
    // Euler speeds = T(x) * free speeds.
    const auto map_at = [&](const VectorXd& state) {
      coordinates_from_state(free.model, state, q0, q);
      kinematics(free.model, free.w, state);
      MatrixXd E, T(n, n);
      coordinate_jacobian(free.model, free.w, q, E);
      for (int c = 0; c < euler.model.coordinate_count(); ++c)
        if (const int speed = euler.model.coordinates()[static_cast<std::size_t>(c)].speed_idx; speed >= 0)
          T.row(speed) = E.row(c);
      return T;
    };
    const MatrixXd T = map_at(x);
    const VectorXd euler_x = state_from_coordinates(euler.model, q);
    const MatrixXd Tdot =
        (map_at(free.moved(x, kStep * v)) - map_at(free.moved(x, -kStep * v))) / (2.0 * kStep);

    kinematics(free.model, free.w, x);
    kinematics(euler.model, euler.w, euler_x);
    EXPECT_LT(relative_error(free.w.marker, euler.w.marker), 1e-13);
    const MatrixXd M = euler.mass_at(euler_x);
    EXPECT_LT(relative_error(free.mass_at(x), T.transpose() * M * T), 1e-12);
    EXPECT_LT(relative_error(free.gravity_at(x), T.transpose() * euler.gravity_at(euler_x)), 1e-12);
    const VectorXd bias = T.transpose() * (euler.bias_at(euler_x, T * v) + M * (Tdot * v));
    EXPECT_LT(relative_error(free.bias_at(x, v), bias), 1e-7);
  }
}

TEST(Dynamics, PendulumByHand) {
  // A point mass of 2 kg at 0.5 m below a hinge about z: M = m l^2, g = m g l sin(angle), no bias.
  data::ModelDescription d;
  d.bodies.push_back({.name = "bob", .mass = 2.0, .com_in_body = {0.0, -0.5, 0.0}});
  d.coordinates.push_back({.name = "angle"});
  data::JointDescription joint{.name = "hinge", .type = "PinJoint"};
  joint.axes.push_back({.is_rotation = true, .axis = {0, 0, 1}, .coordinate_idx = 0});
  d.joints.push_back(joint);
  Body body{.model = Model::compile(d).value()};
  const VectorXd angle = VectorXd::Constant(1, 0.4), speed = VectorXd::Constant(1, 3.0);
  EXPECT_NEAR(body.mass_at(angle)(0, 0), 0.5, 1e-15);
  EXPECT_NEAR(body.gravity_at(angle)[0], 2.0 * 9.80665 * 0.5 * std::sin(0.4), 1e-13);
  EXPECT_NEAR(body.bias_at(angle, speed)[0], 0.0, 1e-14);
  EXPECT_NEAR(kinetic_energy(body.model, body.w), 0.25 * 9.0, 1e-14);
  EXPECT_NEAR(potential_energy(body.model, body.w), -2.0 * 9.80665 * 0.5 * std::cos(0.4), 1e-13);
}

TEST(InverseDynamics, IsTheSumOfItsParts) {
  for (std::uint64_t seed = 0; seed < 6; ++seed)
    for (const bool free_roots : {true, false}) {
      const Model model = Model::compile(random_tree(seed), {.free_roots = free_roots}).value();
      Workspace w(model);
      Random random(seed, 91);
      const VectorXd x = random_state(model, random), v = random_vector(model.speed_count(), 2.0, random),
                     vdot = random_vector(model.speed_count(), 9.0, random);
      kinematics(model, w, x);
      velocities(model, w, v);
      MatrixXd M;
      VectorXd b, g, tau;
      mass_matrix(model, w, M);
      bias_forces(model, w, b);
      gravity_forces(model, w, g);
      inverse_dynamics(model, w, vdot, tau);
      EXPECT_GT(tau.norm(), 1.0);
      EXPECT_LT(relative_error(tau, M * vdot + b + g), 1e-12) << "seed " << seed;
    }
}

}  // namespace
}  // namespace kinemark::model
