// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Goals of direct marker control that are not points: anything with an error, a velocity and a Jacobian.
#pragma once

#include <Eigen/Core>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion {

/// The rows of one task in one step. The controller demands the acceleration
///   J q'' = goal_acceleration + kd (goal_velocity - velocity) + kp error - bias.
struct TaskRows {
  Eigen::VectorXd error;              ///< goal minus present value
  Eigen::VectorXd goal_velocity;      ///< feed-forward; 0 where the goal has none
  Eigen::VectorXd goal_acceleration;  ///< feed-forward; 0 where the goal has none
  Eigen::VectorXd velocity;           ///< J v
  Eigen::VectorXd bias;               ///< Jdot v
  Eigen::MatrixXd jacobian;           ///< rows x nv
  Eigen::VectorXd weight;  ///< >= 0, of the squared row: 1 counts like a marker's metre, 0: absent. Must
                           ///< change smoothly with time
  Eigen::VectorXd sd;      ///< one standard deviation of the goal, units of the row; 0: not known

  /// All zero, but weight 1.
  void resize(int rows, int speeds);
};

/// A goal with a constant number of rows.
class Task {
 public:
  Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;
  virtual ~Task() = default;

  [[nodiscard]] virtual std::string name() const = 0;  ///< what messages call it
  /// Called once, before the first step. The model has the bodies, coordinates and speeds (and their order)
  /// of the one given to the tracker, but of its markers only those that are tracked.
  [[nodiscard]] virtual Status bind(const model::Model& model) = 0;
  [[nodiscard]] virtual int rows() const = 0;  ///< number of rows, > 0 once bound
  /// Fill `out`, which has rows() rows and is as resize() left it. `w` holds kinematics() and velocities().
  /// Must not allocate.
  virtual void evaluate(const model::Model& model, const model::Workspace& w, double time_s,
                        TaskRows& out) const = 0;
};

}  // namespace kinemark::motion
