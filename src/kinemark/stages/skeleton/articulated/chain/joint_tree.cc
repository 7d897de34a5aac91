// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/chain/joint_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace kinemark::skeleton::articulated {

JointTree::JointTree(const data::SegmentLayout& layout)
    : holder(layout.joints.size(), -1), outer(layout.joints.size(), -1), origin(layout.segments.size(), -1) {
  if (layout.joints.empty()) return;
  const int root = layout.joints.front().parent;
  origin[static_cast<std::size_t>(root)] = 0;
  segment_order.push_back(root);
  for (std::size_t next = 0; next < segment_order.size(); ++next) {
    const int segment = segment_order[next];
    for (std::size_t j = 0; j < layout.joints.size(); ++j) {
      const auto& joint = layout.joints[j];
      if (holder[j] >= 0 || (joint.parent != segment && joint.child != segment)) continue;
      holder[j] = segment;
      outer[j] = joint.parent == segment ? joint.child : joint.parent;
      origin[static_cast<std::size_t>(outer[j])] = static_cast<int>(j);
      segment_order.push_back(outer[j]);
      joint_order.push_back(static_cast<int>(j));
    }
  }
}

Status check_tree(const data::SegmentLayout& layout) {
  if (layout.segments.size() < 2)
    return fail(Code::bad_input, layout.segments.empty()
                                     ? "no segment has markers; a joint needs two segments"
                                     : fmt::format("all markers are on segment '{}'; a joint needs two "
                                                   "segments",
                                                   layout.segments.front().name));
  if (layout.joints.empty())
    return fail(Code::bad_input,
                fmt::format("no joint between {} segments; name at least one", layout.segments.size()));
  const JointTree tree(layout);
  for (std::size_t s = 0; s < layout.segments.size(); ++s)
    if (tree.origin[s] < 0)
      return fail(Code::bad_input,
                  fmt::format("no joints lead from segment '{}' to segment '{}'; fit them "
                              "apart from each other",
                              layout.segments[static_cast<std::size_t>(tree.segment_order[0])].name,
                              layout.segments[s].name));
  return {};
}

std::vector<std::pair<int, int>> joint_pairs(const data::SegmentLayout& layout) {
  std::vector<std::pair<int, int>> pairs;
  const auto meet = [](const data::SegmentLayout::Joint& a, const data::SegmentLayout::Joint& b) {
    return a.parent == b.parent || a.parent == b.child || a.child == b.parent || a.child == b.child;
  };
  for (std::size_t a = 0; a < layout.joints.size(); ++a)
    for (std::size_t b = a + 1; b < layout.joints.size(); ++b)
      if (meet(layout.joints[a], layout.joints[b]))
        pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
  return pairs;
}

ChainInput arrange(const data::Trajectories& markers, const data::SegmentLayout& layout,
                   const JointTree& tree) {
  ChainInput input;
  std::vector<int> chain_index(layout.segments.size());
  for (std::size_t s = 0; s < tree.segment_order.size(); ++s) {
    const auto segment = static_cast<std::size_t>(tree.segment_order[s]);
    chain_index[segment] = static_cast<int>(s);
    for (const int m : layout.segments[segment].markers) {
      input.marker.push_back(m);
      input.layout.segment_of_marker.push_back(static_cast<int>(s));
    }
  }
  for (const int j : tree.joint_order)
    input.layout.parent.push_back(
        chain_index[static_cast<std::size_t>(tree.holder[static_cast<std::size_t>(j)])]);
  const std::size_t K = input.marker.size();
  input.samples.frames = markers.frames();
  input.samples.markers = static_cast<int>(K);
  input.samples.x.resize(3 * K * static_cast<std::size_t>(markers.frames()));
  double* x = input.samples.x.data();
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (const int m : input.marker) {
      // Only what a camera saw informs: made samples repeat their neighbours with an unknown error.
      const bool measured = markers.state[markers.index(f, m)] == data::SampleState::measured;
      for (int axis = 0; axis < 3; ++axis)
        *x++ = measured ? markers.x(f, m)[axis] : std::numeric_limits<double>::quiet_NaN();
    }
  return input;
}

}  // namespace kinemark::skeleton::articulated
