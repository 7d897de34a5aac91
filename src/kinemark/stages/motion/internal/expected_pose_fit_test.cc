// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/expected_pose_fit.h"

#include <gtest/gtest.h>

#include <limits>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kPositionSd_m = 0.5e-3;

/// A frame of the moving body whose pose and positions are known beforehand, up to the given uncertainty.
struct ExpectedFrame {
  explicit ExpectedFrame(double noise_m = 0.0, std::uint64_t seed = 1,
                         data::ModelDescription d = testing_body::description())
      : body(model::Model::compile(std::move(d)).value()),
        markers(testing_body::record(model::Model::compile(testing_body::description()).value(), 3, noise_m,
                                     seed)),
        problem(make_problem(body, markers, {}).value()),
        truth(model::state_from_coordinates(problem.model, testing_body::coordinates(problem.model, 1))),
        y(3, problem.model.marker_count()),
        seen(problem.model.marker_count()),
        fit(problem) {
    problem.observe(markers, 1, y, seen);
    const auto M = problem.model.marker_count();
    expected.x = truth;
    expected.speed_sd.setConstant(problem.model.speed_count(), 0.02);
    expected.position.resize(3, M);
    for (Eigen::Index m = 0; m < M; ++m)
      expected.position.col(m) = problem.model.markers()[static_cast<std::size_t>(m)].x_in_body;
    expected.position_sd.setConstant(M, kPositionSd_m);
    expected.bound.setConstant(M, 14.0);
  }
  void solve() { fit.solve(expected, y, seen); }
  [[nodiscard]] VectorXd off(const VectorXd& x) const {
    VectorXd d(problem.model.speed_count());
    model::difference(problem.model, truth, x, d);
    return d;
  }
  [[nodiscard]] int rejected() const {
    int n = 0;
    for (const auto r : fit.rejected()) n += r;
    return n;
  }

  model::Model body;
  data::Trajectories markers;
  Problem problem;
  VectorXd truth;
  Eigen::Matrix3Xd y;
  VectorXd seen;
  ExpectedPoseFit fit;
  Expectation expected;
};

TEST(ExpectedPoseFit, FindsThePoseOfExactSamplesFromBesideIt) {
  Random random(4, 1);
  for (int trial = 0; trial < 10; ++trial) {
    ExpectedFrame frame;
    VectorXd move(frame.expected.speed_sd.size());
    for (double& v : move) v = random.uniform(-0.03, 0.03);
    model::integrate(frame.problem.model, frame.expected.x, move);
    frame.solve();
    EXPECT_LT(frame.off(frame.fit.x()).cwiseAbs().maxCoeff(), 5e-3) << trial;
    EXPECT_LT(frame.off(frame.fit.x()).norm(), 0.1 * move.norm()) << trial;
    EXPECT_EQ(frame.rejected(), 0);
  }
}

TEST(ExpectedPoseFit, ASampleFarOffIsNotTakenAndMovesNothing) {
  for (Eigen::Index m = 0; m < 14; ++m) {
    ExpectedFrame frame(0.3 * kPositionSd_m, 7);
    frame.solve();
    const VectorXd without = frame.fit.x();
    EXPECT_EQ(frame.rejected(), 0);
    frame.y.col(m) += Vector3d(0.06, -0.05, 0.04);
    frame.solve();
    EXPECT_EQ(frame.rejected(), 1) << m;
    EXPECT_TRUE(frame.fit.rejected()[static_cast<std::size_t>(m)]);
    EXPECT_GT(frame.fit.distance()[m], 14.0);
    EXPECT_NEAR(frame.fit.length()[m], Vector3d(0.06, -0.05, 0.04).norm(), 0.01);
    // One of fourteen samples less: the pose goes by parts of the noise, not of the 90 mm.
    EXPECT_LT((frame.off(frame.fit.x()) - frame.off(without)).cwiseAbs().maxCoeff(), 0.02) << m;
  }
}

TEST(ExpectedPoseFit, TheBoundOfEachMarkerDecides) {
  ExpectedFrame frame;
  frame.y.col(5) += Vector3d(0.0, 0.05, 0.0);
  frame.solve();
  ASSERT_EQ(frame.rejected(), 1);
  const double distance = frame.fit.distance()[5];
  frame.expected.bound[5] = 1.05 * distance;
  frame.solve();
  EXPECT_EQ(frame.rejected(), 0) << "within its bound it is taken";
  frame.expected.bound[5] = 0.95 * distance;
  frame.solve();
  EXPECT_EQ(frame.rejected(), 1);
}

TEST(ExpectedPoseFit, WhatIsNotSeenOrNotKnownSaysNothing) {
  ExpectedFrame frame;
  frame.y.col(2).setConstant(1e3);
  frame.seen[2] = 0.0;
  frame.y.col(7).setConstant(-1e3);
  frame.expected.position_sd[7] = std::numeric_limits<double>::infinity();
  frame.solve();
  EXPECT_LT(frame.off(frame.fit.x()).norm(), 1e-6);
  EXPECT_EQ(frame.rejected(), 0);
  for (const Eigen::Index m : {2, 7}) {
    EXPECT_EQ(frame.fit.distance()[m], 0.0);
    EXPECT_EQ(frame.fit.length()[m], 0.0);
  }
}

