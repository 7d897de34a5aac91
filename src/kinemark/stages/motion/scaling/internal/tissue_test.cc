// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/tissue.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "kinemark/stages/motion/scaling/testing/small_leg.h"
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using testing_leg::leg;

struct Case {
  data::Trajectories recording;
  testing_leg::Solved solved;
  std::vector<GeometryParameter> list = testing_leg::sizes_and_positions(leg(), {});
  GeometryLayout layout;

  explicit Case(const testing_leg::Recording& how)
      : recording(testing_leg::record(leg(), how)),
        solved(testing_leg::solve(leg(), recording)),
        layout(solved.problem, leg(), list) {}
  [[nodiscard]] MarkerVariances variances() const {
    return estimate_variances(solved.problem, recording, solved.states, 1);
  }
  [[nodiscard]] TissuePass pass(int threads = 1) const {
    return {solved.problem, layout, recording, solved.states, threads};
  }
};

TEST(PostureFields, are_orthonormal_over_the_recording_and_centred) {
  const Case c({.frames = 150, .noise_sd_m = 0.001});
  const auto fields = posture_fields(c.solved.problem, c.solved.states);
  ASSERT_EQ(fields.size(), 4U);    // per body
  EXPECT_EQ(fields[0].cols(), 3);  // pelvis: the hip
  EXPECT_EQ(fields[1].cols(), 4);  // thigh: hip and knee
  EXPECT_EQ(fields[2].cols(), 2);  // shank: knee and ankle
  EXPECT_EQ(fields[3].cols(), 1);  // foot: ankle
  for (const auto& phi : fields) {
    const MatrixXd gram = phi.transpose() * phi / 150.0;
    EXPECT_LT((gram - MatrixXd::Identity(gram.rows(), gram.cols())).norm(), 1e-12);
    EXPECT_LT(phi.colwise().sum().norm(), 1e-9);
  }
}

TEST(PostureFields, angles_that_keep_still_make_none) {
  const Case c({.frames = 60, .knee_still = true});
  const auto fields = posture_fields(c.solved.problem, c.solved.states);
  EXPECT_GT(fields[0].cols(), 0);
  EXPECT_EQ(fields[1], fields[0]);  // of its two joints the hip alone
  EXPECT_EQ(fields[2].cols(), 0);
  EXPECT_EQ(fields[3].cols(), 0);
}

TEST(TissuePass, independent_noise_follows_no_posture) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Case c({.frames = 150, .noise_sd_m = 0.002, .seed = seed});
    const auto tissue = c.pass().detect(c.variances());
    EXPECT_FALSE(tissue.found) << seed;
    EXPECT_EQ(tissue.inflation, 1.0);
    EXPECT_EQ(tissue.own_slow.norm(), 0.0);
  }
}

// The four markers of the thigh slide, so that most of what follows the posture is found there.
TEST(TissuePass, a_slide_with_the_knee_is_found_where_it_is) {
  const Case c({.frames = 200, .noise_sd_m = 0.001, .slide_m = 0.008});
  const auto tissue = c.pass().detect(c.variances());
  ASSERT_TRUE(tissue.found);
  EXPECT_GT(tissue.sd_m, 0.0005);
  EXPECT_LT(tissue.sd_m, 0.008);
  EXPECT_GT(tissue.inflation, 2.0);
  EXPECT_LT(tissue.inflation, 200.0);
  double thigh = 0.0, others = 0.0;
  for (Index m = 0; m < tissue.own_slow.size(); ++m) {
    EXPECT_GE(tissue.own_slow[m], 0.0);
    EXPECT_GE(tissue.own_fast[m], 0.0);
    (c.solved.problem.model.markers()[static_cast<std::size_t>(m)].body == 1 ? thigh : others) +=
        tissue.own_slow[m];
  }
  EXPECT_GT(thigh, 2.0 * others);
}

// With the variance of plain noise the sandwich's middle is sigma^2 S, so that its whole is sigma^2 S^-1.
TEST(TissuePass, noise_alone_makes_the_middle_the_complement) {
  const Case c({.frames = 80, .noise_sd_m = 0.001});
  const Index M = c.solved.problem.model.marker_count(), B = 4;
  TissueModel plain;
  plain.own_fast = Eigen::VectorXd::Constant(M, 4e-6);
  plain.own_slow.setZero(M);
  plain.common_fast.setZero(B);
  plain.common_slow.setZero(B);
  NormalSums sums(c.layout.columns);
  FrameEquations frame(c.solved.problem, c.layout);
  Eigen::Matrix3Xd y(3, M);
  Eigen::VectorXd weight(M);
  for (std::int64_t f = 0; f < 80; ++f) {
    c.solved.problem.observe(c.recording, f, y, weight);
    frame.visit(y, weight, c.solved.states.col(f));
    frame.add_to(sums);
  }
  const MatrixXd S = sums.S.selfadjointView<Eigen::Lower>();
  const MatrixXd middle = c.pass().middle(plain, MatrixXd::Zero(S.rows(), S.cols()));
  EXPECT_LT((middle - 4e-6 * S).norm(), 1e-6 * 4e-6 * S.norm());
}

TEST(TissuePass, the_middle_has_no_negative_direction_and_any_threads_give_the_same_bits) {
  const Case c({.frames = 150, .noise_sd_m = 0.001, .slide_m = 0.008});
  const auto pass = c.pass();
  const auto tissue = pass.detect(c.variances());
  const MatrixXd some = 1e-3 * MatrixXd::Identity(c.layout.columns, c.layout.columns);
  const MatrixXd middle = pass.middle(tissue, some);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(middle);
  EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * eigen.eigenvalues().maxCoeff());
  EXPECT_EQ(c.pass(3).middle(tissue, some), middle);
}

}  // namespace
}  // namespace kinemark::motion::internal
