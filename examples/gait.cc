// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Foot strikes and foot offs of a walk, from its markers, force plates and events: example_gait walk.c3d
#include <cstdio>
#include <optional>
#include <string>

#include "kinemark/kinemark.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "example_gait needs a recording of a walk\n"), 2;
  const auto recording = kinemark::read_markers(argv[1]);
  if (!recording) return std::fprintf(stderr, "%s\n", recording.error().message.c_str()), 1;

  // Forces on the body, newtons, on the recording's axes. A recording without plates is measured by its
  // markers alone.
  const auto forces = kinemark::plate_forces(*recording);
  kinemark::analysis::GaitEvidence evidence{.events = recording->events};
  if (forces) evidence.plates = &forces->wrenches;

  const auto gait = kinemark::analyze_gait(recording->markers, evidence, {.refits = 99});
  if (!gait) return std::fprintf(stderr, "%s\n", gait.error().message.c_str()), 1;
  for (const auto& note : gait->notes) std::printf("note: %s\n", note.c_str());
  for (const auto& event : gait->events)
    std::printf("%-5s %-11s %.3f s +- %.3f  %s\n", std::string(kinemark::data::to_string(event.side)).c_str(),
                std::string(kinemark::data::to_string(event.what)).c_str(), event.time_s, event.sd_s,
                event.method.c_str());
  return 0;
}
