// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/carry.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/functional/internal/assemble.h"

namespace kinemark::skeleton {
namespace {

/// A segment of the skeleton with its markers' indices in the recording; those that are not there are left
/// out.
data::SkeletonSegment find_segment(const data::Skeleton& skeleton, const data::SkeletonSegment& segment,
                                   const data::Trajectories& recording) {
  data::SkeletonSegment out = segment;
  out.markers.clear();
  Eigen::Index n = 0;
  for (std::size_t k = 0; k < segment.markers.size(); ++k) {
    const auto m = recording.find(skeleton.markers[static_cast<std::size_t>(segment.markers[k])]);
    const auto x = segment.x_in_segment.col(static_cast<Eigen::Index>(k));
    if (m < 0 || !x.allFinite()) continue;
    out.markers.push_back(static_cast<int>(m));
    out.x_in_segment.col(n++) = x;
  }
  out.x_in_segment.conservativeResize(3, n);
  return out;
}

}  // namespace

Result<data::Skeleton> carry_joints(const data::Skeleton& skeleton, const data::Trajectories& recording) {
  if (auto s = skeleton.validate(); !s) return std::unexpected(s.error());
  if (auto s = recording.validate(); !s) return std::unexpected(s.error());
  data::Skeleton out = skeleton;
  out.markers = recording.names;
  out.time = recording.time;
  out.warnings.clear();
  const Samples samples{recording, {}};
  std::vector<SegmentPoses> poses;
  for (auto& segment : out.segments) {
    segment = find_segment(skeleton, segment, recording);
    poses.push_back(pose_known_shape(samples, segment.name, segment.markers, segment.x_in_segment));
  }
  out.allocate_centres();
  for (std::size_t j = 0; j < out.joints.size(); ++j) {
    const auto& joint = out.joints[j];
    const SegmentPoses& parent = poses[static_cast<std::size_t>(joint.parent_segment)];
    const SegmentPoses& child = poses[static_cast<std::size_t>(joint.child_segment)];
    JointFit fit;
    fit.kind = joint.kind;
    fit.in_parent = joint.covariance_in_parent.allFinite() && parent.known_frames > 0;
    fit.in_child = joint.covariance_in_child.allFinite() && child.known_frames > 0;
    if (!fit.in_parent && !fit.in_child)
      return fail(
          Code::bad_input,
          fmt::format("joint '{}': neither '{}' nor '{}' shows three of its markers in this recording",
                      joint.name, parent.name, child.name));
    fit.centre << joint.centre_in_parent, joint.centre_in_child;
    fit.covariance.setZero();
    if (fit.in_parent) fit.covariance.topLeftCorner<3, 3>() = joint.covariance_in_parent;
    if (fit.in_child) fit.covariance.bottomRightCorner<3, 3>() = joint.covariance_in_child;
    const data::SegmentLayout::Joint layout{joint.name, joint.parent_segment, joint.child_segment};
    const internal::JointTask task{layout, parent, child, measure_motion(parent, child)};
    internal::place_joint(samples, task, fit, j, out);
  }
  return out;
}

}  // namespace kinemark::skeleton
