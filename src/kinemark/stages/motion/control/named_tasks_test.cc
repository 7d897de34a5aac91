// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tasks that levels name: their texts, their goals from markers, what they do to a body, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/units.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/goal_task.h"
#include "kinemark/stages/motion/control/online_tracker.h"
#include "kinemark/stages/motion/control/tasks.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/testing/body.h"
#include "support/allocations.h"

namespace kinemark::motion {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = NamedTask::Kind;

const model::Model& body() {
  static const auto model = model::Model::compile(testing_body::description()).value();
  return model;
}

std::vector<TrackLevel> levels(const std::vector<std::string>& texts) {
  std::vector<TrackLevel> out;
  for (const auto& text : texts) out.push_back(TrackLevel::parse(text).value());
  return out;
}

std::string refusal(const std::vector<std::string>& texts, TrackOptions options = {}) {
  options.levels = levels(texts);
  const auto result = track_markers(body(), testing_body::record(body(), 10), options);
  return result ? std::string("accepted") : result.error().message;
}

TEST(NamedTasks, AreReadFromTheTextOfALevel) {
  const auto level =
      TrackLevel::parse("LASI,orientation:torso,distance:A-B-C,coordinate:knee=-30deg,com:y=950mm,*");
  ASSERT_TRUE(level);
  EXPECT_THAT(level->markers, ::testing::ElementsAre("LASI", "*"));
  ASSERT_EQ(level->named.size(), 4U);
  EXPECT_EQ(level->named[0].kind, Kind::orientation);
  EXPECT_EQ(level->named[0].name, "torso");
  EXPECT_EQ(level->named[1].kind, Kind::distance);
  EXPECT_EQ(level->named[1].name, "A-B-C");
  EXPECT_EQ(level->named[2].kind, Kind::coordinate);
  EXPECT_NEAR(level->named[2].value, -30.0 * kRadPerDeg, 1e-15);
  EXPECT_EQ(level->named[2].text, "coordinate:knee=-30deg");
  EXPECT_EQ(level->named[3].kind, Kind::mass_centre);
  EXPECT_NEAR(level->named[3].value, 0.95, 1e-15);
  EXPECT_TRUE(std::isnan(TrackLevel::parse("coordinate:knee=rest")->named[0].value));
  EXPECT_EQ(TrackLevel::parse("coordinate:knee=0.5")->named[0].unit, NamedTask::Unit::plain);
}

TEST(NamedTasks, TextsThatAreNoneAreRefused) {
  for (const auto& [text, says] :
       std::vector<std::pair<std::string, std::string>>{{"A,,B", "has an empty name"},
                                                        {"orientation:", "names no body"},
                                                        {"distance:A", "names no two markers"},
                                                        {"coordinate:knee", "holds nothing at a value"},
                                                        {"coordinate:knee=bent", "which is no number"},
                                                        {"coordinate:knee=nan", "which is no number"},
                                                        {"com:x=rest", "which is no number"},
                                                        {"com:0.3", "holds nothing at a value"}}) {
    const auto level = TrackLevel::parse(text);
    ASSERT_FALSE(level) << text;
    EXPECT_EQ(level.error().code, Code::usage);
    EXPECT_THAT(level.error().message, HasSubstr(says));
  }
}

TEST(NamedTasks, WhatIsNotThereIsRefusedWithTheNearestName) {
  EXPECT_THAT(refusal({"orientation:trunc", "*"}),
              AllOf(HasSubstr("names body 'trunc', which the model does not have"),
                    HasSubstr("did you mean 'trunk'?")));
  EXPECT_THAT(refusal({"coordinate:elbov=0.2", "*"}), HasSubstr("did you mean 'elbow'?"));
  EXPECT_THAT(refusal({"distance:T1-FF1", "*"}),
              AllOf(HasSubstr("names marker 'FF1'"), HasSubstr("did you mean 'F1'?")));
  EXPECT_THAT(refusal({"com:w=0.1", "*"}), HasSubstr("need x, y or z"));
  EXPECT_THAT(refusal({"T1,S33"}), HasSubstr("did you mean 'S3'?"));
  EXPECT_THAT(refusal({"orientation:zebra", "*"}), ::testing::Not(HasSubstr("did you mean")));
}

TEST(NamedTasks, WhatIsAskedForTwiceIsRefused) {
  EXPECT_THAT(refusal({"coordinate:knee=0.2", "T1,coordinate:knee=0.3", "*"}),
              HasSubstr("coordinate 'knee' is asked for in level 1 and again in level 2; once is enough"));
  EXPECT_THAT(refusal({"coordinate:knee=0.2,coordinate:knee=0.2", "*"}),
              HasSubstr("in level 1 and again in level 1"));
  EXPECT_THAT(refusal({"orientation:trunk", "orientation:trunk,*"}),
              HasSubstr("orientation of 'trunk' is asked"));
  EXPECT_THAT(refusal({"distance:T1-F1", "distance:F1-T1,*"}),
              HasSubstr("distance of 'F1' and 'T1' is asked"));
  EXPECT_THAT(refusal({"com:x=0.1", "com:x=0.2,*"}), HasSubstr("centre of mass along x is asked"));
  EXPECT_EQ(refusal({"coordinate:knee=0.2,coordinate:hip=0.2", "*"}), "accepted");
}

TEST(NamedTasks, ValuesThatACoordinateCannotHaveAreRefused) {
  EXPECT_THAT(refusal({"coordinate:knee=20mm", "*"}), HasSubstr("is an angle; give it in deg or rad"));
  EXPECT_THAT(refusal({"coordinate:knee=170deg", "*"}), HasSubstr("ranges from -143.2 to 143.2 deg"));
  EXPECT_THAT(refusal({"coordinate:tilt=0.1", "*"}), HasSubstr("belongs to a free root"));
  EXPECT_THAT(refusal({"coordinate:kneecap_angle=0.1", "*"}), HasSubstr("follows another one"));
  EXPECT_THAT(refusal({"coordinate:knee=0.1", "*"}, {.locked = {"knee"}}), HasSubstr("is locked"));
  EXPECT_THAT(refusal({"com:x=3deg", "*"}), HasSubstr("has no angle"));
  EXPECT_THAT(refusal({"orientation:forearm", "*"}), HasSubstr("three tracked markers of the body"));
  EXPECT_THAT(refusal({"distance:T1-T2", "*"}), HasSubstr("both markers sit on one body"));
}

/// Goals of all markers of a moving body, exact with their derivatives along x(t) with speeds v + a t.
struct Moved {
  model::Workspace w;
  internal::GoalValues goal;
  Eigen::VectorXd v, a;

