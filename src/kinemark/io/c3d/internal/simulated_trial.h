// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/data/trial.h"

namespace kinemark::io::internal {

/// What a simulated recording holds, for tests, the benchmark and the acceptance program.
struct SimulatedTrial {
  std::int64_t markers = 7;
  std::int64_t frames = 50;
  std::int64_t channels = 0;
  std::int64_t samples_per_frame = 4;
  bool gaps = true;       ///< some samples missing, interpolated, model-filled and upsampled
  bool residuals = true;  ///< residuals and cameras of measured samples
  std::uint64_t seed = 1;
};

/// Markers that swing about points in a volume of 4 m, analog channels in their own units. The truth for
/// round trips: every number is known here.
inline data::Trial simulate_trial(const SimulatedTrial& options) {
  using data::SampleState;
  Random random(options.seed, 0);
  data::Trial trial;
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < options.markers; ++m) names.push_back(fmt::format("M{:03}", m + 1));
  trial.markers =
      data::Trajectories::all_missing(std::move(names), {.rate_hz = 240.0, .frames = options.frames});
  if (options.residuals) {
    trial.residual_m.assign(trial.markers.state.size(), std::numeric_limits<float>::quiet_NaN());
    trial.camera_mask.assign(trial.markers.state.size(), 0);
  }
  for (std::int64_t f = 0; f < options.frames; ++f) {
    for (std::int64_t m = 0; m < options.markers; ++m) {
      const double draw = random.uniform();
      const auto k = static_cast<double>(m);
      const double angle = 2.0 * std::numbers::pi * (0.5 + 0.01 * k) * trial.markers.time.time_s(f) + k;
      const std::size_t i = trial.markers.index(f, m);
      if (options.gaps && draw < 0.1) continue;
      trial.markers.x(f, m) =
          Eigen::Vector3d(2.0 * std::sin(k) + 0.3 * std::sin(angle),
                          2.0 * std::cos(k) + 0.2 * std::cos(angle), 0.9 + 0.1 * std::sin(3.0 * angle));
      trial.markers.state[i] = !options.gaps || draw >= 0.25 ? SampleState::measured
                               : draw < 0.15                 ? SampleState::interpolated
                               : draw < 0.2                  ? SampleState::model_filled
                                                             : SampleState::upsampled;
      if (options.residuals && trial.markers.state[i] == SampleState::measured) {
        trial.residual_m[i] = static_cast<float>(random.uniform(2e-4, 3e-3));
        trial.camera_mask[i] = static_cast<std::uint8_t>(random.uniform(1.0, 128.0));
      }
    }
  }
  for (std::int64_t c = 0; c < options.channels; ++c) {
    trial.analog.names.push_back(fmt::format("F{}", c + 1));
    trial.analog.units.push_back(c % 2 == 0 ? "N" : "V");
  }
  if (options.channels > 0) {
    trial.analog.samples = options.frames * options.samples_per_frame;
    trial.analog.rate_hz = trial.markers.time.rate_hz * static_cast<double>(options.samples_per_frame);
    trial.analog.values.resize(static_cast<std::size_t>(trial.analog.samples * options.channels));
    for (double& v : trial.analog.values) v = random.uniform(-800.0, 800.0);
  }
  return trial;
}

}  // namespace kinemark::io::internal
