// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/schur.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_leg::leg;

/// Model, layout and one frame's markers at the best posture.
struct Case {
  data::Trajectories recording;
  testing_leg::Solved solved;
  std::vector<GeometryParameter> list;
  GeometryLayout layout;
  FrameEquations frame;
  Eigen::Matrix3Xd y;
  VectorXd weight;

  explicit Case(const data::ModelDescription& model = leg())
      : recording(testing_leg::record(leg(), {.frames = 3, .noise_sd_m = 0.002})),
        solved(testing_leg::solve(model, recording)),
        list(testing_leg::sizes_and_positions(model, {"TIB"})),
        layout(solved.problem, model, list),
        frame(solved.problem, layout),
        y(3, solved.problem.model.marker_count()),
        weight(solved.problem.model.marker_count()) {
    solved.problem.observe(recording, 1, y, weight);
  }
  NormalSums visit(const VectorXd& state) {
    frame.visit(y, weight, state);
    NormalSums sums(layout.columns);
    frame.add_to(sums);
    return sums;
  }
};

// Sizes, positions and the translation of the knee: effect of every parameter on every marker at a given
// posture.
TEST(GeometryLayout, its_velocities_are_the_derivatives_of_the_markers) {
  Case c;
  const VectorXd state = c.solved.states.col(1);
  c.visit(state);
  constexpr double h = 1e-6;
  for (Index k = 0; k < c.layout.columns; ++k) {
    const auto markers_at = [&](double by) {
      VectorXd change = VectorXd::Zero(c.layout.columns);
      change[k] = by;
      const auto moved = model::Model::compile(apply_geometry(leg(), c.list, change)).value();
      model::Workspace w(moved);
      model::kinematics(moved, w, state);
      return Eigen::Matrix3Xd(w.marker);
    };
    const Eigen::Matrix3Xd slope = (markers_at(h) - markers_at(-h)) / (2.0 * h);
    Eigen::Matrix3Xd ours = Eigen::Matrix3Xd::Zero(3, slope.cols());
    for (Index m = 0; m < slope.cols(); ++m)
      for (const auto& [column, d] : c.frame.derivative[static_cast<std::size_t>(m)])
        if (column == k) ours.col(m) = d;
    EXPECT_LT((ours - slope).cwiseAbs().maxCoeff(), 1e-8) << c.list[static_cast<std::size_t>(k)].name;
  }
}

TEST(FrameEquations, the_complement_is_never_negative) {
  Case c;
  const NormalSums sums = c.visit(c.solved.states.col(1));
  const MatrixXd S = sums.S.selfadjointView<Eigen::Lower>();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(S);
  EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * eigen.eigenvalues().maxCoeff());
  EXPECT_GT(eigen.eigenvalues().maxCoeff(), 0.1);
}

TEST(FrameEquations, a_posture_that_no_marker_sees_stays_out_of_the_complement) {
  auto unseen = leg();
  std::erase_if(unseen.markers, [](const auto& m) { return m.name == "HEE" || m.name == "TOE"; });
  auto locked = unseen;
  locked.coordinates[static_cast<std::size_t>(locked.find_coordinate("ankle_angle"))].locked = true;
  Case blind(unseen), fixed(locked);
  VectorXd state = blind.solved.states.col(1);
  const NormalSums a = blind.visit(state), b = fixed.visit(state);
  EXPECT_TRUE(a.S.allFinite());
  EXPECT_LT((a.S - b.S).norm(), 1e-12 * b.S.norm());
  EXPECT_LT((a.g - b.g).norm(), 1e-12);
}

TEST(FrameEquations, weights_count_as_often_as_they_say) {
  Case c;
  const VectorXd state = c.solved.states.col(1);
  const NormalSums once = c.visit(state);
  c.weight *= 3.0;
  const NormalSums thrice = c.visit(state);
  EXPECT_LT((thrice.S - 3.0 * once.S).norm(), 1e-12 * thrice.S.norm());
  EXPECT_LT((thrice.g - 3.0 * once.g).norm(), 1e-12);
  EXPECT_NEAR(thrice.weighted_squares, 3.0 * once.weighted_squares, 1e-15);
  EXPECT_EQ(thrice.squares, once.squares);
}

// Away from the best posture the gradient has a part that the posture would follow.
TEST(FrameEquations, the_postures_part_of_the_gradient_is_that_of_a_step_to_the_best_posture) {
  Case c;
  VectorXd state = c.solved.states.col(1);
  NormalSums best = c.visit(state);
  EXPECT_LT(c.frame.posture_gradient().norm(), 1e-6);
  const auto& knee = c.solved.problem.model.coordinates()[static_cast<std::size_t>(
      c.solved.problem.model.description().find_coordinate("knee_angle"))];
  state[knee.state_idx] += 1e-4;
  NormalSums off = c.visit(state);
  const double error_before = (off.g - best.g).norm();
  c.frame.add_posture_part(c.frame.posture_gradient(), off);
  EXPECT_LT((off.g - best.g).norm(), 1e-2 * error_before);
}

TEST(NormalSums, add_up) {
  Case c;
  const NormalSums once = c.visit(c.solved.states.col(1));
  NormalSums sum(c.layout.columns);
  sum += once;
  sum += once;
  EXPECT_EQ(sum.S, 2.0 * once.S);
  EXPECT_EQ(sum.g, 2.0 * once.g);
  EXPECT_EQ(sum.seen, 2 * once.seen);
  EXPECT_EQ(sum.squares, 2.0 * once.squares);
  EXPECT_EQ(sum.weighted_squares, 2.0 * once.weighted_squares);
}

}  // namespace
}  // namespace kinemark::motion::internal
