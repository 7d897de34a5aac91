// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Inverse kinematics: markers and a body model in, joint angles with standard deviations out.
//   ik                          a simulated subject of two seconds
//   ik MODEL.osim MARKERS.c3d   your own recording
#include <cmath>
#include <cstdio>
#include <numbers>

#include "kinemark/kinemark.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

using namespace kinemark;

int main(int argc, char** argv) {
  // Everything that can fail gives a Result: a value, or an Error of one sentence.
  const bool own = argc == 3;
  auto description = own ? read_osim(argv[1]) : pipeline::human_model();
  if (!description) return std::fprintf(stderr, "%s\n", description.error().message.c_str()), 1;

  // A description is what the file says; a model is the same body compiled for computing.
  const auto model = Model::compile(*description);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().message.c_str()), 1;

  // Markers: frames x markers x 3, in metres, NaN where a marker was not seen.
  data::Trajectories markers;
  if (own) {
    auto trial = read_markers(argv[2]);
    if (!trial) return std::fprintf(stderr, "%s\n", trial.error().message.c_str()), 1;
    markers = std::move(trial->markers);
  } else {
    const simulation::SubjectOptions walk{.motion = simulation::MotionKind::walk, .duration_s = 2.0};
    auto subject = simulation::simulate_subject(*model, walk);
    if (!subject) return std::fprintf(stderr, "%s\n", subject.error().message.c_str()), 1;
    markers = std::move(subject->markers);
  }

  const auto found = ik(*model, {.trial = {.markers = std::move(markers)}});
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  const auto* result = &found->result;
  for (const auto& gate : found->remarks.gates)
    if (!gate.passed) std::printf("NOT GOOD: %s\n", gate.sentence.c_str());

  // Angles are in radians, positions in metres, one row a frame; here the last frame is shown in degrees.
  const data::JointMotion& motion = result->motion;
  std::printf("%lld frames, markers fit within %.1f mm RMS\n", static_cast<long long>(motion.frames()),
              1e3 * result->fit.rms_error_m);
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    const auto i = motion.index(motion.frames() - 1, c);
    const auto name = motion.coordinates[static_cast<std::size_t>(c)].c_str();
    const bool rotation = motion.is_rotation[static_cast<std::size_t>(c)];
    const double unit = rotation ? 180.0 / std::numbers::pi : 1.0;
    if (motion.determined[i] == 0)
      std::printf("%-24s not determined by the markers seen\n", name);
    else
      std::printf("%-24s %9.3f +- %.3f %s\n", name, unit * motion.q[i], unit * motion.q_sd[i],
                  rotation ? "deg" : "m");
  }
  return 0;
}
