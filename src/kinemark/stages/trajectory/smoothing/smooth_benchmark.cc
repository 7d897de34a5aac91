// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory {
namespace {

constexpr double kRateHz = 240.0;

data::Trajectories circling(std::int64_t frames, std::int64_t markers) {
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < markers; ++m) names.push_back("M" + std::to_string(m));
  auto t = data::Trajectories::all_missing(names, {kRateHz, 0.0, frames});
  Random random(1, 1);
  for (std::int64_t f = 0; f < frames; ++f) {
    for (std::int64_t m = 0; m < markers; ++m) {
      for (int axis = 0; axis < 3; ++axis)
        t.x(f, m)[axis] =
            0.3 * std::sin(7.0 * static_cast<double>(f) / kRateHz + axis) + 0.0005 * random.gaussian();
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  }
  return t;
}

double velocity_error(const data::Trajectories& t, const SmoothResult& result) {
  double sum = 0.0;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    sum += std::pow(result.derivatives.velocity[3 * t.index(f, 0)] -
                        2.1 * std::cos(7.0 * static_cast<double>(f) / kRateHz),
                    2);
  return std::sqrt(sum / static_cast<double>(t.frames()));
}

/// A minute of one marker; argument: the method.
void BM_SmoothMinute(benchmark::State& state) {
  const auto in = circling(14400, 1);
  SmoothOptions options;
  options.method = static_cast<FilterMethod>(state.range(0));
  double error = 0.0;
  for (auto _ : state) {
    const auto result = smooth(in, options).value();
    error = velocity_error(in, result);
  }
  state.SetLabel(std::string(to_string(options.method)));
  state.SetItemsProcessed(state.iterations() * in.frames());
  state.counters["velocity_rms_mm_s"] = 1e3 * error;
}
BENCHMARK(BM_SmoothMinute)->DenseRange(0, 5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinemark::trajectory
