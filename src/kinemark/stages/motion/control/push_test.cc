// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A force from outside on the body of a stream: how far it goes, how it comes back, and what stays untouched.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/controller.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kMass_kg = 2.0;
constexpr double kRate_hz = 100.0;

/// A block that slides along x, with three markers.
model::Model sliding_block(double range_m = 10.0) {
  data::ModelDescription m;
  m.name = "block";
  m.bodies = {{.name = "block", .mass = kMass_kg, .inertia_about_com = 0.01 * Eigen::Matrix3d::Identity()}};
  m.coordinates = {
      {.name = "x", .is_rotation = false, .range_min = -range_m, .range_max = range_m, .clamped = true}};
  m.joints = {{.name = "slide",
               .child_body_idx = 0,
               .axes = {{.is_rotation = false, .axis = Vector3d::UnitX(), .coordinate_idx = 0}}}};
  m.markers = {{.name = "A", .body_idx = 0, .x_in_body = {0.1, 0.0, 0.0}},
               {.name = "B", .body_idx = 0, .x_in_body = {0.0, 0.1, 0.0}},
               {.name = "C", .body_idx = 0, .x_in_body = {0.0, 0.0, 0.1}}};
  return model::Model::compile(std::move(m)).value();
}

/// Markers of the block at rest.
data::Trajectories still(const model::Model& model, std::int64_t frames) {
  auto out =
      data::Trajectories::all_missing({"A", "B", "C"}, {.rate_hz = kRate_hz, .t0_s = 0.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < 3; ++m) {
      out.x(f, m) = model.markers()[static_cast<std::size_t>(m)].x_in_body;
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

/// What to do after the pose of a frame.
using Hands = std::function<void(OnlineTracker&, std::int64_t pose)>;

std::vector<LivePose> stream(const model::Model& model, const data::Trajectories& markers,
                             const TrackOptions& options, const Hands& hands) {
  auto tracker = OnlineTracker::create(model, markers.names, markers.time.rate_hz, options).value();
  std::vector<LivePose> poses;
  Eigen::Matrix3Xd x(3, markers.markers());
  const auto fetch = [&] {
    while (const auto* pose = tracker.next().value()) {
      poses.push_back(*pose);
      hands(tracker, pose->frame);
    }
  };
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    for (std::int64_t m = 0; m < markers.markers(); ++m) x.col(m) = markers.x(f, m);
    EXPECT_TRUE(tracker.push(markers.time.time_s(f), x));
    fetch();
  }
  tracker.finish();
  fetch();
  return poses;
}

/// A force at a point of a body from after one pose until after another.
Hands pushing(int body, const Vector3d& point, const Vector3d& force_n, std::int64_t from, std::int64_t to) {
  return [=](OnlineTracker& tracker, std::int64_t pose) {
    if (pose == from) {
      EXPECT_TRUE(tracker.push_body(body, point, force_n));
    } else if (pose >= to) {
      EXPECT_TRUE(tracker.push_body(body, point, Vector3d::Zero()));
    }
  };
}

constexpr double kOmega = 20.0;
TrackOptions soft() { return {.omega_rad_s = kOmega, .step_s = 1e-3, .damping = 0.0, .lock = LockMode::off}; }

TEST(Push, ABlockAtRestGoesAsFarAsForceMassAndStiffnessSay) {
  const auto model = sliding_block();
  for (const double force_n : {-300.0, 10.0, 100.0}) {
    const auto poses =
        stream(model, still(model, 200), soft(), pushing(0, {0.1, 0.0, 0.0}, {force_n, 40.0, 0.0}, 20, 1000));
    const double away_m = force_n / (kMass_kg * kOmega * kOmega);
    ASSERT_EQ(poses[199].pushed_q.size(), 1);
    EXPECT_NEAR(poses[199].pushed_q[0], away_m, 1e-6 * std::abs(away_m)) << "y is no way that it can go";
    EXPECT_NEAR(poses[199].pushed_m, std::abs(away_m), 1e-6 * std::abs(away_m));
    EXPECT_NEAR(poses[199].q[0], 0.0, 1e-12);
    EXPECT_EQ(poses[20].pushed_q.size(), 0);
    EXPECT_EQ(poses[21].pushed_q.size(), 1) << "from the next frame on";
  }
}

TEST(Push, ItComesBackAsACriticallyDampedSpring) {
  const auto model = sliding_block();
  const std::int64_t released = 150;
  const auto poses =
      stream(model, still(model, 300), soft(), pushing(0, Vector3d::Zero(), {100.0, 0.0, 0.0}, 20, released));
  const double away_m = 100.0 / (kMass_kg * kOmega * kOmega);
  for (std::int64_t f = released; f < released + 40; ++f) {
    const double wt = kOmega * static_cast<double>(f - released) / kRate_hz;
    EXPECT_NEAR(poses[static_cast<std::size_t>(f)].pushed_m, away_m * (1.0 + wt) * std::exp(-wt),
                0.01 * away_m)
        << f;
  }
  const auto after = static_cast<std::size_t>(std::ceil(released + 6.7 / kOmega * kRate_hz));
  EXPECT_LT(poses[after].pushed_m, 0.0105 * away_m);
  EXPECT_GT(poses[after - 7].pushed_m, 0.0105 * away_m) << "not at once";
  EXPECT_EQ(poses[280].pushed_q.size(), 0) << "it is back";
  EXPECT_EQ(poses[280].pushed_m, 0.0);
  EXPECT_GT(poses[after].pushed_q.size(), 0) << "still marked";
}

TEST(Push, AStopOfTheJointHoldsIt) {
  const auto model = sliding_block(0.05);
  const auto poses =
      stream(model, still(model, 200), soft(), pushing(0, Vector3d::Zero(), {300.0, 0.0, 0.0}, 20, 1000));
  for (const auto& pose : poses)
    if (pose.pushed_q.size() > 0) EXPECT_LE(pose.pushed_q[0], 0.05);
  EXPECT_NEAR(poses[199].pushed_q[0], 0.05, 1e-6);
}

bool same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return x == y || (std::isnan(x) && std::isnan(y));
         });
}

