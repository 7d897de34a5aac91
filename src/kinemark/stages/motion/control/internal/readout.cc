// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/readout.h"

#include <Eigen/LU>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {}  // namespace

Readout::Readout(const model::Model& model) : model_(model), w_(model), near_(model.coordinate_count()) {
  for (int c = 0; c < model.coordinate_count(); ++c)
    near_[c] = model.description().coordinates[at(c)].default_value;
  q_ = near_;
  tau_.setZero(model.coordinate_count());
}

void Readout::find(const Eigen::VectorXd& x, const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  model::coordinates_from_state(model_, x, near_, q_);
  near_ = q_;
  model::kinematics(model_, w_, x);
  model::velocities(model_, w_, v);
  model::rates_from_speeds(model_, w_, q_, v, a, rate_, acceleration_);
  model::inverse_dynamics(model_, w_, a, force_);
  for (int c = 0; c < model_.coordinate_count(); ++c) {
    const int speed = model_.coordinates()[at(c)].speed_idx;
    tau_[c] = speed >= 0 ? force_[speed] : std::numeric_limits<double>::quiet_NaN();
  }
  model::coordinate_jacobian(model_, w_, q_, E_);
  for (const auto& free : model_.free_joints()) {
    // Power is the same in both: E'tau = force.
    for (int block = 0; block < 2; ++block) {
      const int* coordinate = block == 0 ? free.translation_coordinate : free.rotation_coordinate;
      const int speed = free.speed_idx + 3 * block;
      Eigen::Matrix3d E;
      for (int i = 0; i < 3; ++i) E.row(i) = E_.block<1, 3>(coordinate[i], speed);
      const Eigen::Vector3d tau = E.transpose().inverse() * force_.segment<3>(speed);
      for (int i = 0; i < 3; ++i) tau_[coordinate[i]] = tau[i];
    }
  }
}

}  // namespace kinemark::motion::internal
