// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/geometry_part.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/model/state.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"
#include "kinemark/stages/motion/scaling/testing/solved_leg.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_leg::leg;

VectorXd coordinates(const model::Model& model, const VectorXd& state) {
  VectorXd q = VectorXd::Zero(model.coordinate_count());
  model::coordinates_from_state(model, state, q, q);
  return q;
}

// Each parameter moved a little, and all frames solved again.
TEST(GeometryPart, IsWhatOtherSizesMakeOfTheSamePostures) {
  auto recording = testing_leg::record(leg(), {.frames = 3});
  for (std::int64_t m = 0; m < recording.markers(); ++m)
    recording.set_missing(2, m, data::SampleState::missing);
  const auto solved = testing_leg::solve(leg(), recording);
  const auto list = testing_leg::sizes_and_positions(leg(), {"TIB"});
  const GeometryLayout layout(solved.problem, leg(), list);
  constexpr double kChange = 1e-4;
  for (int k = 0; k < layout.columns; ++k) {
    VectorXd change = VectorXd::Zero(layout.columns);
    change[k] = kChange;
    const MatrixXd covariance = change * change.transpose();
    const MatrixXd sd = geometry_part(solved.problem, layout, recording, solved.states, covariance, 1);
    const auto moved = testing_leg::solve(apply_geometry(leg(), list, change), recording);
    for (Index f = 0; f < 2; ++f) {
      const VectorXd q = coordinates(solved.problem.model, solved.states.col(f)),
                     other = coordinates(moved.problem.model, moved.states.col(f));
      for (Index c = 0; c < q.size(); ++c)
        EXPECT_NEAR(sd(c, f), std::abs(other[c] - q[c]), 0.02 * kChange) << k << ' ' << f << ' ' << c;
    }
    EXPECT_EQ(sd.col(2).maxCoeff(), 0.0) << "no marker is seen";
  }
}

data::JointMotion motion_of(std::int64_t frames) {
  data::JointMotion motion;
  motion.coordinates = {"a", "b"};
  motion.time = {.rate_hz = 10.0, .t0_s = 0.0, .frames = frames};
  const auto size = static_cast<std::size_t>(2 * frames);
  motion.q.assign(size, 0.0);
  motion.q_sd.assign(size, 0.03);
  motion.q_bound.assign(size, 0.2);
  motion.determined.assign(size, 1);
  return motion;
}

TEST(GeometryError, OfTheNearestFrameIsAddedInSquares) {
  AdaptResult adapted;
  adapted.time_s = {0.0, 0.5};
  adapted.coordinate_sd.resize(2, 2);
  adapted.coordinate_sd << 0.04, 0.0, 0.6, 0.0;
  auto motion = motion_of(5);
  motion.determined[motion.index(1, 0)] = 0;
  add_geometry_error(adapted, motion);
  const auto at = [&](std::int64_t f, std::int64_t c) { return motion.index(f, c); };
  EXPECT_NEAR(motion.q_sd[at(0, 0)], 0.05, 1e-12);
  EXPECT_NEAR(motion.q_bound[at(0, 0)], 0.2 + 5.0 * 0.02, 1e-12);
  EXPECT_EQ(motion.q_sd[at(1, 0)], 0.03) << "not determined: left alone";
  EXPECT_NEAR(motion.q_sd[at(2, 0)], 0.05, 1e-12);
  EXPECT_EQ(motion.q_sd[at(3, 0)], 0.03) << "the second frame is nearer";
  EXPECT_EQ(motion.q_sd[at(4, 0)], 0.03);
  EXPECT_TRUE(std::isnan(motion.q_sd[at(0, 1)])) << "wider than a linear bar is valid";
  EXPECT_TRUE(std::isnan(motion.q_bound[at(0, 1)]));
  EXPECT_EQ(motion.determined[at(0, 1)], 0);
  EXPECT_EQ(motion.determined[at(4, 1)], 1);
  auto bare = motion_of(2);
  bare.q_sd.clear();
  add_geometry_error(adapted, bare);
  EXPECT_TRUE(bare.q_sd.empty());
}

}  // namespace
}  // namespace kinemark::motion::internal
