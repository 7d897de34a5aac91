// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Control by its law alone: what its steps cost, and that nothing is solved beside it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

#include "kinemark/stages/motion/control/internal/goals.h"
#include "kinemark/stages/motion/control/internal/step_error.h"
#include "kinemark/stages/motion/control/internal/walker.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing_body::angle_rms;
using testing_body::record;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

TEST(TrackSteps, NoSolverOfInverseKinematicsIsCalledAfterTheFirstFrameUnlessAsked) {
  const auto model = body();
  const auto markers = record(model, 150, 1e-3, 5);
  const auto by_control = track_markers(model, markers).value();
  EXPECT_EQ(by_control.solves, 0);
  const auto coarse = track_markers(model, markers, {.omega_rad_s = 40.0, .step_s = 0.01}).value();
  EXPECT_EQ(coarse.solves, 0);
  EXPECT_NE(coarse.motion.q, by_control.motion.q) << "steps differ, so do the angles";
  EXPECT_GE(track_markers(model, markers, {.settle = true})->solves, 149) << "each frame";
  auto bad = markers;
  bad.x(60, 6) += Eigen::Vector3d(0.2, -0.1, 0.1);
  EXPECT_GE(track_markers(model, bad)->solves, 150)
      << "samples that stand out are judged by fits of all frames";
  EXPECT_EQ(track_markers(model, bad, {.judge_samples = false})->solves, 0);
}

TEST(TrackSteps, StepsLeaveHardlyAnErrorOfTheirLength) {
  const auto model = body();
  const auto markers = record(model, 200);
  // Exact goals, a step per frame: what is left is the step's.
  const auto follow = [&](bool feed_forward) {
    return track_markers(model, markers,
                         {.omega_rad_s = 50.0,
                          .step_s = 0.01,
                          .feed_forward = feed_forward,
                          .cutoff_hz = 0.0,
                          .judge_samples = false,
                          .error_bars = false})
        .value()
        .motion;
  };
  const auto motion = follow(true);
  const double off = angle_rms(model, motion, 100);
  // At omega h = 0.5 this is what a step leaves whose acceleration is that of its beginning.
  EXPECT_LT(off, 0.5 * internal::step_error(model, motion, 0.01, 50.0));
  EXPECT_GT(angle_rms(model, follow(false), 100), 100.0 * off) << "without feed-forward it lags";
}

TEST(TrackSteps, TheAccelerationOfAFrameIsThatOfItsInstant) {
  const auto model = body();
  const auto markers = record(model, 200);
  const auto of = [&](double step_s, double omega) {
    return track_markers(
               model, markers,
               {.omega_rad_s = omega, .step_s = step_s, .judge_samples = false, .error_bars = false})
        .value()
        .motion;
  };
  const auto coarse = of(0.01, 50.0), fine = of(5e-4, 100.0);
  double off = 0.0, later = 0.0;
  for (std::int64_t f = 50; f < 150; ++f)
    for (std::int64_t c = 6; c < fine.size(); ++c) {
      const auto qdd = [&](const data::JointMotion& m, std::int64_t g) { return m.qdd[m.index(g, c)]; };
      off += std::pow(qdd(coarse, f) - qdd(fine, f), 2);
      later += std::pow(0.4 * (qdd(fine, f + 1) - qdd(fine, f)), 2);
    }
  EXPECT_LT(off, 0.1 * later) << "not that of the middle of the step";
}

TEST(TrackSteps, StepsThatCostMoreThanNoiseAreWarnedOf) {
  const auto model = body();
  const auto slow = record(model, 800, 2e-5, 4);
  auto markers = data::Trajectories::all_missing(slow.names, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 200});
  for (std::int64_t f = 0; f < 200; ++f)
    for (std::int64_t m = 0; m < slow.markers(); ++m) {
      markers.x(f, m) = slow.x(4 * f, m);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto warnings = [&](const TrackOptions& options) {
    return track_markers(model, markers, options)->fit.warnings;
  };
  EXPECT_THAT(warnings({.omega_rad_s = 50.0, .step_s = 0.01, .cutoff_hz = 0.0}),
              Contains(HasSubstr("deg of angles that are known to")));
  EXPECT_THAT(warnings({.step_s = 1e-3, .cutoff_hz = 0.0}),
              Not(Contains(HasSubstr("deg of angles that are known to"))));
}

