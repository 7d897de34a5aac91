// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/response.h"

#include <benchmark/benchmark.h>

#include <cmath>

#include "kinemark/camera/testing/cameras.h"

namespace kinemark::camera {
namespace {

data::Camera camera_of(benchmark::State& state) {
  return with_warp_degree(
      imperfect_camera(data::CameraKind::lateral_effect, data::DetectorKind::tetra_lateral, 1),
      static_cast<int>(state.range(0)));
}

/// Speed beside truth: the largest error of the sum of undistorted shares, which is 1.
double error_of_sum(data::Camera camera) {
  camera.detector.gain.setOnes();
  camera.detector.crosstalk.setZero();
  return std::abs(respond(camera, {0.1, 0.2, 0.1}).phi.sum() - 1.0);
}

void BM_Respond(benchmark::State& state) {
  const auto camera = camera_of(state);
  Eigen::Vector3d x(0.1, 0.2, 0.1);
  for (auto _ : state) {
    x.x() += 1e-9;
    benchmark::DoNotOptimize(respond(camera, x));
  }
  state.counters["error"] = error_of_sum(camera);
}
BENCHMARK(BM_Respond)->Arg(0)->Arg(5)->Arg(10);

void BM_RespondWithParameters(benchmark::State& state) {
  const auto camera = camera_of(state);
  Eigen::Matrix<double, 4, Eigen::Dynamic> jacobian(4, data::ParameterLayout(camera).count);
  Eigen::Vector3d x(0.1, 0.2, 0.1);
  for (auto _ : state) {
    x.x() += 1e-9;
    benchmark::DoNotOptimize(respond(camera, x, jacobian));
    benchmark::DoNotOptimize(jacobian.data());
  }
  state.counters["error"] = error_of_sum(camera);
}
BENCHMARK(BM_RespondWithParameters)->Arg(5)->Arg(10);

}  // namespace
}  // namespace kinemark::camera