  explicit Moved(std::int64_t frame) : w(body()), goal(body().marker_count()) {
    const int n = body().speed_count();
    v.resize(n), a.resize(n);
    for (int k = 0; k < n; ++k) v[k] = std::sin(1.0 + k), a[k] = std::cos(2.0 * k);
    to(frame, 0.0);
    Eigen::VectorXd bias;
    Eigen::MatrixXd J;
    model::marker_jacobian(body(), w, J);
    model::marker_bias_acceleration(body(), w, bias);
    const Eigen::VectorXd rate = J * v, rate_2 = J * a + bias;
    goal.x = w.marker;
    goal.v = Eigen::Map<const Eigen::Matrix3Xd>(rate.data(), 3, body().marker_count());
    goal.a = Eigen::Map<const Eigen::Matrix3Xd>(rate_2.data(), 3, body().marker_count());
    goal.weight.setOnes();
  }
  void to(std::int64_t frame, double t) {
    Eigen::VectorXd x = model::state_from_coordinates(body(), testing_body::coordinates(body(), frame));
    model::integrate(body(), x, v * t + 0.5 * a * t * t);
    model::kinematics(body(), w, x);
    model::velocities(body(), w, v + a * t);
  }
};

TEST(NamedTasks, GoalsOfExactMarkersAreThoseOfTheBodyWithTheirRates) {
  Moved moved(40);
  const Eigen::VectorXd full = Eigen::VectorXd::Ones(body().marker_count());
  for (const auto& task :
       {internal::orientation_of_markers("trunk", full), internal::orientation_of_markers("shank", full),
        internal::distance_of_markers("T1", "F2")}) {
    ASSERT_TRUE(task->bind(body()));
    TaskRows rows;
    rows.resize(task->rows(), body().speed_count());
    Eigen::MatrixXd gains;
    task->follow(body(), moved.w, moved.goal, full, rows, &gains);
    EXPECT_LT(rows.error.norm(), 1e-12) << task->name();
    EXPECT_LT((rows.goal_velocity - rows.velocity).norm(), 1e-10) << task->name();
    EXPECT_LT((rows.jacobian * moved.v - rows.velocity).norm(), 1e-12);
    EXPECT_LT((rows.goal_acceleration - rows.jacobian * moved.a - rows.bias).norm(), 1e-9) << task->name();
    EXPECT_GT(rows.weight.minCoeff(), 0.0);
    // A small error of the markers changes the goal by the gains.
    auto off = moved.goal;
    for (std::size_t k = 0; k < task->markers().size(); ++k)
      off.x.col(task->markers()[k]) +=
          1e-6 * Eigen::Vector3d(static_cast<double>(k), 1.0, 0.4 - static_cast<double>(k % 2));
    Eigen::VectorXd error(gains.cols());
    for (std::size_t k = 0; k < task->markers().size(); ++k)
      error.segment<3>(3 * static_cast<Eigen::Index>(k)) = (off.x - moved.goal.x).col(task->markers()[k]);
    TaskRows moved_rows;
    moved_rows.resize(task->rows(), body().speed_count());
    task->follow(body(), moved.w, off, full, moved_rows, nullptr);
    EXPECT_GT(moved_rows.error.norm(), 1e-7);
    EXPECT_NEAR(moved_rows.error.norm(), (gains * error).norm(), 1e-10) << task->name();
  }
}

TEST(NamedTasks, AnOrientationIsWeightedByWhatItsMarkersKnowAndFadesInALine) {
  Moved moved(40);
  Eigen::VectorXd full = Eigen::VectorXd::Ones(body().marker_count());
  const auto task = internal::orientation_of_markers("shank", full);
  ASSERT_TRUE(task->bind(body()));
  EXPECT_EQ(task->points(), 3.0);
  TaskRows rows;
  rows.resize(3, body().speed_count());
  task->follow(body(), moved.w, moved.goal, full, rows, nullptr);
  // Sum of the moments about the principal axes: twice the squared distances from the middle.
  Eigen::Matrix3Xd x(3, 3);
  for (int k = 0; k < 3; ++k) x.col(k) = moved.w.marker.col(task->markers()[static_cast<std::size_t>(k)]);
  const Eigen::Vector3d middle = x.rowwise().mean();
  EXPECT_NEAR(rows.weight.sum(), 2.0 * (x.colwise() - middle).squaredNorm(), 1e-12);
  moved.goal.weight[task->markers()[1]] = 0.0;
  rows.resize(3, body().speed_count());
  task->follow(body(), moved.w, moved.goal, full, rows, nullptr);
  EXPECT_EQ(rows.weight.maxCoeff(), 0.0) << "two markers lie in one line";
  EXPECT_TRUE(rows.error.allFinite());
}

TEST(NamedTasks, FollowingAllocatesNothing) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "the sanitizer owns the allocator";
  Moved moved(40);
  const Eigen::VectorXd full = Eigen::VectorXd::Ones(body().marker_count());
  for (const auto& task :
       {internal::orientation_of_markers("trunk", full), internal::distance_of_markers("T1", "F2")}) {
    ASSERT_TRUE(task->bind(body()));
    TaskRows rows;
    rows.resize(task->rows(), body().speed_count());
    const auto before = testing_support::allocations_on_this_thread();
    task->follow(body(), moved.w, moved.goal, full, rows, nullptr);
    EXPECT_EQ(testing_support::allocations_on_this_thread(), before);
  }
}

