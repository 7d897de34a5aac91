// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Shape of one segment's markers without any pose, and the pose of such a shape in a frame.
#pragma once

#include <span>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// Shape of one segment's markers about their mean, in its principal axes (z longest, x second): from mean
/// squared distances less 6 sigma^2, which noise adds to them; where markers are never seen all together, the
/// best triangle and then one marker at a time through frames that show three known ones. A line has z alone.
/// NaN: a marker that fewer than three frames show together with three others. Error: no three markers seen
/// together.
[[nodiscard]] Result<Eigen::Matrix3Xd> segment_shape(const ChainSamples& samples,
                                                     std::span<const int> markers, data::SegmentKind kind,
                                                     double sigma_m);

/// Pose of a shape in a frame by the seen markers: false with fewer than two (line) or three. `spread`:
/// second moment across the longest axis, m^2 (line: along it), how well the pose is fixed.
bool rigid_pose(const ChainSamples& samples, std::int64_t frame, std::span<const int> markers,
                const Eigen::Matrix3Xd& shape, data::SegmentKind kind, Matrix3d& rotation, Vector3d& origin,
                double& spread);

}  // namespace kinemark::skeleton::articulated
