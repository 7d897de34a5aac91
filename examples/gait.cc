// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Walking: foot strikes and foot offs, strides and loads, from markers, force plates and events: example_gait
// walk.c3d
#include <cstdio>
#include <string>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/files/recording.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "example_gait needs a recording of a walk\n"), 2;

  // As the commands open it: with the edits beside it, and with the forces of its plates where it has some.
  auto recording = kinemark::pipeline::open_recording({.path = argv[1], .plates = true}, {});
  if (!recording) return std::fprintf(stderr, "%s\n", recording.error().message.c_str()), 1;

  const auto found = kinemark::gait(*recording);
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& warning : found->remarks.warnings) std::printf("note: %s\n", warning.c_str());
  if (found->gait)
    for (const auto& event : found->gait->events)
      std::printf("%-5s %-11s %.3f s +- %.3f  %s\n",
                  std::string(kinemark::data::to_string(event.side)).c_str(),
                  std::string(kinemark::data::to_string(event.what)).c_str(), event.time_s, event.sd_s,
                  event.method.c_str());
  for (const auto& one : found->measures)
    std::printf("%-5s %-20s %g [%g to %g]\n", one.context.c_str(), one.id.c_str(), one.value,
                one.interval.low, one.interval.high);
  return 0;
}