TEST(NamedTasks, ACentreOfMassBelongsToTheMassesOfTheBodies) {
  Moved moved(40);
  for (int axis = 0; axis < 3; ++axis) {
    const auto task = mass_centre_task(axis, {0.25}, {.rate_hz = 1.0, .t0_s = 0.0, .frames = 1});
    ASSERT_TRUE(task->bind(body()));
    const auto rows_at = [&](double t) {
      moved.to(40, t);
      TaskRows rows;
      rows.resize(1, body().speed_count());
      task->evaluate(body(), moved.w, 0.0, rows);
      return rows;
    };
    const double h = 1e-5;
    const auto before = rows_at(-h), after = rows_at(h), now = rows_at(0.0);
    double place = 0.0, mass = 0.0;
    for (std::size_t b = 0; b < body().bodies().size(); ++b) {
      const auto& part = body().bodies()[b];
      place += part.mass * model::point_in_world(moved.w, static_cast<int>(b), part.com_in_body)[axis];
      mass += part.mass;
    }
    EXPECT_NEAR(now.error[0], 0.25 - place / mass, 1e-12);
    EXPECT_NEAR((before.error - after.error)[0] / (2.0 * h), now.velocity[0], 1e-7);
    EXPECT_NEAR((now.jacobian * moved.v - now.velocity).norm(), 0.0, 1e-12);
    EXPECT_NEAR((after.velocity - before.velocity)[0] / (2.0 * h), (now.jacobian * moved.a + now.bias)[0],
                1e-6);
  }
  EXPECT_FALSE(mass_centre_task(3, {0.0}, {})->bind(body()));
  EXPECT_FALSE(mass_centre_task(0, {0.0}, {}, 0.0)->bind(body()));
}

