// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/geometry_part.h"

#include "kinemark/core/parallel.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {

Eigen::MatrixXd geometry_part(const Problem& problem, const GeometryLayout& layout,
                              const data::Trajectories& markers, const Eigen::MatrixXd& states,
                              const Eigen::MatrixXd& covariance, int threads) {
  const auto& model = problem.model;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(model.coordinate_count(), problem.frames);
  parallel_for(problem.frames, 16, threads, [&](std::int64_t begin, std::int64_t end) {
    FrameEquations equations(problem, layout);
    Eigen::Matrix3Xd y(3, model.marker_count());
    Eigen::VectorXd weight(model.marker_count()), q = Eigen::VectorXd::Zero(model.coordinate_count());
    Eigen::MatrixXd E, D;
    for (std::int64_t f = begin; f < end; ++f) {
      problem.observe(markers, f, y, weight);
      if (weight.sum() == 0.0) continue;
      equations.visit(y, weight, states.col(f));
      model::coordinates_from_state(model, states.col(f), q, q);
      model::coordinate_jacobian(model, equations.w, q, E);
      equations.llt.matrixU().solveInPlace(equations.LinvW);
      D.noalias() = E * equations.LinvW;
      out.col(f) = (D * covariance).cwiseProduct(D).rowwise().sum().cwiseMax(0.0).cwiseSqrt();
    }
  });
  return out;
}

}  // namespace kinemark::motion::internal
