// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/frame_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using data::FrameStatus;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A recording of the body, its problem and a walk over it.
struct Walked {
  explicit Walked(std::int64_t frames, double noise_m = 0.0, IkOptions o = {})
      : options(std::move(o)), markers(testing_body::record(body, frames, noise_m, 5)) {}
  void run(bool keep_positions = true) {
    problem = make_problem(body, markers, options).value();
    walk.emplace(problem, options, progress);
    EXPECT_TRUE(walk->run(markers, keep_positions, solved));
  }
  [[nodiscard]] double off(std::int64_t f, const VectorXd& x) const {
    VectorXd d(problem.model.speed_count());
    const auto q = testing_body::coordinates(problem.model, f + problem.first_frame);
    model::difference(problem.model, model::state_from_coordinates(problem.model, q), x, d);
    return d.cwiseAbs().maxCoeff();
  }
  [[nodiscard]] double apart(const VectorXd& a, const VectorXd& b) const {
    VectorXd d(problem.model.speed_count());
    model::difference(problem.model, a, b, d);
    return d.cwiseAbs().maxCoeff();
  }
  [[nodiscard]] std::vector<std::uint8_t> only(std::initializer_list<std::int64_t> frames) const {
    std::vector<std::uint8_t> concerned(static_cast<std::size_t>(problem.frames), 0);
    for (const std::int64_t f : frames) concerned[static_cast<std::size_t>(f)] = 1;
    return concerned;
  }

  model::Model body = model::Model::compile(testing_body::description()).value();
  IkOptions options;
  Progress progress;
  data::Trajectories markers;
  Problem problem;
  std::optional<FrameWalk> walk;
  SolvedFrames solved;
};

TEST(FrameWalk, FindsTheTruthInEveryFrame) {
  Walked w(40);
  w.run();
  for (std::int64_t f = 0; f < 40; ++f) {
    EXPECT_LT(w.off(f, w.solved.states.col(f)), 1e-5) << f;
    EXPECT_EQ(w.solved.status[static_cast<std::size_t>(f)], FrameStatus::converged);
    EXPECT_LT(w.solved.cost[static_cast<std::size_t>(f)], 1e-12);
  }
  EXPECT_GT(w.solved.iterations, 0);
}

TEST(FrameWalk, BeginsWhereNearlyAllIsSeenAndWalksBothWays) {
  Walked w(30);
  for (std::int64_t f = 0; f < 12; ++f)
    for (const std::int64_t m : {0, 5}) w.markers.set_missing(f, m);
  w.run();
  EXPECT_EQ(w.solved.first, 12);
  for (std::int64_t f = 0; f < 30; ++f) EXPECT_LT(w.off(f, w.solved.states.col(f)), 1e-5) << f;
}

TEST(FrameWalk, ErrorsPositionsAndCostAreThoseOfThePoses) {
  Walked w(20, 0.002, {.marker_weights = {{"T2", 5.0}}});
  w.markers.set_missing(7, 3);
  w.run();
  const auto M = static_cast<std::int64_t>(w.problem.model.marker_count());
  model::Workspace k(w.problem.model);
  for (std::int64_t f = 0; f < 20; ++f) {
    model::kinematics(w.problem.model, k, w.solved.states.col(f));
    double squares = 0.0, weights = 0.0;
    for (std::int64_t m = 0; m < M; ++m) {
      const auto i = static_cast<std::size_t>((f * M + m) * 3);
      const Vector3d error = Eigen::Map<const Vector3d>(w.solved.marker_error.data() + i);
      const Eigen::Vector3f position = Eigen::Map<const Eigen::Vector3f>(w.solved.positions.data() + i);
      if (!w.markers.present(f, m)) {
        EXPECT_TRUE(error.array().isNaN().all() && position.array().isNaN().all());
        continue;
      }
      EXPECT_LT((error - (w.markers.x(f, m) - k.marker.col(m))).norm(), 1e-12);
      const int body = w.problem.model.markers()[static_cast<std::size_t>(m)].body;
      const Vector3d there = model::point_in_world(k, body, position.cast<double>());
      EXPECT_LT((there - w.markers.x(f, m)).norm(), 1e-7) << "seen from its body it is where it was seen";
      squares += w.problem.weight[m] * error.squaredNorm();
      weights += w.problem.weight[m];
    }
    EXPECT_NEAR(w.solved.cost[static_cast<std::size_t>(f)], squares / weights, 1e-15) << f;
  }
}

