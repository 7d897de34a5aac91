// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "kinemark/stages/skeleton/articulated/chain/chain.h"

namespace kinemark::skeleton::articulated {

/// Weights of a multivariate Student's t with `dof` degrees of freedom at a pose, times the markers' own
/// weights: at most 1, (dof + 3) / (dof + |r|^2 / sigma^2). False when nothing changed by more than 1e-3.
inline bool robust_weights(const Chain& chain, const ChainPose& pose, const double* x,
                           std::span<const double> own, double dof, double sigma_m,
                           std::vector<double>& out) {
  bool changed = false;
  out.resize(own.size());
  for (int k = 0; k < chain.markers(); ++k) {
    if (std::isnan(x[3 * k])) continue;
    const double r2 = own[k] * (Eigen::Map<const Vector3d>(x + 3 * k) - chain.predict(pose, k)).squaredNorm();
    const double weight = own[k] * std::min(1.0, (dof + 3.0) / (dof + r2 / (sigma_m * sigma_m)));
    changed = changed || std::abs(weight - out[k]) > 1e-3;
    out[k] = weight;
  }
  return changed;
}

/// How much of the squared residuals these weights keep where noise is Gaussian of the SD that they assume, 0
/// to 1: a cost must be divided by it to show that noise.
/// @param freedom  variance of a residual over that of the noise: what the fit did not take up, 0 to 1
inline double robust_share(double dof, double freedom) {
  constexpr int kSteps = 400;
  constexpr double kFarthest = 8.0;  // SD: beyond it lies 1e-13 of the integral
  constexpr double kStep = kFarthest / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double r2 = std::pow((i + 0.5) * kStep, 2);
    sum += r2 * r2 * std::exp(-0.5 * r2) * std::min(1.0, (dof + 3.0) / (dof + freedom * r2));
  }
  return std::sqrt(2.0 / std::numbers::pi) * kStep * sum / 3.0;
}

}  // namespace kinemark::skeleton::articulated
