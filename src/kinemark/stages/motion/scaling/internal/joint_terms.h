// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measured joint centres as terms of the fit of a model's geometry. Theory: docs/theory/scaling.md
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/scaling/geometry.h"
#include "kinemark/stages/motion/scaling/measured_joints.h"

namespace kinemark::motion::internal {

/// What measured joints say of K parameters at one geometry, without unit.
struct JointSums {
  Eigen::MatrixXd information;  ///< K x K: A' C^-1 A, A the derivative of the distances
  Eigen::VectorXd gradient;     ///< K: - A' C^-1 e; parameters move along it to reduce the squares
  double squares = 0.0;  ///< e' C^-1 e, e from where the markers have the joint to where the model has it
};

/// The distance of each measured joint from the model's, the markers' axes laid over the body by Kabsch.
class JointTerms {
 public:
  /// Joints and markers are those of the description.
  JointTerms(const data::ModelDescription& model, const std::vector<GeometryParameter>& parameters,
             const std::vector<MeasuredJoint>& joints);

  /// At the geometry changed by x. O(joints x markers x parameters).
  [[nodiscard]] JointSums sums(const Eigen::VectorXd& x) const;

 private:
  /// What a parameter moves of one joint and its markers, m per unit.
  struct Move {
    int column = 0;
    Eigen::Vector3d joint = Eigen::Vector3d::Zero();
    Eigen::Matrix3Xd markers;
  };
  struct Term {
    Eigen::Vector3d joint;        ///< in the body, as described
    Eigen::Matrix3Xd markers;     ///< in the body, as described
    Eigen::Matrix3Xd x;           ///< in axes of their own
    Eigen::Vector3d centre;       ///< there
    Eigen::Matrix3d information;  ///< of the centre, there
    std::vector<Move> moves;
  };
  std::vector<Term> terms_;
  Eigen::Index columns_ = 0;
};

}  // namespace kinemark::motion::internal
