// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_curves.h"

#include <cmath>

namespace kinemark::analysis {

Eigen::VectorXd tangential_acceleration(const PathSamples& path) {
  Eigen::VectorXd out(path.count());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double speed = path.v.row(i).norm();
    out[i] = speed > 0.0 ? path.v.row(i).dot(path.a.row(i)) / speed : 0.0;
  }
  return out;
}

CurveSpread::CurveSpread(const PathSamples& pilot)
    : speed_(speed_of(pilot)), acceleration_(tangential_acceleration(pilot)) {
  for (auto* sum : {&speed_sum_, &speed_squares_, &acceleration_sum_, &acceleration_squares_})
    *sum = Eigen::VectorXd::Zero(pilot.count());
}

void CurveSpread::add(const PathSamples& refit) {
  const Eigen::VectorXd speed = speed_of(refit) - speed_;
  const Eigen::VectorXd acceleration = tangential_acceleration(refit) - acceleration_;
  speed_sum_ += speed;
  speed_squares_ += speed.cwiseAbs2();
  acceleration_sum_ += acceleration;
  acceleration_squares_ += acceleration.cwiseAbs2();
  ++count_;
}

Eigen::VectorXd CurveSpread::deviation(const Eigen::VectorXd& sum, const Eigen::VectorXd& squares) const {
  if (count_ < 2) return {};
  const auto n = static_cast<double>(count_);
  return ((squares - sum.cwiseAbs2() / n) / (n - 1.0)).cwiseMax(0.0).cwiseSqrt();
}

}  // namespace kinemark::analysis