TEST(FrameWalk, AFrameThatSeesNothingKeepsItsNeighboursPose) {
  Walked w(20);
  for (std::int64_t f = 8; f < 11; ++f)
    for (std::int64_t m = 0; m < w.markers.markers(); ++m) w.markers.set_missing(f, m);
  w.run(false);
  EXPECT_TRUE(w.solved.positions.empty()) << "not asked for";
  for (std::int64_t f = 8; f < 11; ++f) {
    EXPECT_EQ(w.solved.status[static_cast<std::size_t>(f)], FrameStatus::no_markers);
    EXPECT_EQ(w.solved.states.col(f), w.solved.states.col(7));
    EXPECT_EQ(w.solved.cost[static_cast<std::size_t>(f)], 0.0);
  }
  EXPECT_LT(w.off(11, w.solved.states.col(11)), 1e-5) << "and behind it the body is found again";
}

TEST(FrameWalk, ABodyThatWasLostForASecondIsFoundAgain) {
  Walked w(200);
  for (std::int64_t f = 60; f < 160; ++f)
    for (std::int64_t m = 0; m < w.markers.markers(); ++m) w.markers.set_missing(f, m);
  w.run();
  for (std::int64_t f = 160; f < 200; ++f) EXPECT_LT(w.off(f, w.solved.states.col(f)), 1e-4) << f;
}

TEST(FrameWalk, NoBadSampleWindsAHinge) {
  // Frames so spoilt that random starts are tried, and joints that nothing keeps from going round.
  for (int i = 0; i < 60; ++i) {
    Walked w(8, 0.0, {.limits = false});
    std::swap(w.markers.x(4, 7 * i % 14)[0], w.markers.x(4, 5 * i % 14)[0]);
    for (const int m : {4, 5, 6, 7})
      w.markers.x(4, m) +=
          0.2 * (i / 7 % 9) * Vector3d(std::cos(0.7 * i * m), std::sin(0.43 * i * m), std::sin(0.32 * i * m));
    w.run(false);
    for (std::int64_t f = 1; f < 8; ++f)
      EXPECT_LT(w.apart(w.solved.states.col(f - 1), w.solved.states.col(f)), 3.1416)
          << "WIND" << i << ' ' << f;
  }
}

TEST(FrameWalk, SolvesAgainOnlyWhatIsConcerned) {
  Walked w(30, 0.001);
  w.run();
  const SolvedFrames before = w.solved;
  auto better = w.markers;
  const auto exact = testing_body::record(w.body, 30);
  for (const std::int64_t f : {10, 11, 25})
    for (std::int64_t m = 0; m < better.markers(); ++m) better.x(f, m) = exact.x(f, m);
  w.walk->solve_again(better, w.only({10, 11, 25}), w.solved);
  for (std::int64_t f = 0; f < 30; ++f) {
    const bool concerned = f == 10 || f == 11 || f == 25;
    if (concerned) {
      EXPECT_LT(w.off(f, w.solved.states.col(f)), 1e-5) << f;
    } else {
      EXPECT_EQ(w.solved.states.col(f), before.states.col(f)) << f;
    }
    EXPECT_EQ(w.solved.cost[static_cast<std::size_t>(f)] == before.cost[static_cast<std::size_t>(f)],
              !concerned);
  }
  EXPECT_GE(w.solved.iterations, before.iterations);
}

TEST(FrameWalk, SolvesTheFirstFrameAgainFromManyStarts) {
  Walked w(12);
  for (std::int64_t m = 0; m < w.markers.markers(); ++m)
    w.markers.x(0, m) += Vector3d(0.4, 0.0, 0.1) * (m % 3);
  w.run();
  ASSERT_EQ(w.solved.first, 0);
  ASSERT_GT(w.off(0, w.solved.states.col(0)), 0.02) << "the frame was spoilt";
  w.walk->solve_again(testing_body::record(w.body, 12), w.only({0}), w.solved);
  for (std::int64_t f = 0; f < 12; ++f) EXPECT_LT(w.off(f, w.solved.states.col(f)), 1e-5) << f;
}

