// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One point of light from the currents of lateral-effect cameras, by maximum likelihood.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "kinemark/data/rig.h"

namespace kinemark::reconstruction {

/// One camera's observation of a point.
struct CountObservation {
  int camera = 0;          ///< index in the rig
  Eigen::Vector4d counts;  ///< as converted, offset included
  double variance = 0.0;   ///< of each count, > 0
  /// 0 for a channel that says nothing (camera::kept_channels()), 1 for the others; three are needed
  Eigen::Vector4d keep = Eigen::Vector4d::Ones();
};

/// Counts that the light of a point at `x_in_world` makes in all channels together, by those that are kept.
[[nodiscard]] double strength_of(const data::Camera& camera, const CountObservation& read,
                                 const Eigen::Vector3d& x_in_world);

/// A point and its uncertainty.
struct Located {
  Eigen::Vector3d x_in_world;   ///< m
  Eigen::Matrix3d information;  ///< inverse covariance from the noise of the counts, m^-2
  double chi2 = 0.0;            ///< misfit; 3 (observations - 1) degrees of freedom
  double farthest_spot = 0.0;   ///< of its spots: larger of |x|, |y|, half-sides
};

/// Maximum likelihood with each camera's light strength eliminated. Ratios of counts are not used: away from
/// the middle of the field they are less precise by a factor of 1.7. Gauss-Newton from `start`.
///
/// No value with fewer than two observations, when the point runs behind a camera, or when 30 steps do not
/// settle it. Some 2 us from a start nearby, 8 us from afar.
[[nodiscard]] std::optional<Located> locate(const data::Rig& rig,
                                            std::span<const CountObservation> observations,
                                            const Eigen::Vector3d& start);

/// Point nearest to the axes of all cameras: where to start when nothing is known.
[[nodiscard]] Eigen::Vector3d middle_of_view(const data::Rig& rig);

/// Cramer-Rao bound: covariance that no unbiased estimate from one conversion of each channel can beat, with
/// the rig known and the strength of the light not (m^2). NaN where fewer than two cameras see the point.
/// @param strength  per camera: counts that the light makes, sum of all channels' shares; 0 where it is not
/// seen
[[nodiscard]] Eigen::Matrix3d cramer_rao(const data::Rig& rig, const Eigen::Vector3d& x_in_world,
                                         std::span<const double> strength);

/// Derivative of the estimate of a point by the rig's parameters: 3 x Rig::parameter_count(), m per unit.
/// @param weight  per camera: (strength / standard deviation of a count)^2; 0 where it is not seen
[[nodiscard]] Eigen::Matrix<double, 3, Eigen::Dynamic> by_parameters(const data::Rig& rig,
                                                                     const Eigen::Vector3d& x_in_world,
                                                                     std::span<const double> strength,
                                                                     std::span<const double> weight);

}  // namespace kinemark::reconstruction