TEST(NamedTasks, HeldCoordinateCentreOfMassAndDistanceAreKeptStrictly) {
  const auto markers = testing_body::record(body(), 200, 0.5e-3);
  TrackOptions options{.levels = levels({"coordinate:elbow=20deg,com:y=0.1", "distance:T1-S2", "*"}),
                       .strict = true,
                       .level_bound_m = 1.0};
  const auto track = track_markers(body(), markers, options);
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->tasks.size(), 3U);
  EXPECT_EQ(track->tasks[0].text, "coordinate:elbow=20deg");
  EXPECT_TRUE(track->tasks[0].is_angle);
  EXPECT_LT(track->tasks[0].rms_error, 0.02 * kRadPerDeg);
  EXPECT_FALSE(track->tasks[1].is_angle);
  const auto& motion = track->motion;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    EXPECT_NEAR(motion.q[motion.index(f, motion.find("elbow"))], 20.0 * kRadPerDeg, 0.1 * kRadPerDeg) << f;
  EXPECT_LT(track->tasks[2].rms_error, 1e-3);
}

TEST(NamedTasks, AnOrientationDoesWhatItsMarkersDo) {
  // The trunk by its orientation and one marker is as near to the truth as by its four markers.
  const auto markers = testing_body::record(body(), 300, 1e-3);
  const auto by_task = track_markers(
      body(), markers, {.levels = levels({"orientation:trunk,T1,T2,T3,U1,U2,F1,F2,H1,H2,S1,S2,S3"})});
  ASSERT_TRUE(by_task) << by_task.error().message;
  const auto by_markers = track_markers(body(), markers).value();
  const double with = testing_body::angle_rms(body(), by_task->motion, 30),
               without = testing_body::angle_rms(body(), by_markers.motion, 30);
  EXPECT_LT(with, 1.1 * without);
  EXPECT_LT(by_task->tasks[0].rms_error, 0.01);
  EXPECT_THAT(by_task->motion.markers, ::testing::Contains("T4")) << "its goal is made of all four";
}

