// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How a sheet shares the photocurrent of a spot among its four electrodes.
#pragma once

#include <Eigen/Core>
#include <span>

#include "kinemark/data/rig.h"

namespace kinemark::camera {

/// Currents at +x, -x, +y, -y per photocurrent, and their derivatives by the position of the spot
/// (half-sides).
struct Shares {
  Eigen::Vector4d share;               ///< at +x, -x, +y, -y
  Eigen::Matrix<double, 4, 2> d_spot;  ///< per half-side
};

/// Tetra-lateral sheet, |x|, |y| < 1: harmonic measures of the four edges of a square, in closed form by the
/// conformal map of the square to the disc. They sum to 1. Accurate to 1e-14.
[[nodiscard]] Shares tetra_lateral_shares(double x, double y);

/// Duo-lateral sheets: (1 + x)/2, (1 - x)/2, (1 + y)/2, (1 - y)/2. Each pair carries the whole current.
[[nodiscard]] Shares duo_lateral_shares(double x, double y);

/// Pin-cushion sheet with corner electrodes ++, --, -+, +-: (1 + x)(1 + y)/4 and so on; linear in
/// x = (++ + +-) - (-- + -+), likewise y.
[[nodiscard]] Shares pin_cushion_shares(double x, double y);

/// Polynomial shares; see data::Detector::generic.
[[nodiscard]] Shares generic_shares(std::span<const double> coefficients, int degree, double x, double y);

/// Shares of a detector's kind at a position on the ideal sheet: no warp, crosstalk or gain. A position
/// beyond detector.edge is moved to the edge, with derivative 0 across it.
[[nodiscard]] Shares shares(const data::Detector& detector, double x, double y);

}  // namespace kinemark::camera