TEST(Push, TheTrackedBodyKnowsNothingOfIt) {
  const auto model = model::Model::compile(testing_body::description()).value();
  auto markers = testing_body::record(model, 200, 1e-3, 6);
  for (std::int64_t f = 60; f < 80; ++f) markers.set_missing(f, 7);
  const std::vector<std::string> upper{"T1", "T2", "T3", "T4"};
  for (const TrackOptions& options :
       {TrackOptions{}, TrackOptions{.levels = {{.markers = upper}, {.markers = {"*"}}}},
        TrackOptions{
            .levels = {{.markers = upper}, {.markers = {"*"}}}, .strict = true, .level_bound_m = 0.01},
        TrackOptions{.settle = true}}) {
    const auto alone = stream(model, markers, options, [](OnlineTracker&, std::int64_t) {});
    const auto pushed =
        stream(model, markers, options, pushing(2, {0.0, -0.2, 0.0}, {60.0, 80.0, -50.0}, 30, 100));
    ASSERT_EQ(alone.size(), pushed.size());
    double farthest_m = 0.0;
    for (std::size_t f = 0; f < alone.size(); ++f) {
      const auto &a = alone[f], &b = pushed[f];
      ASSERT_TRUE(same(a.q, b.q) && same(a.qd, b.qd) && same(a.qdd, b.qdd) && same(a.tau, b.tau)) << f;
      ASSERT_TRUE(same(a.q_sd, b.q_sd) && same(a.q_bound, b.q_bound)) << f;
      ASSERT_EQ(a.status, b.status);
      ASSERT_EQ(a.rank, b.rank);
      EXPECT_EQ(a.pushed_m, 0.0);
      EXPECT_EQ(b.pushed_q.size() > 0, b.pushed_m > 0.0) << f;
      farthest_m = std::max(farthest_m, b.pushed_m);
    }
    EXPECT_GT(farthest_m, 0.002) << "it went somewhere";
    EXPECT_LT(pushed[115].pushed_m, 0.05 * farthest_m) << "and came back";
  }
}

