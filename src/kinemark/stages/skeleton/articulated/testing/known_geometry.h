// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a fit that found the true geometry would hand on.
#pragma once

#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"
#include "kinemark/stages/skeleton/articulated/testing/random_chain.h"

namespace kinemark::skeleton::testing_limbs {

/// The true geometry, without any uncertainty; every marker has the noise `noise_m`.
[[nodiscard]] inline articulated::FittedChain known_geometry(const RandomChain& limb, double noise_m) {
  articulated::FittedChain fit;
  fit.chain = limb.chain;
  fit.noise_sd_m = noise_m;
  fit.marker_weight.assign(static_cast<std::size_t>(limb.chain.markers()), 1.0);
  const auto n = static_cast<Eigen::Index>(limb.chain.geometry_parameters().size());
  fit.geometry_covariance = Eigen::MatrixXd::Zero(n, n);
  return fit;
}

}  // namespace kinemark::skeleton::testing_limbs
