// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint centres without a body model: which markers ride on which segment is all that must be known.
// The recording is a simulated upper arm and forearm, so the true centre is there to compare with.
#include <cmath>
#include <cstdio>

#include "kinemark/stages/simulation/limb.h"
#include "kinemark/workflow/joints/joints.h"

using namespace kinemark;

int main() {
  // Ten seconds of an arm in a sleeve of 16 LEDs; what is turned away from the cameras is not seen.
  const auto arm = simulation::simulate_sleeve({.duration_s = 10.0}).value();

  // In your own recording the layout says it: names of segments with the indices of their markers, and which
  // two segments meet in a joint. Here the simulation has filled it.
  const data::SegmentLayout& layout = arm.layout;
  for (const auto& segment : layout.segments)
    std::printf("segment %-10s %zu markers\n", segment.name.c_str(), segment.markers.size());

  // What screening is sure of is left out; then maximum likelihood over the whole recording: where the
  // markers sit on their segments, every frame's pose, and the point that neighbouring segments share.
  workflow::JointsOptions options;
  options.segments = layout;  // without them they are looked for
  const auto found = workflow::joints({.trial = {.markers = arm.markers}}, options);
  if (!found) return std::fprintf(stderr, "%s\n", found.error().message.c_str()), 1;
  const data::Skeleton& skeleton = found->skeleton;
  for (const auto& warning : found->remarks.warnings) std::printf("note: %s\n", warning.c_str());
  for (const auto& warning : skeleton.warnings) std::printf("note: %s\n", warning.c_str());

  // One centre a frame and joint, in metres, with its covariance; NaN where it is not determined.
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    double squares = 0.0, expected = 0.0;
    std::int64_t known = 0;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
      const auto i = skeleton.index(f, static_cast<std::int64_t>(j));
      if (skeleton.state[i] == data::CentreState::undetermined) continue;
      const Eigen::Map<const Eigen::Vector3d> truth(arm.centre_in_world.data() + 3 * i);
      squares += (skeleton.centre(f, static_cast<std::int64_t>(j)) - truth).squaredNorm();
      expected += skeleton.centre_covariance(f, static_cast<std::int64_t>(j)).trace();
      ++known;
    }
    const auto frames = static_cast<double>(known);
    std::printf("joint %s: known in %lld of %lld frames, error %.2f mm RMS, %.2f mm by its own covariance\n",
                skeleton.joints[j].name.c_str(), static_cast<long long>(known),
                static_cast<long long>(skeleton.frames()), 1e3 * std::sqrt(squares / frames),
                1e3 * std::sqrt(expected / frames));
    std::printf("  %s\n", skeleton.joints[j].description.c_str());
  }
  return 0;
}
