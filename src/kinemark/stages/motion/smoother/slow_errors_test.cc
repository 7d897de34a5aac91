// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What displaced markers do to the smoothed motion, against smoothing recordings with displaced markers.
#include "kinemark/stages/motion/smoother/internal/slow_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/smoother/internal/motion_output.h"
#include "kinemark/stages/motion/smoother/internal/whole_trajectory.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::int64_t kSeen = 150;
constexpr double kSlow_m = 1e-4;  // so little that second order does not show

class SlowErrorsTest : public ::testing::Test {
 protected:
  SlowErrorsTest()
      : model_(model::Model::compile(testing_body::description()).value()),
        markers_(testing_body::record(model_, kSeen)),
        trust_(at(model_.marker_count()), {.information = 1e6}),
        precision_(1e10 * MatrixXd::Identity(model_.speed_count(), model_.speed_count())) {
    for (std::int64_t f = 60; f < 85; ++f) markers_.set_missing(f, 3);
    bounds_.fixed.assign(at(model_.speed_count()), 0);
    bounds_.lower.setConstant(model_.speed_count(), -1e300);
    bounds_.upper.setConstant(model_.speed_count(), 1e300);
    noise_.slow.setZero(model_.marker_count());
    noise_.common_slow.setZero(static_cast<Eigen::Index>(model_.bodies().size()));
    base_ = motion_of(markers_, states_);
  }

  [[nodiscard]] std::vector<int> columns() const {
    std::vector<int> out;
    for (const auto& marker : model_.description().markers)
      out.push_back(static_cast<int>(markers_.find(marker.name)));
    return out;
  }

  data::JointMotion motion_of(const data::Trajectories& markers, MatrixXd& states) const {
    const MarkerObservations observations(markers, columns(), 0, trust_);
    states.resize(model_.state_count(), kSeen);
    for (std::int64_t f = 0; f < kSeen; ++f)
      states.col(f) = model::state_from_coordinates(model_, testing_body::coordinates(model_, f));
    WholeTrajectory trajectory(model_, observations, kSeen, precision_, bounds_);
    EXPECT_TRUE(trajectory.solve(states, 30, {}).converged);
    data::JointMotion motion;
    motion.time = markers.time;
    for (const auto& c : model_.description().coordinates) motion.coordinates.push_back(c.name);
    fill_coordinates(model_, states, motion);
    return motion;
  }

  [[nodiscard]] SlowErrors slow_errors() const {
    const MarkerObservations observations(markers_, columns(), 0, trust_);
    return {model_, observations, noise_, bounds_.fixed, base_, states_, precision_, 1};
  }

  /// Sum over the axes of the squared change of every coordinate when these markers lie elsewhere.
  [[nodiscard]] std::vector<double> squares_by_smoothing(const std::vector<int>& displaced) const {
    std::vector<double> squares(base_.q.size(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      auto moved = markers_;
      for (std::int64_t f = 0; f < kSeen; ++f)
        for (const int m : displaced)
          if (moved.present(f, columns()[at(m)])) moved.x(f, columns()[at(m)])[axis] += kSlow_m;
      MatrixXd states;
      const auto motion = motion_of(moved, states);
      for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += std::pow(motion.q[i] - base_.q[i], 2);
    }
    return squares;
  }

  /// At the ends of a gap the answer changes within a node of 0.05 s.
  void expect_alike(const std::vector<double>& expected) const {
    const auto slow = slow_errors();
    const double largest = *std::ranges::max_element(expected);
    for (std::int64_t f = 10; f + 10 < kSeen; ++f)
      for (int c = 0; c < model_.coordinate_count(); ++c)
        EXPECT_NEAR(std::sqrt(slow.variance(f, c)), std::sqrt(expected[base_.index(f, c)]),
                    0.12 * std::sqrt(largest))
            << f << " " << base_.coordinates[at(c)];
  }

  model::Model model_;
  data::Trajectories markers_;
  std::vector<MarkerTrust> trust_;
  MatrixXd precision_;
  SpeedBounds bounds_;
  NoiseSplit noise_;
  MatrixXd states_;
  data::JointMotion base_;
};

TEST_F(SlowErrorsTest, OfOneMarkerAreTheSmoothersAnswerToItAlsoInItsGap) {
  noise_.slow[3] = kSlow_m * kSlow_m;
  expect_alike(squares_by_smoothing({3}));
}

TEST_F(SlowErrorsTest, OfASegmentAreTheAnswerToAllItsMarkers) {
  const int body = model_.markers()[3].body;
  noise_.common_slow[body] = kSlow_m * kSlow_m;
  std::vector<int> on_it;
  for (int m = 0; m < model_.marker_count(); ++m)
    if (model_.markers()[at(m)].body == body) on_it.push_back(m);
  ASSERT_GT(on_it.size(), 1U);
  expect_alike(squares_by_smoothing(on_it));
}

TEST_F(SlowErrorsTest, AFixedSpeedHasNoneAndNothingSlowIsNoError) {
  EXPECT_EQ(slow_errors().variance(50, 9), 0.0);
  noise_.slow.setConstant(kSlow_m * kSlow_m);
  EXPECT_GT(slow_errors().variance(50, 9), 0.0);
  bounds_.fixed[at(model_.coordinates()[9].speed_idx)] = 1;
  EXPECT_LT(slow_errors().variance(50, 9), 1e-20);
}

}  // namespace
}  // namespace kinemark::motion::internal