/// An arm that turns about z through more than half a turn, along x where its goals are.
model::Model turning_arm() {
  data::ModelDescription m;
  m.name = "arm";
  m.bodies = {{.name = "arm",
               .mass = 1.0,
               .com_in_body = {0.2, 0.0, 0.0},
               .inertia_about_com = 0.001 * Eigen::Matrix3d::Identity()}};
  m.coordinates = {{.name = "turn", .range_min = -0.1, .range_max = 3.8, .clamped = true}};
  m.joints = {{.name = "hinge",
               .child_body_idx = 0,
               .axes = {{.is_rotation = true, .axis = Vector3d::UnitZ(), .coordinate_idx = 0}}}};
  m.markers = {{.name = "A", .body_idx = 0, .x_in_body = {0.2, 0.0, 0.0}},
               {.name = "B", .body_idx = 0, .x_in_body = {0.3, 0.0, 0.02}},
               {.name = "C", .body_idx = 0, .x_in_body = {0.1, 0.0, 0.05}}};
  return model::Model::compile(std::move(m)).value();
}

TEST(Push, ABodyThatHangsInAnotherPoseIsTakenBack) {
  // Turned by more than half a turn, the shortest way to its goals leads against the stop.
  const auto model = turning_arm();
  auto options = soft();
  options.omega_rad_s = 10.0;
  const auto poses = stream(model, still(model, 600), options, [](OnlineTracker& tracker, std::int64_t pose) {
    const Vector3d end(0.3, 0.0, 0.0);
    if (pose == 20) EXPECT_TRUE(tracker.push_body(0, end, {-100.0, 100.0, 0.0}));
    if (pose == 80) EXPECT_TRUE(tracker.push_body(0, end, {0.0, -100.0, 0.0}));
    if (pose == 200) EXPECT_TRUE(tracker.push_body(0, end, Vector3d::Zero()));
  });
  ASSERT_EQ(poses[490].pushed_q.size(), 1);
  EXPECT_NEAR(poses[490].pushed_q[0], 3.8, 1e-6) << "at the stop, long after the release";
  EXPECT_EQ(poses[510].pushed_q.size(), 0) << "3 s after it";
}

TEST(Push, RefusesWhatIsNoForceOnABody) {
  const auto model = sliding_block();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto markers = still(model, 60);
  const auto poses = stream(model, markers, soft(), [&](OnlineTracker& tracker, std::int64_t) {
    const Vector3d zero = Vector3d::Zero(), one = Vector3d::UnitX();
    for (const int body : {-1, 1, 1'000'000}) {
      const auto refused = tracker.push_body(body, zero, one);
      ASSERT_FALSE(refused);
      EXPECT_THAT(refused.error().message, HasSubstr("is pushed; the model has 1, from 0"));
    }
    for (const auto& refused : {tracker.push_body(0, kNan * one, one), tracker.push_body(0, zero, kNan * one),
                                tracker.push_body(0, zero, one * HUGE_VAL)}) {
      ASSERT_FALSE(refused);
      EXPECT_THAT(refused.error().message, HasSubstr("is not a number"));
    }
    const auto strong = tracker.push_body(0, zero, 501.0 * one);
    ASSERT_FALSE(strong);
    EXPECT_EQ(strong.error().message, "a body is pushed by 501 N; at most 500 N are applied");
  });
  for (const auto& pose : poses) EXPECT_EQ(pose.pushed_q.size(), 0) << "without effect";
  EXPECT_TRUE(
      OnlineTracker::create(model, markers.names, kRate_hz, soft())->push_body(0, {}, {500.0, 0.0, 0.0}))
      << "before the first pose nothing happens";
}

