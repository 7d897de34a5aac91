// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/recording/widening.h"

namespace kinemark::skeleton::articulated {
namespace {

using data::CentreState;

Matrix3d widened(const Matrix3d& C, const Vector3d& axis, double size_m) {
  const double more = size_m * size_m - axis.dot(C * axis);
  return more > 0.0 ? Matrix3d(C + more * axis * axis.transpose()) : C;
}

}  // namespace

void widen_along_axis(const std::vector<SampledPose>& sampled, int chain_segment, const Vector3d& axis,
                      int joint, double size_m, data::Skeleton& skeleton) {
  std::size_t next = 0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    while (next + 1 < sampled.size() && sampled[next + 1].frame <= f) ++next;
    const std::size_t i = skeleton.index(f, joint);
    if (next >= sampled.size() || skeleton.state[i] == CentreState::undetermined) continue;
    const Vector3d in_world = sampled[next].pose.rotation[static_cast<std::size_t>(chain_segment)] * axis;
    store_symmetric(skeleton.covariance.data() + 6 * i,
                    widened(skeleton.centre_covariance(f, joint), in_world, size_m));
  }
  auto& changed = skeleton.joints[static_cast<std::size_t>(joint)];
  changed.covariance_in_parent = widened(changed.covariance_in_parent, changed.axis_in_parent, size_m);
  changed.covariance_in_child = widened(changed.covariance_in_child, changed.axis_in_child, size_m);
  changed.repeatability_in_parent = widened(changed.repeatability_in_parent, changed.axis_in_parent, size_m);
  changed.repeatability_in_child = widened(changed.repeatability_in_child, changed.axis_in_child, size_m);
}

void widen_all_around(int joint, double size_m, data::Skeleton& skeleton) {
  const Matrix3d more = size_m * size_m * Matrix3d::Identity();
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const std::size_t i = skeleton.index(f, joint);
    if (skeleton.state[i] != CentreState::undetermined)
      store_symmetric(skeleton.covariance.data() + 6 * i, skeleton.centre_covariance(f, joint) + more);
  }
  auto& changed = skeleton.joints[static_cast<std::size_t>(joint)];
  changed.covariance_in_parent += more;
  changed.covariance_in_child += more;
  changed.repeatability_in_parent += more;
  changed.repeatability_in_child += more;
}

}  // namespace kinemark::skeleton::articulated
