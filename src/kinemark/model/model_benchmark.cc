// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Time of one call on models/human.osim; each prints its error beside its speed.
#include <benchmark/benchmark.h>

#include <stdexcept>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/model/testing/random_tree.h"
#include "kinemark/model/weighted_normal.h"
#include "support/test_data.h"

namespace kinemark::model {
namespace {

using Eigen::MatrixXd;

// The human in 64 random poses, so that branches and caches see what a recording shows them.
struct Scene {
  Model model;
  Workspace w{model};
  std::vector<VectorXd> x, v;
  VectorXd weight = VectorXd::Ones(model.marker_count());
  Eigen::Matrix3Xd residual = Eigen::Matrix3Xd::Constant(3, model.marker_count(), 0.01);
  std::size_t next = 0;

  Scene() : model(compile()) {
    Random random(7, 0);
    for (int i = 0; i < 64; ++i) {
      x.push_back(testing::random_state(model, random));
      v.push_back(testing::random_vector(model.speed_count(), 2.0, random));
    }
    step();
  }
  static Model compile() {
    auto description = io::read_osim(testing_support::project_folder() / "models" / "human.osim");
    if (!description) throw std::runtime_error(description.error().message);
    return Model::compile(std::move(*description)).value();
  }
  void step() {
    next = (next + 1) % x.size();
    kinematics(model, w, x[next]);
    velocities(model, w, v[next]);
  }
};

void BM_Kinematics(benchmark::State& state) {
  Scene s;
  for (auto _ : state) {
    s.next = (s.next + 1) % s.x.size();
    kinematics(s.model, s.w, s.x[s.next]);
    benchmark::ClobberMemory();
  }
  double off = 0.0;
  for (const auto& R : s.w.rotation) off = std::max(off, (R.transpose() * R - Matrix3d::Identity()).norm());
  state.counters["rotation_error"] = off;
}
BENCHMARK(BM_Kinematics);

void BM_KinematicsMassMatrix(benchmark::State& state) {
  Scene s;
  MatrixXd M;
  for (auto _ : state) {
    s.next = (s.next + 1) % s.x.size();
    kinematics(s.model, s.w, s.x[s.next]);
    mass_matrix(s.model, s.w, M);
    benchmark::ClobberMemory();
  }
  s.step();
  mass_matrix(s.model, s.w, M);
  const double energy = kinetic_energy(s.model, s.w);
  state.counters["energy_error"] = std::abs(0.5 * s.w.v.dot(M * s.w.v) / energy - 1.0);
}
BENCHMARK(BM_KinematicsMassMatrix);

void BM_KinematicsBiasAndGravity(benchmark::State& state) {
  Scene s;
  VectorXd b, g;
  for (auto _ : state) {
    s.step();
    bias_forces(s.model, s.w, b);
    gravity_forces(s.model, s.w, g);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_KinematicsBiasAndGravity);

void BM_MarkerJacobian(benchmark::State& state) {
  Scene s;
  MatrixXd J;
  for (auto _ : state) {
    marker_jacobian(s.model, s.w, J);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_MarkerJacobian);

void BM_NormalMatrix(benchmark::State& state) {
  Scene s;
  MatrixXd H, J;
  for (auto _ : state) {
    marker_normal_matrix(s.model, s.w, s.weight, H);
    benchmark::ClobberMemory();
  }
  marker_jacobian(s.model, s.w, J);
  state.counters["error"] = testing::relative_error(H, J.transpose() * J);
}
BENCHMARK(BM_NormalMatrix);

void BM_NormalMatrixFromJacobian(benchmark::State& state) {
  Scene s;
  MatrixXd H(s.model.speed_count(), s.model.speed_count()), J;
  for (auto _ : state) {
    marker_jacobian(s.model, s.w, J);
    H.noalias() = J.transpose() * J;
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_NormalMatrixFromJacobian);

void BM_GradientAndCurvature(benchmark::State& state) {
  Scene s;
  MatrixXd H = MatrixXd::Zero(s.model.speed_count(), s.model.speed_count());
  VectorXd g;
  for (auto _ : state) {
    clear_forces(s.w);
    add_marker_forces(s.model, s.w, s.weight, s.residual);
    project_forces(s.model, s.w, g);
    subtract_force_curvature(s.model, s.w, H);
    benchmark::ClobberMemory();
  }
  MatrixXd J;
  marker_jacobian(s.model, s.w, J);
  state.counters["gradient_error"] = testing::relative_error(g, J.transpose() * s.residual.reshaped());
}
BENCHMARK(BM_GradientAndCurvature);

}  // namespace
}  // namespace kinemark::model
