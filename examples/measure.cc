// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What a movement was, with an interval on every number: example_measure [RECORDING [MARKER]]
// Without a recording, the wrist of a simulated monkey that reaches for food.
#include <cstdio>
#include <string>

#include "kinemark/kinemark.h"
#include "kinemark/stages/simulation/limb.h"

int main(int argc, char** argv) {
  kinemark::Trajectories markers;
  if (argc > 1) {
    auto recording = kinemark::read_markers(argv[1]);
    if (!recording) return std::fprintf(stderr, "%s\n", recording.error().message.c_str()), 1;
    markers = std::move(recording->markers);
  } else {
    markers = kinemark::simulation::simulate_sleeve({.duration_s = 10.0}).value().markers;
  }
  const std::string wanted = argc > 2 ? argv[2] : markers.names.back();

  // Each measure is freed of the bias of noise, and its interval holds noise of whatever colour was found.
  const auto measured =
      kinemark::measure_paths(markers, {.measures = {"path_length", "peak_speed", "straightness"}});
  if (!measured) return std::fprintf(stderr, "%s\n", measured.error().message.c_str()), 1;
  int count = 0;
  for (const auto& measure : measured->measures) {
    if (measure.subject != wanted) continue;
    const auto unit = kinemark::data::shown_unit(measure.quantity);
    std::printf("%s, %s: %.4g [%.4g to %.4g] %s\n", wanted.c_str(), measure.id.c_str(),
                unit.per_si * measure.value, unit.per_si * measure.interval.low,
                unit.per_si * measure.interval.high, std::string(unit.name).c_str());
    ++count;
  }
  if (count == 0) return std::fprintf(stderr, "nothing is measured of '%s'\n", wanted.c_str()), 1;
  return 0;
}
