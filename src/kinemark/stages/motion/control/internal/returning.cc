// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/returning.h"

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {}  // namespace

ReturningMarkers::ReturningMarkers(int markers, double ease_s) : ease_s_(ease_s), leads_(at(markers)) {}

void ReturningMarkers::start(const Eigen::VectorXd& weight) {
  for (Eigen::Index m = 0; m < weight.size(); ++m) {
    leads_[at(m)].followed = weight[m] > 0.0;
    leads_[at(m)].led = false;
  }
}

bool ReturningMarkers::is_new(int marker, const Eigen::VectorXd& weight) const {
  return weight[marker] > 0.0 && !leads_[at(marker)].followed;
}

void ReturningMarkers::lead(int marker, double time_s, const Eigen::Vector3d& miss,
                            const Eigen::Vector3d& miss_rate) {
  leads_[at(marker)] = {.miss = miss, .rate = miss_rate, .begun_s = time_s, .followed = true, .led = true};
}

void ReturningMarkers::apply(double time_s, GoalValues& goal) {
  for (Eigen::Index m = 0; m < goal.weight.size(); ++m) {
    auto& lead = leads_[at(m)];
    if (goal.weight[m] == 0.0) lead.followed = lead.led = false;
    const double u = (time_s - lead.begun_s) / ease_s_;
    if (!lead.led || u >= 1.0) {
      lead.led = false;
      continue;
    }
    // Hermite: miss and its rate at u = 0, nothing at u = 1.
    const Eigen::Vector3d rate = ease_s_ * lead.rate;
    goal.x.col(m) += (1.0 + u * u * (2.0 * u - 3.0)) * lead.miss + u * (1.0 - u) * (1.0 - u) * rate;
    goal.v.col(m) += (6.0 * u * (u - 1.0) * lead.miss + (1.0 + u * (3.0 * u - 4.0)) * rate) / ease_s_;
    goal.a.col(m) += ((12.0 * u - 6.0) * lead.miss + (6.0 * u - 4.0) * rate) / (ease_s_ * ease_s_);
  }
}

}  // namespace kinemark::motion::internal
