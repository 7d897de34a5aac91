// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/functional/segment_poses.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/se3.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/skeleton/functional/internal/rigid_shape.h"

namespace kinemark::skeleton {
namespace {

/// A segment without poses: markers along z at the positions given by their distances.
void lay_on_line(const Samples& samples, SegmentPoses& out) {
  out.kind = data::SegmentKind::line;
  const auto K = out.markers.size();
  if (K == 2) {
    double sum = 0.0, squares = 0.0;
    std::int64_t n = 0;
    for (std::int64_t f = 0; f < samples.trajectories.frames(); ++f) {
      if (!samples.seen(f, out.markers[0]) || !samples.seen(f, out.markers[1])) continue;
      const double d = (samples.x(f, out.markers[1]) - samples.x(f, out.markers[0])).norm();
      sum += d;
      squares += d * d;
      ++n;
    }
    out.x_in_segment.setConstant(kNaN);
    if (n == 0) return;
    const double length = sum / static_cast<double>(n);
    out.x_in_segment.setZero();
    out.x_in_segment(2, 0) = 0.5 * length;
    out.x_in_segment(2, 1) = -0.5 * length;
    const double variance = std::max(0.0, squares / static_cast<double>(n) - length * length);
    if (n > 1) out.noise_sd_m = std::sqrt(0.5 * variance);
    return;
  }
  if (K == 1) {
    out.x_in_segment.setZero();
    return;
  }
  out.x_in_segment.topRows(2).setZero();
}

SegmentPoses without_poses(const Samples& samples, const std::string& name, const std::vector<int>& markers) {
  const auto n = static_cast<std::size_t>(samples.trajectories.frames());
  SegmentPoses out;
  out.name = name;
  out.markers = markers;
  out.noise_sd_m = kNaN;
  out.x_in_segment = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(markers.size()));
  out.known.assign(n, 0);
  out.world_from_segment.assign(n, Eigen::Matrix3d::Identity());
  out.origin.assign(n, Eigen::Vector3d::Zero());
  return out;
}

/// Poses of all frames, noise, and the frames that do not fit.
void pose_all_frames(const internal::RigidShape& shape, const SegmentPoseOptions& options,
                     SegmentPoses& out) {
  const std::int64_t frames = static_cast<std::int64_t>(out.known.size());
  std::vector<double> rms(out.known.size(), kNaN), usual;
  double squares = 0.0, freedom = 0.0;
  const double share = 1e-4 * shape.least_inertia();
  if (share == 0.0) return;
  std::vector<double> least(out.known.size(), 0.0);
  for (std::int64_t f = 0; f < frames; ++f) {
    const internal::FramePose p = shape.pose(f);
    const auto i = static_cast<std::size_t>(f);
    if (p.visible < 3 || !(p.least_inertia > share)) continue;
    out.known[i] = 1;
    out.world_from_segment[i] = p.rotation;
    out.origin[i] = p.origin;
    least[i] = p.least_inertia;
    rms[i] = std::sqrt(p.squares / (3 * p.visible - 6));
    usual.push_back(rms[i]);
  }
  if (usual.empty()) return;
  out.usual_rms_m = math::upper_median(usual);
  double odd_squares = 0.0;
  for (std::int64_t f = 0; f < frames; ++f) {
    const auto i = static_cast<std::size_t>(f);
    if (!out.known[i]) continue;
    if (out.usual_rms_m > 0.0 && rms[i] > options.odd_factor * out.usual_rms_m && rms[i] > 1e-6) {
      out.known[i] = 0;
      if (out.odd_frames++ == 0) out.first_odd_frame = f;
      odd_squares += rms[i] * rms[i];
      continue;
    }
    const double dof = 3 * shape.pose(f).visible - 6;
    squares += rms[i] * rms[i] * dof;
    freedom += dof;
  }
  if (out.odd_frames > 0) out.odd_rms_m = std::sqrt(odd_squares / static_cast<double>(out.odd_frames));
  freedom -= static_cast<double>(3 * out.markers.size()) - 6.0;
  out.noise_sd_m = freedom > 0.0 ? std::sqrt(squares / freedom) : kNaN;
  if (options.noise_sd_m > 0.0) out.noise_sd_m = options.noise_sd_m;
  const double sd = out.noise_sd_m;
  for (std::size_t i = 0; i < out.known.size(); ++i) {
    if (!out.known[i]) continue;
    if (!std::isnan(sd) && sd > options.max_rotation_sd_rad * std::sqrt(least[i])) out.known[i] = 0;
    out.known_frames += out.known[i];
  }
}

}  // namespace

Eigen::Matrix3d PoseNoise::at(const Eigen::Matrix3d& world_from_segment, const Eigen::Vector3d& x) const {
  const Eigen::Matrix3d arm = world_from_segment * math::skew(x - visible_mean);
  return mean_variance * Eigen::Matrix3d::Identity() + arm * rotation_covariance * arm.transpose();
}

PoseNoise pose_noise(const Samples& samples, const SegmentPoses& poses, std::int64_t frame) {
  PoseNoise noise;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int n = 0;
  const auto visible = [&](std::size_t k) {
    return samples.seen(frame, poses.markers[k]) &&
           !std::isnan(poses.x_in_segment(0, static_cast<Eigen::Index>(k)));
  };
  for (std::size_t k = 0; k < poses.markers.size(); ++k) {
    if (!visible(k)) continue;
    noise.visible_mean += poses.x_in_segment.col(static_cast<Eigen::Index>(k));
    ++n;
  }
  if (n == 0) return noise;
  noise.visible_mean /= n;
  for (std::size_t k = 0; k < poses.markers.size(); ++k) {
    if (!visible(k)) continue;
    const Eigen::Vector3d d = poses.x_in_segment.col(static_cast<Eigen::Index>(k)) - noise.visible_mean;
    squares += d * d.transpose();
  }
  const double variance = std::isnan(poses.noise_sd_m) ? 0.0 : poses.noise_sd_m * poses.noise_sd_m;
  noise.mean_variance = variance / n;
  noise.rotation_covariance = variance * internal::inertia(squares).inverse();
  return noise;
}

SegmentPoses find_segment_poses(const Samples& samples, const std::string& name,
                                const std::vector<int>& markers, const SegmentPoseOptions& options) {
  SegmentPoses out = without_poses(samples, name, markers);
  internal::RigidShape shape(samples, markers);
  if (markers.size() < 3 || !shape.find()) {
    lay_on_line(samples, out);
    return out;
  }
  out.x_in_segment = shape.positions();
  out.kind = data::SegmentKind::solid;
  pose_all_frames(shape, options, out);
  if (out.known_frames == 0) lay_on_line(samples, out);
  return out;
}

SegmentPoses pose_known_shape(const Samples& samples, const std::string& name,
                              const std::vector<int>& markers, const Eigen::Matrix3Xd& x_in_segment,
                              const SegmentPoseOptions& options) {
  check(x_in_segment.cols() == static_cast<Eigen::Index>(markers.size()), "one place a marker");
  SegmentPoses out = without_poses(samples, name, markers);
  internal::RigidShape shape(samples, markers);
  shape.set_positions(x_in_segment);
  out.x_in_segment = x_in_segment;
  out.kind = data::SegmentKind::solid;
  pose_all_frames(shape, options, out);
  return out;
}

}  // namespace kinemark::skeleton
