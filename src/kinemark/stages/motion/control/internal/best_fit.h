// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// How far a body is from the pose that fits its goals best, where these are one sum of squares.
//
// Equation 15 of Demircan et al. takes the goals for reachable and the way there for straight. Goals that no
// pose reaches (skin, sizes of the limbs) leave residuals r, and the second derivatives of the markers along
// them belong to the matrix of the step, H = J'WJ - sum w r . d2p: without them a way of few degrees came out
// wrong by a factor of 2 in some frames. What is left after that step is found by the same H at the pose to
// which it leads, until it is nothing or the steps stop shrinking.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {

struct GoalValues;
struct Problem;

class BestFit {
 public:
  /// `problem` must outlive it: the model, its limits and the speeds that rest.
  explicit BestFit(const Problem& problem);

  /// From pose x with coordinates q, within the limits. False: H is not positive definite here, or the steps
  /// do not shrink to half each time; way() and left() say nothing then.
  [[nodiscard]] bool find(const Eigen::VectorXd& x, const Eigen::VectorXd& q, const GoalValues& goal);

  /// Coordinates of the best fit minus those of the body.
  [[nodiscard]] const Eigen::VectorXd& way() const { return way_; }
  /// The last step, which bounds what is left of the way as each is at most half of the one before.
  [[nodiscard]] const Eigen::VectorXd& left() const { return left_; }

 private:
  /// Forces of the residuals at the pose in x_, as the next step's right-hand side.
  void visit(const GoalValues& goal);
  /// Hold the speeds whose force presses their coordinate against a limit. True: they are others than before.
  bool hold_pressed();
  bool factorise();
  void clamp();

  const Problem& problem_;
  model::Workspace w_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::MatrixXd H_, held_H_, E_;
  Eigen::Matrix3Xd residual_;
  Eigen::VectorXd x_, step_, way_, left_;
  std::vector<std::uint8_t> held_, held_before_;
};

}  // namespace kinemark::motion::internal