/// A cell between two frames of a marker that moves by a sine.
internal::GoalCell sine_cell(std::int64_t first) {
  internal::SampleWindow samples(1, 60);
  Eigen::Matrix3Xd y(3, 1);
  for (int f = 0; f < 60; ++f) {
    y << std::sin(0.1 * f), 0.0, 1.0;
    samples.push(y, Eigen::VectorXd::Ones(1));
  }
  samples.end();
  internal::GoalCell cell(1);
  internal::GoalFilter(60.0, 0.0, 0.0, 0.1).build(samples, first, cell);
  return cell;
}

TEST(GoalCell, AccelerationsAloneAreThoseOfTheGoalsAndGoOnBehindTheCell) {
  const auto cell = sine_cell(22), next = sine_cell(23);
  internal::GoalValues goal(1);
  Eigen::Matrix3Xd a(3, 1);
  for (const double u : {0.0, 0.3, 1.0}) {
    cell.at(u, goal);
    cell.acceleration_at(u, a);
    EXPECT_NEAR((a - goal.a).norm(), 0.0, 1e-9) << u;
  }
  next.at(0.4, goal);
  cell.acceleration_at(1.4, a);
  const double still = std::abs(goal.a(0, 0));
  EXPECT_NEAR(a(0, 0), goal.a(0, 0), 0.02 * still);
  cell.at(1.0, goal);
  EXPECT_GT(std::abs(goal.a(0, 0) - a(0, 0)), 0.02 * still) << "it does not stand still there";
}

TEST(ReturningMarkers, AddsWhatEasingInDoesToTheAccelerations) {
  internal::ReturningMarkers returning(1, 0.1);
  returning.lead(0, 2.0, Eigen::Vector3d(0.02, 0.0, -0.01), Eigen::Vector3d(0.1, 0.2, 0.0));
  for (const double time_s : {2.0, 2.03, 2.09, 2.2}) {
    auto applied = returning;
    internal::GoalValues goal(1);
    goal.weight.setOnes();
    applied.apply(time_s, goal);
    Eigen::Matrix3Xd a = Eigen::Matrix3Xd::Zero(3, 1);
    returning.add_acceleration(time_s, a);
    EXPECT_NEAR((a - goal.a).norm(), 0.0, 1e-12) << time_s;
  }
}

TEST(TrackSteps, OnlyABodyThatLostItsGoalsIsSolvedFor) {
  const auto model = body();
  auto markers = record(model, 200);
  // Nothing is seen for a while, and then the body stands elsewhere, turned round.
  const Eigen::AngleAxisd half(3.0, Eigen::Vector3d::UnitY());
  for (std::int64_t f = 80; f < 200; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      if (f < 100)
        markers.set_missing(f, m);
      else
        markers.x(f, m) = half * Eigen::Vector3d(markers.x(f, m)) + Eigen::Vector3d(2.0, 0.0, 1.0);
    }
  const auto track =
      track_markers(model, markers, {.judge_samples = false, .marker_noise_sd_m = 1e-3}).value();
  EXPECT_LT(track.solves, 200) << "not at every frame";
  EXPECT_LT(angle_rms(model, track.motion, 121), 2e-3);
  for (std::int64_t f = 0; f < 65; ++f)
    EXPECT_EQ(track.motion.status[static_cast<std::size_t>(f)], data::FrameStatus::converged) << f;
}

}  // namespace
}  // namespace kinemark::motion
