// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint angles by a segment definition, without a body model: Plug-in Gait's, of a walk with its markers:
// segments walk.c3d
#include <cstdio>

#include "kinemark/kinemark.h"

int main(int argc, char** argv) {
  const auto definition = kinemark::find_definition("pig");
  if (!definition) return std::fprintf(stderr, "%s\n", definition.error().message.c_str()), 1;
  if (argc != 2)
    return std::fprintf(stderr, "example_segments needs a recording of Plug-in Gait's markers\n"), 2;
  const auto recording = kinemark::read_markers(argv[1]);
  if (!recording) return std::fprintf(stderr, "%s\n", recording.error().message.c_str()), 1;

  // Measures of the person, SI, each with who says so; what is not given is assumed and carried in the
  // deviations.
  const auto* markers = &recording->markers;
  const kinemark::analysis::SegmentInput input{.markers = markers,
                                               .static_trial = markers,
                                               .given = {{"LLegLength", 0.90, "me"},
                                                         {"RLegLength", 0.90, "me"},
                                                         {"LKneeWidth", 0.10, "me"},
                                                         {"RKneeWidth", 0.10, "me"},
                                                         {"LAnkleWidth", 0.07, "me"},
                                                         {"RAnkleWidth", 0.07, "me"}}};
  const auto motion = kinemark::compute_segments(*definition, input);
  if (!motion) return std::fprintf(stderr, "%s\n", motion.error().message.c_str()), 1;
  for (const auto& angle : motion->angles) {
    const auto middle = angle.size() * static_cast<std::size_t>(motion->time.frames / 2);
    std::printf("%-20s %7.2f +- %.2f deg in the middle frame\n", angle.name.c_str(),
                57.29578 * angle.value[middle], 57.29578 * angle.sd[middle]);
  }
  return 0;
}
