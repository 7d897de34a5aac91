// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One angle against another over the cycle (cyclograms).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "kinemark/pipeline/gait/gait_figures.h"
#include "kinemark/pipeline/gait/gait_sheet.h"

namespace kinemark::pipeline {

/// Two panels of a sheet, one against the other.
struct AnglePair {
  const SheetPanel* x = nullptr;  ///< horizontal
  const SheetPanel* y = nullptr;  ///< vertical
};

/// The pairs that are asked for, "hip_flexion:knee_flexion"; without any, hip against knee and knee against
/// ankle, as far as they are there. What a name does not find becomes a sentence, with the nearest names, and
/// is left out.
/// @param remarks  sentences are added
[[nodiscard]] std::vector<AnglePair> angle_pairs(const GaitSheet& sheet, std::span<const std::string> asked,
                                                 std::vector<std::string>& remarks);

/// Means of two curves where the same cycles have both, and the covariance between cycles.
struct CyclogramPoint {
  Eigen::Vector2d mean;        ///< NaN where no cycle has both
  Eigen::Matrix2d covariance;  ///< N - 1; NaN of fewer than two cycles
  int cycles = 0;              ///< that have both
};
/// At each point of the cycle. Contract: curves of the same cycles and points.
[[nodiscard]] std::vector<CyclogramPoint> cyclogram(const SheetCurve& x, const SheetCurve& y);

/// The convex hull of points, counter-clockwise; less than three: as they are.
[[nodiscard]] std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// A figure a pair, left and right beside each other: every cycle thin, the mean thick with arrows along
/// time, strike and leaving of the ground marked; behind them what ellipses of one standard deviation between
/// cycles cover as they go along the mean.
[[nodiscard]] std::vector<GaitFigure> angle_angle_figures(const GaitSheet& sheet,
                                                          std::span<const AnglePair> pairs);

}  // namespace kinemark::pipeline
