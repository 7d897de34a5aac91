// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// A generic body model is given the sizes of a person, as `kinemark scale --static` does it: from one
// posture, with the uncertainty of each length. A recipe of distances, as OpenSim's, or a motion would go in
// the same way.
#include <cmath>
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

int main() {
  const auto generic = kinemark::pipeline::human_model().value();

  // The person is simulated: a few frames of the generic body in one posture, 5 % taller.
  const auto model = kinemark::Model::compile(generic).value();
  auto subject = kinemark::simulation::simulate_subject(model, {.duration_s = 0.05}).value();
  for (auto& coordinate : subject.markers.x_in_world) coordinate *= 1.05;

  const auto scaled = kinemark::scale(
      generic,
      {.still = {{.recording = {.trial = {.markers = subject.markers}}, .name = "the static trial"}}},
      {{.mass_kg = 80.0}});
  if (!scaled) return std::fprintf(stderr, "%s\n", scaled.error().message.c_str()), 1;

  // Gates say whether the result is good: no marker elsewhere or exchanged, markers near those of the model.
  for (const auto& gate : scaled->remarks.gates)
    std::printf("%s %s\n", gate.passed ? "good:" : "NOT GOOD:", gate.sentence.c_str());
  for (const auto& length : scaled->from_static->lengths)
    std::printf("%-40s %.1f +- %.1f mm%s\n", length.name.c_str(), 1e3 * length.length_m, 1e3 * length.sd_m,
                length.determined ? "" : " (not determined by these data)");
  // Without .force a file that exists is kept, and the error says so.
  const auto written = kinemark::write_osim("scaled.osim", scaled->model, {.force = true});
  if (!written) return std::fprintf(stderr, "%s\n", written.error().message.c_str()), 1;
  double taller = 0.0;
  for (const auto& body : scaled->factors)
    if (body.body == "femur_r") taller = body.factors.y();
  std::printf("the right thigh is %.4f times the model's\n", taller);
  return std::abs(taller - 1.05) < 0.05 ? 0 : 1;
}
