// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Where few markers are seen, a direction of the pose is known to ten degrees or not at all, and the poses
// that fit lie along a curve that noise may have bent: a linear error bar is too narrow. This one goes along
// the curve and asks the markers how far. Theory: docs/theory/error-bars.md
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "kinemark/model/workspace.h"

namespace kinemark::motion::internal {

// What the markers of a frame say of its pose, to first order.

struct Problem;

/// Normal matrix of the speeds by markers of given information; nothing is vaguer than 10 rad or m.
class SpeedCovariance {
 public:
  explicit SpeedCovariance(const Problem& problem) : problem_(problem) {}

  /// The matrix at a pose.
  /// @param w            after kinematics() of the pose
  /// @param information  M, 1/m^2 of each marker per axis, 0 where it is not seen
  /// @param held         a speed that may not change; -1 for none
  void factor(model::Workspace& w, const Eigen::VectorXd& information, Eigen::Index held = -1);

  /// Its inverse, nv x nv; below 1e-12 for speeds that are locked or held.
  void invert(Eigen::MatrixXd& K) const;

  /// g (nv) becomes K g.
  void solve(Eigen::VectorXd& g) const { llt_.solveInPlace(g); }

 private:
  const Problem& problem_;
  Eigen::MatrixXd H_, C_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

struct Problem;

/// Profiles the poses that fit one frame; use it for one frame after the other.
class ProfileErrors {
 public:
  explicit ProfileErrors(const Problem& problem);

  /// What the variance of each coordinate lacks to first order, rad^2 or m^2, is added to `variance` (n).
  ///
  /// Along each direction of the pose known less well than 0.03 rad (m), with twice the variance that all
  /// markers would leave or more: the speed that it moves most is held at places to both sides, the others
  /// are solved anew, and chi-square rises by D. A coordinate that went by d has a deviation of d /
  /// sqrt(max(D, 1)) at least (profile likelihood); what that is above the linear one is added. Places beyond
  /// D = 16, the limits of the coordinate and 1.5 rad (m) are not asked. Where a direction is open, each
  /// coordinate that is known is held as well, and goes on while D is below half of what a linear model has.
  /// Costs some 50 Newton steps for each of up to twelve directions, some ten for each known coordinate then,
  /// and one where all directions are known well.
  ///
  /// @param x            state that was solved
  /// @param y            3 x M, m
  /// @param information  M, 1/m^2 of each marker, 0 where it is not seen
  /// @param all          M, the same with every marker that other frames have
  /// @param E            n x nv, coordinates by speeds at x
  void add(const Eigen::VectorXd& x, const Eigen::Matrix3Xd& y, const Eigen::VectorXd& information,
           const Eigen::VectorXd& all, const Eigen::MatrixXd& E, Eigen::VectorXd& variance);

 private:
  struct Direction {
    Eigen::Index speed = 0;
    Eigen::VectorXd along;  ///< one standard deviation
  };

  void find_directions();
  double settle(Eigen::VectorXd& state, Eigen::Index held);
  /// What else moves along a direction, to first order: an open limb by radians for each deviation of a
  /// coordinate that is known.
  enum class Drags : std::uint8_t {
    counted,      ///< it goes no farther than the coordinate that is held may
    left_behind,  ///< it goes half a radian at most from one place to the next; settling does the rest
  };
  void profile(const Direction& direction, double sign, double least, Drags drags);
  void ask_what_is_known(const Eigen::MatrixXd& E, Eigen::VectorXd& variance);
  double residuals(const Eigen::VectorXd& state);

  const Problem& problem_;
  model::Workspace w_;
  SpeedCovariance covariance_;
  const Eigen::Matrix3Xd* y_ = nullptr;
  const Eigen::VectorXd* information_ = nullptr;
  Eigen::Matrix3Xd residual_;
  Eigen::MatrixXd K_, known_;
  Eigen::VectorXd whole_, best_, moved_, tried_, force_, step_, q_, q_best_, linear_, lacks_;
  double chi_square_ = 0.0;
  std::vector<Direction> directions_;
};

}  // namespace kinemark::motion::internal
