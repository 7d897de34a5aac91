// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/relative_motion.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton::internal {

/// A joint of the layout with the inputs of its methods.
struct JointTask {
  const data::SegmentLayout::Joint& joint;
  const SegmentPoses& parent;
  const SegmentPoses& child;
  RelativeMotion motion;
};

/// Fit one joint by score, sara or a sphere fit. No value, and one sentence in `why`, where that is not
/// possible. Deviations from the requested method are reported in `why` too.
[[nodiscard]] std::optional<JointFit> fit_joint(const Samples& samples, const JointTask& task,
                                                const FunctionalOptions& options, std::string& why);

/// The joint's centre in every frame in which a segment that holds it has a pose, into column `j`.
void place_joint(const Samples& samples, const JointTask& task, const JointFit& fit, std::size_t j,
                 data::Skeleton& skeleton);

/// Columns of the skeleton from the report's method.
void place_joint(const ConstantDistanceFit& fit, std::size_t j, data::Skeleton& skeleton);

/// Fields of a joint from its fit.
void describe(const JointFit& fit, const RelativeMotion& motion, data::SkeletonJoint& out);

/// Distances between joints that share a segment.
void add_lengths(data::Skeleton& skeleton);

}  // namespace kinemark::skeleton::internal
