// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint torques of a motion with the force of the ground: a person who is simulated stands on a plate that
// carries the weight.
#include <cmath>
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

int main() {
  const auto description = kinemark::pipeline::human_model().value();
  const auto model = kinemark::Model::compile(description).value();
  double mass_kg = 0.0;
  for (const auto& body : description.bodies) mass_kg += body.mass;
  const auto subject =
      kinemark::simulation::simulate_subject(model, {.duration_s = 1.0, .rate_hz = 60.0}).value();
  kinemark::Recording recording{.trial = {.markers = subject.markers}};

  // Forces on the body in N and N m, on the frames of the recording; io::plate_forces() gives them of a
  // file's plates.
  kinemark::data::Wrench plate{.name = "plate 1"};
  const auto& time = recording.trial.markers.time;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    plate.force.insert(plate.force.end(), {0.0, 9.80665 * mass_kg, 0.0});
    plate.moment.insert(plate.moment.end(), {0.0, 0.0, 0.0});
    plate.point.insert(plate.point.end(), {0.0, 0.0, 0.0});
  }
  recording.plates = kinemark::Wrenches{.time = time, .items = {plate}};

  const auto found = kinemark::ik(model, recording, {.torques = true});
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& [what, value] : found->torques.facts) std::printf("%s: %s\n", what.c_str(), value.c_str());
  const auto& motion = found->result.motion;
  const auto ankle = motion.find("ankle_angle_l");
  if (ankle < 0) return std::fprintf(stderr, "the model has no ankle_angle_l\n"), 1;
  const auto middle = motion.index(motion.frames() / 2, ankle);
  std::printf("left ankle in the middle: %.2f +- %.2f N m\n", motion.tau[middle], motion.tau_sd[middle]);
  return 0;
}
