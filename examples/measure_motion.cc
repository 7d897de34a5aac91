// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures of a motion, as `kinemark dynamics` prints them: the range of a knee, how hip and knee move
// together, and the mass centre of a person who is simulated, each with its interval.
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

int main() {
  const auto model = kinemark::Model::compile(kinemark::pipeline::human_model().value()).value();
  const auto subject = kinemark::simulation::simulate_subject(
                           model, {.motion = kinemark::simulation::MotionKind::walk, .duration_s = 2.0})
                           .value();
  const auto solved = kinemark::ik(model, {.trial = {.markers = subject.markers}});
  if (!solved) return std::fprintf(stderr, "%s\n", solved.error().message.c_str()), 1;

  const auto found = kinemark::measure_motion(model, {.motion = solved->result.motion},
                                              {.measures = {"joint_range", "phase_locking", "com_speed"},
                                               .select = {"knee_angle_?"},
                                               .couple = {"hip_flexion_r,knee_angle_r"},
                                               .refits = 39});
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& note : found->left_out) std::printf("note: %s\n", note.c_str());

  // In SI units and radians; a measure says which quantity it is.
  for (const auto& measure : found->measures)
    std::printf("%-16s %-32s %8.4f +- %.4f\n", measure.id.c_str(), measure.subject.c_str(), measure.value,
                measure.sd);
  return found->measures.size() == 4 ? 0 : 1;
}
