// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// A layout seen from its first joint outwards: the root is that joint's parent segment, whatever way the
/// other joints name parent and child.
struct JointTree {
  explicit JointTree(const data::SegmentLayout& layout);

  std::vector<int> holder;         ///< J: the segment nearer to the root
  std::vector<int> outer;          ///< J: the other one
  std::vector<int> origin;         ///< S: the joint towards the root; the root's is joint 0. -1: out of reach
  std::vector<int> segment_order;  ///< segments from the root outwards: chain index to layout index
  std::vector<int> joint_order;    ///< joints likewise; joint_order[0] = 0
};

/// There is a joint, and every segment can be reached from it.
[[nodiscard]] Status check_tree(const data::SegmentLayout& layout);

/// Pairs of joints (a < b) that meet on one segment.
[[nodiscard]] std::vector<std::pair<int, int>> joint_pairs(const data::SegmentLayout& layout);

/// A recording in the order that a chain wants.
struct ChainInput {
  ChainLayout layout;
  ChainSamples samples;
  std::vector<int> marker;  ///< K: index in the recording
};

[[nodiscard]] ChainInput arrange(const data::Trajectories& markers, const data::SegmentLayout& layout,
                                 const JointTree& tree);

}  // namespace kinemark::skeleton::articulated
