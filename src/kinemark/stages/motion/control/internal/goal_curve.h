// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"

namespace kinemark::motion::internal {

/// Natural cubic spline through evenly spaced values; a single value is a constant, and beyond the first and
/// last frame the nearest value is held.
class GoalCurve {
 public:
  GoalCurve() = default;
  /// `values`: one column per frame of `time`, or a single one. Fails when the count is wrong or a value is
  /// not finite.
  static Result<GoalCurve> through(const Eigen::MatrixXd& values, const TimeBase& time);

  /// Values, rates and second derivatives: 3 times as many numbers as a column has. Allocates nothing.
  void at(double time_s, std::span<double> out) const;

 private:
  TimeBase time_;
  Eigen::MatrixXd values_, curvature_;  // curvature: second derivative per frame^2
};

}  // namespace kinemark::motion::internal
