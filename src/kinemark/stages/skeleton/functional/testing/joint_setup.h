// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One joint of a test chain with the poses of its segments, as fit_joint() and place_joint() want it.
#pragma once

#include <utility>

#include "kinemark/stages/skeleton/functional/internal/assemble.h"
#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton::testing {

/// Keeps references to itself: not to be copied or moved.
struct JointSetup {
  TestChain chain;
  Samples samples;
  SegmentPoses parent, child;
  internal::JointTask task;

  explicit JointSetup(const ChainSetup& setup) : JointSetup(make_chain(setup)) {}
  explicit JointSetup(TestChain of)
      : chain(std::move(of)),
        samples{chain.markers, {}},
        parent(find_segment_poses(samples, "s0", chain.layout.segments[0].markers)),
        child(find_segment_poses(samples, "s1", chain.layout.segments[1].markers)),
        task{chain.layout.joints[0], parent, child, measure_motion(parent, child)} {}
  JointSetup(const JointSetup&) = delete;
  JointSetup& operator=(const JointSetup&) = delete;
  JointSetup(JointSetup&&) = delete;
  JointSetup& operator=(JointSetup&&) = delete;
  ~JointSetup() = default;

  /// A skeleton of this joint alone, without centres yet.
  [[nodiscard]] data::Skeleton empty_skeleton() const {
    data::Skeleton out;
    out.time = chain.markers.time;
    out.joints.resize(1);
    out.joints[0].name = "j0";
    out.joints[0].parent_segment = 0;
    out.joints[0].child_segment = 1;
    out.allocate_centres();
    return out;
  }
};

}  // namespace kinemark::skeleton::testing