TEST(FrameWalk, ABadFirstFrameLeavesNoWholeTurnBehind) {
  Walked w(30);
  w.run();
  const SolvedFrames right = w.solved;
  // The first frame was spoilt and the elbow began one turn away: every other frame followed it there.
  VectorXd turn = VectorXd::Zero(w.problem.model.speed_count());
  turn[w.problem.speed_of(9)] = 6.283185307179586;
  for (std::int64_t f = 0; f < 30; ++f) {
    VectorXd x = w.solved.states.col(f);
    model::integrate(w.problem.model, x, turn);
    w.solved.states.col(f) = x;
  }
  for (const bool a_marker_is_gone : {false, true}) {
    SolvedFrames solved = w.solved;
    auto kept = w.markers;
    if (a_marker_is_gone) kept.set_missing(0, 5);
    w.walk->solve_again(kept, w.only({0}), solved);
    EXPECT_EQ(solved.first, a_marker_is_gone ? 1 : 0);
    for (std::int64_t f = 0; f < 30; ++f)
      EXPECT_LT(w.apart(right.states.col(f), solved.states.col(f)), 1e-5) << f;
  }
}

TEST(FrameWalk, FramesThatFollowedAWrongPoseFollowTheRightOne) {
  Walked w(30);
  w.run();
  const SolvedFrames right = w.solved;
  // A whole turn of the elbow fits the markers as well: from frame 12 on it is one turn away.
  VectorXd turn = VectorXd::Zero(w.problem.model.speed_count());
  turn[w.problem.speed_of(9)] = 6.283185307179586;
  for (std::int64_t f = 12; f < 30; ++f) {
    VectorXd x = w.solved.states.col(f);
    model::integrate(w.problem.model, x, turn);
    w.solved.states.col(f) = x;
  }
  ASSERT_GT(w.apart(right.states.col(12), w.solved.states.col(12)), 6.0);
  w.walk->mend(w.markers, w.solved);
  for (std::int64_t f = 0; f < 30; ++f)
    EXPECT_LT(w.apart(right.states.col(f), w.solved.states.col(f)), 1e-5) << f;
}

TEST(FrameWalk, MendingLeavesAGoodMotionAlone) {
  Walked w(30, 0.001);
  w.run();
  const Eigen::MatrixXd before = w.solved.states;
  w.walk->mend(w.markers, w.solved);
  EXPECT_EQ(w.solved.states, before);
}

TEST(FrameWalk, FilledSamplesHelpThePoseButHaveNoError) {
  Walked w(16, 0.001);
  const auto filled = w.markers;
  for (const std::int64_t m : {4, 5, 6, 7}) w.markers.set_missing(9, m);  // the whole arm
  w.run();
  const VectorXd before = w.solved.states.col(9);
  w.walk->solve_filled(w.markers, filled, w.only({9}), w.solved);
  EXPECT_LT(w.off(9, w.solved.states.col(9)), 0.05);
  EXPECT_LT(w.off(9, w.solved.states.col(9)), w.off(9, before) + 1e-12);
  const auto M = filled.markers();
  for (std::int64_t m = 0; m < M; ++m)
    EXPECT_EQ(std::isnan(w.solved.marker_error[static_cast<std::size_t>((9 * M + m) * 3)]), m >= 4 && m <= 7)
        << m;
}

TEST(FrameWalk, StopsWhenTheCallerSaysSo) {
  Walked w(1100);
  w.problem = make_problem(w.body, w.markers, w.options).value();
  std::int64_t asked = 0;
  w.progress = [&](std::int64_t done, std::int64_t) {
    asked = done;
    return false;
  };
  EXPECT_FALSE(FrameWalk(w.problem, w.options, w.progress).run(w.markers, false, w.solved));
  EXPECT_EQ(asked, 1000);
}

}  // namespace
}  // namespace kinemark::motion::internal
