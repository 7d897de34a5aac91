// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/goal_curve.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace kinemark::motion::internal {

Result<GoalCurve> GoalCurve::through(const Eigen::MatrixXd& values, const TimeBase& time) {
  const Eigen::Index n = values.cols();
  if (n != 1 && (n < 2 || n != time.frames || !(time.rate_hz > 0.0)))
    return fail(Code::bad_input,
                fmt::format("{} goals for {} frames; need one per frame, or a single one", n, time.frames));
  if (!values.allFinite()) return fail(Code::bad_input, "a goal is not a number");
  GoalCurve curve;
  curve.time_ = time;
  curve.values_ = values;
  curve.curvature_.setZero(values.rows(), n);
  // Thomas algorithm for the curvature c, c[i-1] + 4 c[i] + c[i+1] = 6 (second difference), zero at the ends.
  Eigen::VectorXd factor = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double pivot = 4.0 - factor[i - 1];
    factor[i] = 1.0 / pivot;
    curve.curvature_.col(i) =
        (6.0 * (values.col(i + 1) - 2.0 * values.col(i) + values.col(i - 1)) - curve.curvature_.col(i - 1)) /
        pivot;
  }
  for (Eigen::Index i = n - 2; i > 0; --i) curve.curvature_.col(i) -= factor[i] * curve.curvature_.col(i + 1);
  return curve;
}

void GoalCurve::at(double time_s, std::span<double> out) const {
  const Eigen::Index rows = values_.rows(), n = values_.cols();
  const double index = n == 1 ? -1.0 : (time_s - time_.t0_s) * time_.rate_hz;
  if (!(index >= 0.0) || index > static_cast<double>(n - 1)) {
    const Eigen::Index nearest = index > 0.0 ? n - 1 : 0;
    for (Eigen::Index r = 0; r < rows; ++r) {
      out[static_cast<std::size_t>(r)] = values_(r, nearest);
      out[static_cast<std::size_t>(rows + r)] = out[static_cast<std::size_t>(2 * rows + r)] = 0.0;
    }
    return;
  }
  const Eigen::Index i = std::min(n - 2, static_cast<Eigen::Index>(index));
  const double u = index - static_cast<double>(i), b = 1.0 - u;
  for (Eigen::Index r = 0; r < rows; ++r) {
    const double y0 = values_(r, i), y1 = values_(r, i + 1), m0 = curvature_(r, i), m1 = curvature_(r, i + 1);
    out[static_cast<std::size_t>(r)] =
        (m0 * b * b * b + m1 * u * u * u) / 6.0 + (y0 - m0 / 6.0) * b + (y1 - m1 / 6.0) * u;
    out[static_cast<std::size_t>(rows + r)] =
        time_.rate_hz * (0.5 * (m1 * u * u - m0 * b * b) + y1 - y0 - (m1 - m0) / 6.0);
    out[static_cast<std::size_t>(2 * rows + r)] = time_.rate_hz * time_.rate_hz * (m0 * b + m1 * u);
  }
}

}  // namespace kinemark::motion::internal
