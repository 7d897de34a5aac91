// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {

/// State, speeds and accelerations of the tree converted to the file's coordinates, with the generalised
/// forces.
class Readout {
 public:
  /// The model must outlive the readout.
  explicit Readout(const model::Model& model);

  /// Euler angles of free roots follow those of the call before.
  void find(const Eigen::VectorXd& x, const Eigen::VectorXd& v, const Eigen::VectorXd& a);

  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }
  [[nodiscard]] const Eigen::VectorXd& rate() const { return rate_; }
  [[nodiscard]] const Eigen::VectorXd& acceleration() const { return acceleration_; }
  /// M a + b + g, so that tau . dq/dt is power; NaN for coordinates that follow others or drive nothing.
  [[nodiscard]] const Eigen::VectorXd& tau() const { return tau_; }

 private:
  const model::Model& model_;
  model::Workspace w_;
  Eigen::VectorXd near_, q_, rate_, acceleration_, tau_, force_;
  Eigen::MatrixXd E_;
};

}  // namespace kinemark::motion::internal
