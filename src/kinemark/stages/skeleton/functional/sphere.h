// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/skeleton/functional/joint_fit.h"
#include "kinemark/stages/skeleton/functional/segment_poses.h"

namespace kinemark::skeleton {

/// Centre about which points move on spheres, or axis about which they move on circles.
struct SphereFit {
  bool found = false;  ///< false: too little data or no turn, the rest means nothing
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();      ///< m, in the segment that holds still
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the centre, m^2
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();        ///< unit length; zero for spheres
  double axis_sd_rad = 0.0;                              ///< of each tilt of the axis
  double residual_rms_m = 0.0;           ///< distance of the points from their spheres or cylinders
  Eigen::VectorXd radii_m;               ///< one a point; NaN for one that was never seen
  std::int64_t samples = 0, frames = 0;  ///< points used, and the frames they come from
};

/// Options of fit_spheres().
struct SphereOptions {
  bool correct_bias = true;  ///< Halvorsen's
  bool about_axis = false;   ///< circles about an axis (cylinders) instead of spheres
};

/// The closed form of Gamage & Lasenby (2002, J Biomech 35:87): the centre minimises the variance of the
/// squared distances, A m = b with A = 2 sum_p cov(v_p), b = sum_p mean((v_p - mean) |v_p|^2); the axis is
/// the direction in which the points spread least about their own means. Noise draws the centre towards the
/// points; Halvorsen (2003, J Biomech 36:999) takes 2 sigma^2 sum_p (mean v_p - m) off b, sigma from the
/// residuals, until nothing changes.
///
/// @param still   Segment in whose axes the centre rests; frames in which its pose is unknown are left out.
/// @param moving  Markers that move about it; each may be missing at any time.
/// Covariance as in fit_score(): blocks of frames left out, plus the variance that the motion leaves
/// undetermined.
[[nodiscard]] SphereFit fit_spheres(const Samples& samples, const SegmentPoses& still,
                                    const std::vector<int>& moving, const SphereOptions& options = {});

}  // namespace kinemark::skeleton