TEST(ExpectedPoseFit, WithNothingSeenThePoseIsTheExpectedOne) {
  ExpectedFrame frame;
  frame.seen.setZero();
  frame.solve();
  EXPECT_LT(frame.off(frame.fit.x()).norm(), 1e-12);
  EXPECT_EQ(frame.rejected(), 0);
}

TEST(ExpectedPoseFit, ALockedCoordinateStaysAndHasNoVariance) {
  auto d = testing_body::description();
  d.coordinates[9].locked = true;  // the elbow
  ExpectedFrame frame(0.0, 1, d);
  const int speed = frame.problem.speed_of(9);
  VectorXd move = VectorXd::Zero(frame.expected.speed_sd.size());
  move[speed] = 0.05;
  model::integrate(frame.problem.model, frame.expected.x, move);
  frame.y.col(1) += Vector3d(0.08, 0.0, 0.0);  // something to judge
  frame.solve();
  EXPECT_NEAR(frame.off(frame.fit.x())[speed], 0.05, 1e-12);
}

TEST(ExpectedPoseFit, TheLessIsSeenTheMoreStaysOpen) {
  const auto variance_without = [](const std::vector<Eigen::Index>& lost) {
    ExpectedFrame frame;
    frame.y.col(0) += Vector3d(0.09, 0.0, 0.0);
    for (const Eigen::Index m : lost) frame.seen[m] = 0.0;
    frame.solve();
    EXPECT_EQ(frame.rejected(), 1);
    return frame.fit.variance();
  };
  const VectorXd all = variance_without({});
  const VectorXd shank = variance_without({10, 11, 12});
  ASSERT_EQ(all.size(), shank.size());
  EXPECT_TRUE((all.array() > 0.0).all());
  EXPECT_TRUE((shank.array() >= all.array() * (1.0 - 1e-6)).all());
  const ExpectedFrame frame;
  const int knee = frame.problem.speed_of(11), elbow = frame.problem.speed_of(9);
  EXPECT_GT(shank[knee], 2.0 * all[knee]) << "only the kneecap tells of it";
  EXPECT_LT(shank[knee], 0.02 * 0.02 * 1.01) << "no vaguer than expected beforehand";
  EXPECT_NEAR(shank[elbow] / all[elbow], 1.0, 0.05) << "the arm does not know";
}

TEST(ExpectedPoseFit, ASecondFrameDoesNotRememberTheFirst) {
  ExpectedFrame fresh(kPositionSd_m, 3), used(kPositionSd_m, 3);
  const Eigen::Matrix3Xd y = used.y;
  used.y.col(3) += Vector3d(0.2, 0.1, 0.0);
  used.solve();
  ASSERT_EQ(used.rejected(), 1);
  used.y = y;
  used.solve();
  fresh.solve();
  EXPECT_EQ(used.rejected(), 0);
  EXPECT_EQ(used.fit.x(), fresh.fit.x());
  EXPECT_EQ(used.fit.distance(), fresh.fit.distance());
}

TEST(ExpectedPoseFit, TheInformationOfMarkersSaysWhatTheyObserve) {
  ExpectedFrame frame;
  frame.expected.speed_sd.setConstant(0.5);
  const int knee = frame.problem.speed_of(11), elbow = frame.problem.speed_of(9);
  const VectorXd all = frame.fit.information(frame.expected, frame.seen);
  EXPECT_GT(all.minCoeff(), 1e3);
  VectorXd without = frame.seen;
  without[6] = without[7] = 0.0;  // the forearm's
  const VectorXd some = frame.fit.information(frame.expected, without);
  EXPECT_NEAR(some[elbow], 0.0, 1e-9);
  EXPECT_GT(some[knee], 1e3);
  EXPECT_TRUE((some.array() <= all.array() * (1.0 + 1e-9)).all());
  // A hinge with one marker a distance r from its axis, everything else known: (r / s)^2.
  without[7] = 1.0;
  frame.expected.speed_sd.setConstant(1e-9);
  frame.expected.speed_sd[elbow] = 0.5;
  model::Workspace w(frame.problem.model);
  model::kinematics(frame.problem.model, w, frame.expected.x);
  Eigen::Matrix3Xd J(3, frame.problem.model.speed_count());
  model::point_jacobian(frame.problem.model, w, frame.problem.model.markers()[7].body, w.marker.col(7), J);
  const double lever = J.col(elbow).norm() / kPositionSd_m;
  EXPECT_NEAR(frame.fit.information(frame.expected, without)[elbow], lever * lever, 1e-3 * lever * lever);
}

TEST(ExpectedPoseFit, ACalmFrameLeavesOpenWhatNothingObserves) {
  ExpectedFrame frame;
  frame.seen[6] = frame.seen[7] = 0.0;
  frame.solve();
  const int knee = frame.problem.speed_of(11), elbow = frame.problem.speed_of(9);
  EXPECT_NEAR(frame.fit.variance()[elbow], 0.02 * 0.02, 1e-9);
  EXPECT_LT(frame.fit.variance()[knee], 0.1 * 0.02 * 0.02);
}

}  // namespace
}  // namespace kinemark::motion::internal
