// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A chain whose geometry was found: with its uncertainty and the noise of its markers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// Geometry with its uncertainty.
struct FittedChain {
  Chain chain;
  double noise_sd_m = 0.0;  ///< given or found
  std::vector<double>
      marker_weight;  ///< K: (common SD / own SD)^2; 0: left out, its position on the segment is not known
  Eigen::MatrixXd geometry_covariance;  ///< of the geometry parameters, n_g x n_g, m^2; zero along the gauge
  std::vector<std::int64_t> frames;     ///< that informed the geometry
  double residual_dof = 0.0;
  double chi2 = 0.0;              ///< of these frames' residuals, in units of noise_sd_m^2
  double covariance_scale = 1.0;  ///< of a frame's own covariance, where a rotation is weak
  double geometry_covariance_scale =
      1.0;  ///< in it already: where the geometry's bias was estimated, 1 or more
  double robust_dof = 0.0;
  double alternative_max = 1e-3;
  /// Chi-square by which the best mirrored geometry is worse: below about 10 the mirror ambiguity is not
  /// resolved.
  double mirror_margin = std::numeric_limits<double>::infinity();
  bool refined = true;  ///< false: the first geometry was so far from a body that it was left as it was
  std::vector<std::string> warnings;

  /// Joint j in the axes of its parent or child: covariance, m^2, defined up to the gauge (segment axes held
  /// by the markers' mean position and rotation).
  [[nodiscard]] Matrix3d joint_covariance(int j, bool in_parent) const;
  /// Distance between two joints of one segment and its SD, m.
  struct Length {
    int joint_a = 0, joint_b = 0, segment = 0;
    double length_m = 0.0, sd_m = 0.0;
    Vector3d direction = Vector3d::Zero();  ///< unit vector from a to b in the segment's axes
  };
  [[nodiscard]] std::vector<Length> lengths() const;
};

}  // namespace kinemark::skeleton::articulated
