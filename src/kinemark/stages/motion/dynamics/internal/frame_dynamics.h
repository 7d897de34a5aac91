// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inverse dynamics of one frame and its derivatives, in speeds and in coordinates.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/dynamics/internal/unmeasured_load.h"

namespace kinemark::motion::internal {

/// The sum of the external forces on a body.
struct AppliedForce {
  int body = data::kGround;  ///< tree index
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero(),
                  point = Eigen::Vector3d::Zero();  ///< laboratory
};

/// One thread's frame.
class FrameDynamics {
 public:
  explicit FrameDynamics(const model::Model& model);

  /// Set coordinates and their rates (n each) and the external forces.
  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
           std::vector<AppliedForce> applied);

  /// Generalised forces tau of the speeds (nv) for the values set.
  [[nodiscard]] const Eigen::VectorXd& tau() const { return tau_; }
  /// Generalised forces of the file's coordinates (n); NaN for coordinates without a speed of their own.
  void to_coordinates(const Eigen::VectorXd& tau, Eigen::VectorXd& out) const;
  /// Derivatives of tau (speeds) by coordinate c, its rate and its acceleration. False when c moves nothing.
  /// By differences for the first two, good to about 1e-6.
  bool derivatives(int c, Eigen::VectorXd& by_q, Eigen::VectorXd& by_v, Eigen::VectorXd& by_a);
  /// Force and moment of a free joint along the axes of the laboratory, its origin, and the mass centres of
  /// bodies (tree indices).
  /// Only right after set(). `on_plate` is left empty.
  [[nodiscard]] RootFrame root_frame(const model::Model::FreeJoint& root, const std::vector<int>& feet) const;

 private:
  void evaluate(const Eigen::VectorXd& x, const Eigen::VectorXd& v, const Eigen::VectorXd& vdot,
                Eigen::VectorXd& tau);

  const model::Model& model_;
  model::Workspace w_;
  std::vector<AppliedForce> applied_;
  Eigen::VectorXd x_, v_, vdot_, tau_, moved_, moved_v_, direction_, outside_;
  Eigen::MatrixXd E_;
};

}  // namespace kinemark::motion::internal
