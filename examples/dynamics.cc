// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What follows from a motion, as `kinemark dynamics` does it: where a heel is, how fast it moves, and the
// torque of an ankle with the force of the ground. A person who is simulated stands on a plate that carries
// the weight.
#include <cmath>
#include <cstdio>
#include <utility>

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

  // A motion with standard deviations.
  const auto solved = kinemark::ik(model, {.trial = {.markers = subject.markers}});
  if (!solved) return std::fprintf(stderr, "%s\n", solved.error().message.c_str()), 1;

  // Forces on the body in N and N m, on a clock of their own; io::plate_forces() gives them of a file's
  // plates.
  kinemark::data::Wrench plate{.name = "plate 1"};
  const auto& time = subject.markers.time;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    plate.force.insert(plate.force.end(), {0.0, 9.80665 * mass_kg, 0.0});
    plate.moment.insert(plate.moment.end(), {0.0, 0.0, 0.0});
    plate.point.insert(plate.point.end(), {0.0, 0.0, 0.0});
  }

  kinemark::workflow::DynamicsOptions options;
  options.points = {
      {.name = "heel", .body_idx = description.find_body("calcn_l"), .x_in_body = {-0.02, 0.0, 0.0}}};
  const auto found = kinemark::dynamics(
      model, {.motion = solved->result.motion, .forces = {{.time = time, .items = {plate}}}}, options);
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& [what, value] : found->facts) std::printf("%s: %s\n", what.c_str(), value.c_str());
  for (const auto& warning : found->remarks.warnings) std::printf("note: %s\n", warning.c_str());

  const auto middle = found->motion.frames() / 2;
  const auto& bodies = *found->bodies;
  // Behind six numbers of each body stand three of the mass centre, then three of each point.
  for (const auto& [order, what] :
       {std::pair(0, "height of the left heel, m"), std::pair(1, "its speed upwards, m/s")}) {
    const auto i = bodies.index(middle, order, 6 * bodies.bodies + 3 + 1);
    std::printf("%s: %.3f +- %.3f\n", what, bodies.value[i], bodies.sd[i]);
  }
  const auto ankle = found->motion.find("ankle_angle_l");
  if (ankle < 0) return std::fprintf(stderr, "the model has no ankle_angle_l\n"), 1;
  const auto i = found->motion.index(middle, ankle);
  std::printf("torque of the left ankle: %.2f +- %.2f N m\n", found->motion.tau[i], found->motion.tau_sd[i]);
  return std::isfinite(found->motion.tau[i]) ? 0 : 1;
}
