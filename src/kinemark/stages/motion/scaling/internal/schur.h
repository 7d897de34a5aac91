// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One frame's share of the normal equations of geometry and posture, with the posture eliminated.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>
#include <vector>

#include "kinemark/model/workspace.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::motion::internal {

/// The parameters' terms, arranged by the markers of a problem that they move.
class GeometryLayout {
 public:
  GeometryLayout(const Problem& problem, const data::ModelDescription& full,
                 std::span<const GeometryParameter> parameters);

  struct Term {
    GeometryTerm::Moves moves = GeometryTerm::Moves::marker;
    int column = 0;  ///< parameter
    int body = 0;    ///< tree index whose axes `direction` has; translation: child of the joint
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    data::AxisDescription axis;  ///< translation, as first described
  };
  /// Velocity (m per unit, world) of everything that the term moves. After kinematics().
  [[nodiscard]] static Eigen::Vector3d velocity(const Term& term, const model::Workspace& w);

  std::vector<Term> terms;
  std::vector<std::vector<int>> of_marker;  ///< per marker: its terms by column
  int columns = 0;
};

/// Sums over frames: S, gradient (parameters move along it to reduce the squares), weighted squares.
struct NormalSums {
  explicit NormalSums(int columns)
      : S(Eigen::MatrixXd::Zero(columns, columns)), g(Eigen::VectorXd::Zero(columns)) {}
  Eigen::MatrixXd S;  ///< lower triangle
  Eigen::VectorXd g;
  double weighted_squares = 0.0, squares = 0.0;
  std::int64_t seen = 0;
  NormalSums& operator+=(const NormalSums& other);
};

/// Scratch of one thread for one geometry.
class FrameEquations {
 public:
  FrameEquations(const Problem& problem, const GeometryLayout& layout);

  /// Pose, residuals, derivatives and the factor of the posture's normal matrix.
  void visit(const Eigen::Matrix3Xd& y, const Eigen::VectorXd& weight, const Eigen::VectorXd& x);
  void add_to(NormalSums& sums) const;

  /// Jq'W r, nv numbers: balanced by the coordinate tasks at the best posture.
  [[nodiscard]] Eigen::VectorXd posture_gradient() const;
  /// Subtract the part of the gradient due to a posture that is not at its minimum, - W'L^-T L^-1 given.
  void add_posture_part(const Eigen::VectorXd& gradient, NormalSums& sums) const;

  /// Derivative of one marker by one parameter.
  struct Column {
    int column = 0;
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
  };
  model::Workspace w;
  Eigen::MatrixXd J;                            ///< 3M x nv; speeds that may not move are zero
  Eigen::MatrixXd LinvW;                        ///< L^-1 Jq'W Jp, nv x parameters
  Eigen::LLT<Eigen::MatrixXd> llt;              ///< of Jq'W Jq + tasks
  std::vector<std::vector<Column>> derivative;  ///< per marker
  Eigen::Matrix3Xd residual;                    ///< 3 x M, 0 where not seen
  Eigen::VectorXd weight;

 private:
  void add_tasks(double total, const Eigen::VectorXd& x);

  const Problem& problem_;
  const GeometryLayout& layout_;
  std::vector<Eigen::Vector3d> velocity_;
  Eigen::MatrixXd H_, E_;
  Eigen::VectorXd q_;
};

}  // namespace kinemark::motion::internal
