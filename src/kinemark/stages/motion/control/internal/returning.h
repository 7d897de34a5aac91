// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/stages/motion/control/internal/goals.h"

namespace kinemark::motion::internal {

/// Eases in the goals of markers that reappear.
///
/// A small weight softens a marker only against others: one that alone moves a coordinate acts fully at any
/// weight and would draw the body to its goal at the rate omega. Its goal therefore starts at the model
/// marker's position and velocity and approaches the measured one along a cubic within `ease_s` (> 0).
class ReturningMarkers {
 public:
  ReturningMarkers(int markers, double ease_s);

  /// From now on all goals of weight above 0 are used unchanged.
  void start(const Eigen::VectorXd& weight);
  /// Not followed so far: its weight is above 0 for the first time since it was 0.
  [[nodiscard]] bool is_new(int marker, const Eigen::VectorXd& weight) const;
  /// Ease in the marker from `time_s` on: its distance from the goal at that time (m), and the difference of
  /// velocities (m/s).
  void lead(int marker, double time_s, const Eigen::Vector3d& miss, const Eigen::Vector3d& miss_rate);
  /// The eased goals; discards the transitions of markers whose weight is 0.
  void apply(double time_s, GoalValues& goal);

 private:
  struct Lead {
    Eigen::Vector3d miss = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
    double begun_s = 0.0;
    bool followed = false, led = false;
  };
  double ease_s_;
  std::vector<Lead> leads_;
};

}  // namespace kinemark::motion::internal
