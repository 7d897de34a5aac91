// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A body model where every joint turns about or slides along one fixed axis by one number, as robot formats
// hold it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/data/model_description.h"
#include "kinemark/io/robot/polynomial_fit.h"
#include "kinemark/math/se3.h"

namespace kinemark::io {

/// A hinge or a slide.
struct SimpleJoint {
  std::string name;         ///< its coordinate's; of a follower, its joint's and a number; unique
  int coordinate_idx = -1;  ///< in the description; -1: follows another joint
  bool is_rotation = true;  ///< false: slide
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();  ///< unit length, in the frame that the joints before it have moved
  double default_value = 0.0;    ///< in the default posture, rad or m
};

/// How one body hangs from another: parent_from_chain, then the joints in their order, all through one point,
/// then chain_from_body.
struct SimpleChain {
  int body_idx = 0;                 ///< in the description
  int parent_body_idx = -1;         ///< data::kGround: hangs from the ground
  math::SE3 parent_from_chain;      ///< m
  std::vector<SimpleJoint> joints;  ///< in the order in which they move the body
  math::SE3 chain_from_body;        ///< m
};

/// One joint follows another by a polynomial.
struct SimpleCoupling {
  std::string dependent, independent;  ///< names of joints
  PolynomialFit function;              ///< rad or m in and out
};

/// A model in simple joints.
struct SimpleTree {
  std::vector<SimpleChain> chains;        ///< one a body, parents before children
  std::vector<SimpleCoupling> couplings;  ///< what follows what
  std::vector<std::string> lost;          ///< a sentence each, errors in mm and degrees
};

/// The first axis that a coordinate drives by +-q + constant becomes the joint of its name. Every other axis
/// of it, or of a coordinate that follows it, becomes a joint that follows by a polynomial of that degree,
/// fitted over the coordinate's range (of one without limits: half a turn, or 1 m, to both sides); a fit that
/// is off by more than 1e-9 is said with its largest error. Axes of two coordinates, or of one that has no
/// joint, are held in the default posture, which is said with the most that they move. So are closed loops.
/// Axes of locked coordinates, and of those that follow them, are still. The model must have passed
/// validate(). O(bodies^2).
[[nodiscard]] SimpleTree simplify(const data::ModelDescription& model, int degree);

}  // namespace kinemark::io