TEST(Push, GoalsAreThoseThatTheBodyFollows) {
  const auto model = sliding_block();
  auto markers = still(model, 100);
  for (std::int64_t f = 40; f < 60; ++f) markers.set_missing(f, 1);
  const auto poses = stream(model, markers, soft(), [](OnlineTracker&, std::int64_t) {});
  ASSERT_EQ(poses[20].goal.cols(), 3);
  EXPECT_LT((poses[20].goal.col(1) - markers.x(20, 1)).norm(), 1e-12);
  EXPECT_TRUE(poses[50].goal.col(1).array().isNaN().all());
  EXPECT_TRUE(poses[50].goal.col(2).allFinite());
}

/// Accelerations of a body with and without a force at a point.
struct Accelerations {
  Eigen::VectorXd alone, pushed, expected;
};

Accelerations accelerations(const TrackOptions& options, const Vector3d& force_n) {
  const auto model = model::Model::compile(testing_body::description()).value();
  const auto plan = internal::make_plan(model, testing_body::record(model, 4), options).value();
  const auto& tracked = plan.problem.model;
  internal::Controller a(plan), b(plan);
  internal::GoalValues goal(tracked.marker_count());
  model::Workspace w(tracked);
  model::kinematics(tracked, w,
                    model::state_from_coordinates(tracked, testing_body::coordinates(tracked, 20)));
  goal.x = w.marker;
  goal.weight.setOnes();
  const auto x = model::state_from_coordinates(tracked, testing_body::coordinates(tracked, 10));
  for (auto* body : {&a, &b}) body->start(x, goal, 0.0);
  const Vector3d point(0.02, -0.2, 0.01);
  b.push({.body = 2, .point_in_body = point, .force_in_world = force_n});
  EXPECT_TRUE(a.evaluate(goal, 0.0) && b.evaluate(goal, 0.0));
  // J by finite differences of the point.
  model::kinematics(tracked, w, x);
  const Vector3d place = model::point_in_world(w, 2, point);
  Eigen::VectorXd tau(tracked.speed_count());
  Eigen::MatrixXd M;
  model::mass_matrix(tracked, w, M);
  for (Eigen::Index k = 0; k < tau.size(); ++k) {
    Eigen::VectorXd moved = x;
    model::integrate(tracked, moved, 1e-7 * Eigen::VectorXd::Unit(tau.size(), k));
    model::kinematics(tracked, w, moved);
    tau[k] = force_n.dot(model::point_in_world(w, 2, point) - place) / 1e-7;
  }
  return {.alone = a.a(), .pushed = b.a(), .expected = M.llt().solve(tau)};
}

TEST(Push, ItsAccelerationIsThatOfTheDynamicsWhateverTheLevels) {
  const Vector3d force_n(30.0, -20.0, 50.0);
  for (const TrackOptions& options :
       {TrackOptions{.limits = false},
        TrackOptions{.levels = {{.markers = {"F2"}}, {.markers = {"*"}}}, .limits = false},
        TrackOptions{.levels = {{.markers = {"F2"}}, {.markers = {"*"}}}, .strict = true, .limits = false}}) {
    const auto found = accelerations(options, force_n);
    EXPECT_LT((found.pushed - found.alone - found.expected).norm(), 1e-5 * found.expected.norm());
    EXPECT_GT(found.expected.norm(), 10.0);
  }
}

TEST(Push, AForceOfZeroChangesNoBit) {
  for (const TrackOptions& options :
       {TrackOptions{}, TrackOptions{.levels = {{.markers = {"F2"}}, {.markers = {"*"}}}, .strict = true}}) {
    const auto found = accelerations(options, Vector3d::Zero());
    EXPECT_EQ(found.pushed, found.alone);
  }
}

}  // namespace
}  // namespace kinemark::motion
