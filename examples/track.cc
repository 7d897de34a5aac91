// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Direct control of marker trajectories: a body model is pulled after its markers, the hands before the rest,
// and the torques that it takes come with the angles. On a simulated walk of two seconds.
#include <cstdio>
#include <string>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

int main() {
  const auto model = kinemark::Model::compile(kinemark::pipeline::human_model().value()).value();
  const auto subject = kinemark::simulation::simulate_subject(
                           model, {.motion = kinemark::simulation::MotionKind::walk, .duration_s = 2.0})
                           .value();

  // A recording in memory: markers alone. With forces on its frames (recording.plates) torques rest on them.
  const kinemark::Recording recording{.trial = {.markers = subject.markers}};
  const auto found = kinemark::track(model, recording);
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;

  const auto& motion = found->result.motion;
  const auto knee = motion.find("knee_angle_r");
  if (knee < 0) return std::fprintf(stderr, "the model has no knee_angle_r\n"), 1;
  for (std::int64_t f = 0; f < motion.frames(); f += 20) {
    const auto i = motion.index(f, knee);
    std::printf(
        "%.2f s  right knee %6.1f deg, within %.1f deg by equation 17 of Demircan et al.  %7.1f N m\n",
        motion.time.time_s(f), 57.29578 * motion.q[i], 57.29578 * motion.q_bound[i], motion.tau[i]);
  }
  for (const auto& gate : found->remarks.gates)
    std::printf("%s: %s\n", gate.passed ? "good" : "NOT GOOD", gate.sentence.c_str());
  return found->remarks.passed() ? 0 : 1;
}
