// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// A generic body model is given the sizes of a person: the right thigh from the distance between markers on
// thigh and knee, the whole from the mass.
#include <cmath>
#include <cstdio>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

int main() {
  const auto generic = kinemark::pipeline::human_model().value();

  // The person is simulated: a standing second of the generic body, 5 % taller.
  const auto model = kinemark::Model::compile(generic).value();
  auto subject = kinemark::simulation::simulate_subject(model, {.duration_s = 1.0}).value();
  for (auto& coordinate : subject.markers.x_in_world) coordinate *= 1.05;

  kinemark::data::ScaleRecipe recipe;
  recipe.measurements = {
      {.name = "right thigh", .pairs = {{"RTHI", "RKNE"}}, .bodies = {{.body = "femur_r"}}}};
  recipe.mass_kg = 80.0;
  const auto scaled = kinemark::scale_model(generic, &subject.markers, recipe);
  if (!scaled) return std::fprintf(stderr, "%s\n", scaled.error().message.c_str()), 1;
  for (const auto& one : scaled->measurements)
    for (const auto& pair : one.pairs)
      std::printf("%s: %.1f +- %.2f mm, %.4f times the model's\n", one.name.c_str(), 1e3 * pair.measured_m,
                  1e3 * pair.measured_sd_m, one.factor);
  // Without .force a file that exists is kept, and the error says so.
  const auto written = kinemark::write_osim("scaled.osim", scaled->model, {.force = true});
  if (!written) return std::fprintf(stderr, "%s\n", written.error().message.c_str()), 1;
  return std::abs(scaled->measurements.at(0).factor - 1.05) < 0.05 ? 0 : 1;
}
