// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// From counts of detectors to positions. A rig of two cameras is simulated; it is calibrated by a tree of
// three LEDs that is held before it in many poses, and then each LED of a wheel is found with its covariance.
#include <cmath>
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/stages/simulation/rig_calibration.h"
#include "kinemark/stages/simulation/rig_recording.h"

int main() {
  namespace sim = kinemark::simulation;
  const auto rig = sim::draw_rig({.seed = 7}).value();
  const auto held = sim::record_tree_poses(rig).value();
  const auto sides = sim::tree_sides_m();
  const kinemark::workflow::ShownCounts tree{
      .name = "tree",
      .counts = held.counts,
      .shows = kinemark::workflow::ShownTree{.sides_m = {sides.begin(), sides.end()},
                                             .frames_per_pose = held.frames_per_pose}};

  const auto calibrated = kinemark::calibrate({&tree, 1}, rig.nominal, {.bundle = {.crosstalk = false}});
  if (!calibrated) return std::fprintf(stderr, "%s\n", calibrated.error().message.c_str()), 1;
  for (const auto& gate : calibrated->remarks.gates) std::printf("%s\n", gate.sentence.c_str());
  if (!calibrated->rig) return 1;

  const auto recording = sim::record(rig, sim::rotating_wheel(), {.frames = 200}).value();
  const auto found = kinemark::reconstruct(recording.counts, *calibrated->rig,
                                           {.method = kinemark::workflow::ReconstructMethod::frames});
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& led : found->leds)
    std::printf("%s: located in %lld of %lld frames\n", led.name.c_str(), static_cast<long long>(led.located),
                static_cast<long long>(led.frames));
  const auto& markers = found->markers;
  double variance = 0.0;
  std::int64_t known = 0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    if (!markers.present(f, 0)) continue;
    const double* c = markers.covariance.data() + 6 * markers.index(f, 0);
    variance += c[0] + c[3] + c[5];
    ++known;
  }
  std::printf("%s is known to %.2f mm RMS\n", markers.names[0].c_str(),
              1e3 * std::sqrt(variance / static_cast<double>(known)));
  return 0;
}
