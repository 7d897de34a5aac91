// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "kinemark/stages/skeleton/functional/internal/posture.h"

namespace kinemark::skeleton::internal {

/// Sizes that a marker's own slide may have, m per rad: none, and 19 from 0.15 to 80 mm.
inline constexpr int kSlideSizes = 20;
[[nodiscard]] const std::array<double, kSlideSizes>& slide_sizes();

/// Slides of single markers on their segment in proportion to the posture, as their shape shows them: the SD
/// of a coefficient of the linear terms, alike for all markers and axes.
struct OwnSlide {
  std::array<double, kSlideSizes> weight{};  ///< probability of each of slide_sizes(); none has 1/2 before
  double size_m = 0.0;                       ///< RMS over these, m per rad
  double limit_m = 0.0;                      ///< 95 % of the probability lies at or below it, m per rad
  double noise_variance = 0.0;               ///< of a marker, per axis, without the slides, m^2
  /// SD of the coefficients of quadratic (per rad) and of lag terms over that of linear ones, in bounds.
  double quadratic = 0.0, lag = 0.0;
};

/// @param deformation  F x 3M, see deformation()
/// @param freedom      3M - 6
[[nodiscard]] OwnSlide find_own_slide(const Eigen::MatrixXd& deformation, const Posture& posture,
                                      double freedom);

}  // namespace kinemark::skeleton::internal
