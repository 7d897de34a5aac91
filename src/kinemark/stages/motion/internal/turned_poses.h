// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Poses in which a body with all its points on one line is turned half about it. Theory:
// docs/theory/error-bars.md
#pragma once

#include <Eigen/Core>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/internal/loose_bodies.h"
#include "kinemark/stages/motion/internal/problem.h"

namespace kinemark::motion::internal {

/// Makes such poses, to be solved from; use it for one frame after the other.
class TurnedPoses {
 public:
  explicit TurnedPoses(const Problem& problem) : problem_(problem), w_(problem.model) {}

  /// Turn a body half about its line, then each joint beyond it to where the markers fit best: a knee then
  /// flexes the other way, and the toes point away from it again. Within limits. False, and a state of no
  /// use, where the body's joint does not turn about the line. Some 20 poses and 12 for each joint beyond.
  ///
  /// @param y            3 x M, m
  /// @param information  M, 1/m^2 of each marker, 0 where it is not seen
  [[nodiscard]] bool turn(const UnseenTurn& unseen, const Eigen::Matrix3Xd& y,
                          const Eigen::VectorXd& information, Eigen::VectorXd& state);

 private:
  bool turn_half(const UnseenTurn& unseen, Eigen::VectorXd& state);
  void swing(int column, Eigen::VectorXd& state);
  [[nodiscard]] double squares() const;

  const Problem& problem_;
  model::Workspace w_;
  const Eigen::Matrix3Xd* y_ = nullptr;
  const Eigen::VectorXd* information_ = nullptr;
  Eigen::VectorXd move_, tried_;
};

}  // namespace kinemark::motion::internal
