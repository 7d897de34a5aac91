// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// From counts of detectors to positions: a rig of two cameras is simulated with a wheel that turns before it,
// and each LED of the wheel is found with its covariance. (Calibration:
// kinemark::calibration::calibrate_bundle().)
#include <cmath>
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/stages/simulation/rig_recording.h"

int main() {
  namespace sim = kinemark::simulation;
  const auto rig = sim::draw_rig({.seed = 7}).value();
  const auto recording = sim::record(rig, sim::rotating_wheel(), {.frames = 200}).value();

  const auto found = kinemark::reconstruct(recording.counts, sim::rig_in_room(rig));
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& led : found->leds)
    std::printf("%s: located in %lld of %lld frames\n", led.name.c_str(), static_cast<long long>(led.located),
                static_cast<long long>(led.frames));
  double squares = 0.0, expected = 0.0;
  std::int64_t known = 0;
  for (std::int64_t f = 0; f < found->points.frames(); ++f) {
    if (!found->points.present(f, 0)) continue;
    squares += (found->points.x(f, 0) - recording.when_lit.x(f, 0)).squaredNorm();
    const double* c = found->points.covariance.data() + 6 * found->points.index(f, 0);
    expected += c[0] + c[3] + c[5];
    ++known;
  }
  std::printf("error %.3f mm RMS, %.3f mm by its own covariance\n",
              1e3 * std::sqrt(squares / static_cast<double>(known)),
              1e3 * std::sqrt(expected / static_cast<double>(known)));
  return 0;
}
