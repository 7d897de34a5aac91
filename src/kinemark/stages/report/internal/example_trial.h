// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kinemark/data/joint_motion.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/report/ik_summary.h"

namespace kinemark::report::internal {

/// A synthetic solved trial with everything a report must show: 20 coordinates and 30 markers of a walking
/// person, noise, soft-tissue waves, random dropout, a hidden wrist that leaves two coordinates undetermined,
/// filled gaps, frames that did not converge, and a marker that was left out. For tests and for looking at
/// the page.
struct ExampleTrial {
  IkRun run;
  data::JointMotion motion;
  data::Trajectories markers;
};

/// The same seed and length give the same bits. Needs at least 100 frames.
[[nodiscard]] ExampleTrial example_trial(std::int64_t frames = 600, std::uint64_t seed = 7);

}  // namespace kinemark::report::internal
