// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint angles by a segment definition, without a body model: Plug-in Gait's, of a person who stands or
// walks: segments walk.c3d
#include <cstdio>
#include <utility>

#include "kinemark/kinemark.h"

int main(int argc, char** argv) {
  const auto definition = kinemark::find_definition("pig");
  if (!definition) return std::fprintf(stderr, "%s\n", definition.error().message.c_str()), 1;
  if (argc != 2)
    return std::fprintf(stderr, "example_segments needs a recording of Plug-in Gait's markers\n"), 2;
  auto trial = kinemark::read_markers(argv[1]);
  if (!trial) return std::fprintf(stderr, "%s\n", trial.error().message.c_str()), 1;
  const kinemark::Recording recording{.trial = std::move(*trial)};

  // Measures of the person, SI, each with who says so; what is not given is looked for in the recording, else
  // assumed and carried in the deviations. Without another one the recording is its own static trial.
  kinemark::workflow::SegmentsOptions options;
  options.static_trial = &recording;
  options.given = {{"LLegLength", 0.90, "me"}, {"RLegLength", 0.90, "me"},  {"LKneeWidth", 0.10, "me"},
                   {"RKneeWidth", 0.10, "me"}, {"LAnkleWidth", 0.07, "me"}, {"RAnkleWidth", 0.07, "me"}};
  const auto found = kinemark::segments(*definition, recording, options);
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  for (const auto& warning : found->remarks.warnings) std::printf("note: %s\n", warning.c_str());
  const auto& motion = found->motion;
  for (const auto& angle : motion.angles) {
    const auto middle = angle.size() * static_cast<std::size_t>(motion.time.frames / 2);
    std::printf("%-20s %7.2f +- %.2f deg in the middle frame\n", angle.name.c_str(),
                57.29578 * angle.value[middle], 57.29578 * angle.sd[middle]);
  }
  return 0;
}