TEST(NamedTasks, DeviationsHoldTheNoiseOfTheMarkersBehindAGoal) {
  // Orientation and the trunk's markers are one piece of information: its deviations must not shrink.
  const auto markers = testing_body::record(body(), 400, 1e-3);
  TrackOptions options{.levels = levels({"orientation:trunk,*"}), .marker_noise_sd_m = 1e-3};
  const auto track = track_markers(body(), markers, options).value();
  options.levels.clear();
  const auto plain = track_markers(body(), markers, options).value();
  double squares = 0.0, expected = 0.0, ratio = 0.0;
  std::int64_t count = 0;
  for (std::int64_t f = 30; f < 370; f += 3) {
    const auto truth = testing_body::coordinates(body(), f);
    for (std::int64_t c = 0; c < 3; ++c) {
      const auto i = track.motion.index(f, c);
      ASSERT_GT(track.motion.q_sd[i], 0.0);
      squares += std::pow(track.motion.q[i] - truth[c], 2);
      expected += std::pow(track.motion.q_sd[i], 2);
      ratio += track.motion.q_sd[i] / plain.motion.q_sd[i];
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / expected), 1.0, 0.25);
  EXPECT_GT(ratio / static_cast<double>(count), 0.95);
}

TEST(NamedTasks, ALiveStreamGivesTheSameNumbers) {
  auto markers = testing_body::record(body(), 120, 1e-3, 6);
  for (std::int64_t f = 40; f < 60; ++f) markers.set_missing(f, markers.find("T3"));
  for (const bool strict : {false, true}) {
    TrackOptions options{.levels = levels({"coordinate:elbow=0.3,distance:T1-S2", "orientation:trunk", "*"}),
                         .strict = strict,
                         .level_bound_m = 1.0,
                         .marker_noise_sd_m = 1e-3};
    if (!strict)
      for (auto& level : options.levels) level.weight = 1.0;
    if (!strict) options.level_bound_m = 0.0;
    const auto file = track_markers(body(), markers, options);
    ASSERT_TRUE(file) << file.error().message;
    auto tracker = OnlineTracker::create(body(), markers.names, 100.0, options);
    ASSERT_TRUE(tracker) << tracker.error().message;
    std::int64_t poses = 0;
    const auto compare = [&] {
      for (auto pose = tracker->next(); pose && *pose != nullptr; pose = tracker->next(), ++poses)
        for (std::int64_t c = 0; c < file->motion.size(); ++c) {
          const auto i = file->motion.index((*pose)->frame, c);
          ASSERT_NEAR((*pose)->q[c], file->motion.q[i], 1e-9) << strict << ' ' << (*pose)->frame << ' ' << c;
        }
    };
    for (std::int64_t f = 0; f < markers.frames(); ++f) {
      Eigen::Matrix3Xd x(3, markers.markers());
      for (std::int64_t m = 0; m < markers.markers(); ++m) x.col(m) = markers.x(f, m);
      ASSERT_TRUE(tracker->push(markers.time.time_s(f), x));
      compare();
    }
    tracker->finish();
    compare();
    EXPECT_EQ(poses, 120);
  }
  auto twice = OnlineTracker::create(body(), markers.names, 100.0,
                                     {.levels = levels({"coordinate:elbow=0.3", "coordinate:elbow=0.3,*"})});
  EXPECT_FALSE(twice);
}

TEST(NamedTasks, ByWeightsAHeldValueCountsMostAndAnOrientationAsItsMarkers) {
  const auto markers = testing_body::record(body(), 150, 1e-3);
  const auto track = track_markers(body(), markers,
                                   {.levels = levels({"coordinate:elbow=0.3", "orientation:trunk", "*"}),
                                    .error_bars = false})
                         .value();
  ASSERT_EQ(track.levels.size(), 3U);
  EXPECT_NEAR(track.levels[0].weight / std::min(track.levels[1].weight, track.levels[2].weight), 100.0, 1e-6);
  EXPECT_LT(track.tasks[0].rms_error, 5.0 * kRadPerDeg);
}

}  // namespace
}  // namespace kinemark::motion
