// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "kinemark/math/noise_model.h"
#include "kinemark/stages/analysis/path/low_pass.h"
#include "kinemark/stages/analysis/path/path_noise.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis::testing {

inline constexpr std::int64_t kSamples = 500;  ///< at 100 Hz

inline std::vector<bool> all_seen() { return std::vector<bool>(kSamples, true); }

/// Positions with noise of a model, through its filter where it has one, as a file of single precision holds
/// them.
inline SeriesMatrix with_noise_of(SeriesMatrix x, const math::NoiseModel& model, std::uint64_t seed) {
  x += noise_before_filter(model, x.rows(), 3, seed, 4);
  if (model.order > 0) LowPassFilter(model, x.rows()).apply(x);
  for (auto& value : x.reshaped()) value = 1e-3 * static_cast<double>(static_cast<float>(1e3 * value));
  return x;
}

/// Five turns of ellipse().
inline SeriesMatrix cycles_with(const math::NoiseModel& model, std::uint64_t seed) {
  return with_noise_of(sampled(kSamples, 100.0, ellipse), model, seed);
}

/// Turns of ellipse() that no sample repeats, as those of cycles_with() do.
inline SeriesMatrix drifting_cycles_with(const math::NoiseModel& model, std::uint64_t seed) {
  return with_noise_of(sampled(kSamples, 100.0, [](double t) { return ellipse(0.9717 * t); }), model, seed);
}

inline math::NoiseModel white(double sd) { return {.variance = sd * sd}; }
inline math::NoiseModel slow(double sd, double rho) {
  return {.kind = math::NoiseKind::correlated, .variance = sd * sd, .correlation = rho};
}
inline math::NoiseModel quintic(double sd, double half_hz) {
  return {.kind = math::NoiseKind::filtered,
          .form = math::LowPass::spline,
          .order = 3,
          .variance = sd * sd,
          .half = half_hz / 100.0};
}

/// What is found of the noise of kSamples samples at 100 Hz, of the marker "KNE".
inline PathNoise noise_of(const SeriesMatrix& x, const NoiseKnown& known = {}) {
  auto found = find_path_noise(x, all_seen(), 100.0, known);
  if (!found) throw std::runtime_error("no noise");
  found->subject = "KNE";
  return *found;
}

}  // namespace kinemark::analysis::testing
