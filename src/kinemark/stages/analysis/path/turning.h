// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How a path goes around: circles, ellipses and their arcs, and where their last whole turn ends.
#pragma once

#include <Eigen/Core>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_samples.h"

namespace kinemark::analysis {

/// What a path does about the centre of the ellipse fitted to it, in its best-fit plane.
struct Turning {
  double turns = 0.0;          ///< from the first sample to the last, unsigned; 0 where no ellipse fits
  bool one_way = false;        ///< hardly ever back
  bool on_an_ellipse = false;  ///< it lies near that ellipse, which is no line
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();  ///< m
  Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();  ///< about which it turns by the right hand
  double whole_turns_end = kNaN;  ///< sample, between two, where its last whole turn ends; NaN: there is none
};

/// @param x  n x 3, m, with little noise
[[nodiscard]] Turning turning_of(const PathMatrix& x);

/// The same end of a path near the one that turns so: where it crosses the ray from the centre through its
/// own first sample.
/// @return  sample, between two; the last where the turn is not completed; NaN where there is none
[[nodiscard]] double whole_turns_end(const PathMatrix& x, const Turning& near);

}  // namespace kinemark::analysis
