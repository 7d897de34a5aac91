// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// A pendulum whose torque is known, a point on it, and a simulated person: all of it in memory.
#include "kinemark/workflow/motion/dynamics.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/workflow/motion/ik.h"
#include "kinemark/workflow/motion/testing/pendulum.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;
using testing::Pendulum;

constexpr std::int64_t kEdge = 50;  // frames at the ends, where rates are less exact

std::string refused(const model::Model& model, const GivenMotion& given,
                    const DynamicsOptions& options = {}) {
  const auto found = dynamics(model, given, options);
  return found ? std::string() : found.error().message;
}

/// Root mean square over the inner frames.
template <class Of>
double rms(std::int64_t frames, const Of& of) {
  double sum = 0.0;
  for (auto f = kEdge; f < frames - kEdge; ++f) sum += of(f) * of(f);
  return std::sqrt(sum / static_cast<double>(frames - 2 * kEdge));
}

/// A constant force along y that acts below the hinge, at ten times the rate of the motion and from before
/// it.
data::Wrenches steady_force(const data::JointMotion& motion, double along_y_n) {
  data::Wrench push{.name = "push", .body = "rod"};
  const TimeBase time{
      .rate_hz = 10.0 * motion.time.rate_hz, .t0_s = -0.5, .frames = 10 * motion.frames() + 1000};
  for (std::int64_t f = 0; f < time.frames; ++f) {
    push.force.insert(push.force.end(), {0.0, along_y_n, 0.0});
    push.moment.insert(push.moment.end(), {0.0, 0.0, 0.0});
    push.point.insert(push.point.end(), {0.1, -0.3, 0.0});
  }
  return {.time = time, .items = {push}};
}

TEST(Dynamics, APendulumsRatesAndTorqueWithTheirDeviations) {
  const Pendulum pendulum;
  const auto given = pendulum.motion(2e-3);
  DynamicsOptions options;
  options.torques = true;
  const auto found = dynamics(pendulum.model, {.motion = given}, options).value();
  const auto& motion = found.motion;
  const auto& sd = found.sd;
  EXPECT_EQ(motion.q, given.q) << "positions stay as they are";
  ASSERT_EQ(motion.tau.size(), motion.q.size());
  const auto error_of = [&](const Array<double>& values, auto truth) {
    return [&, truth](std::int64_t f) {
      return values[static_cast<std::size_t>(f)] - (pendulum.*truth)(motion.time.time_s(f));
    };
  };
  const auto standardized = [&](const Array<double>& values, const Array<double>& deviations, auto truth) {
    return rms(motion.frames(), [&, error = error_of(values, truth)](std::int64_t f) {
      return error(f) / deviations[static_cast<std::size_t>(f)];
    });
  };
  EXPECT_LT(rms(motion.frames(), error_of(motion.qd, &Pendulum::qd)), 0.02);
  EXPECT_LT(rms(motion.frames(), error_of(motion.tau, &Pendulum::torque)), 0.1);
  const std::array errors{standardized(motion.q, sd[0], &Pendulum::q),
                          standardized(motion.qd, sd[1], &Pendulum::qd),
                          standardized(motion.qdd, sd[2], &Pendulum::qdd),
                          standardized(motion.tau, motion.tau_sd, &Pendulum::torque)};
  for (const double error : errors) {  // of one motion, whose rates' errors hold for many frames each
    EXPECT_GT(error, 0.3);
    EXPECT_LT(error, 1.6);
  }
  EXPECT_THAT(found.facts, Contains(Pair("deviations", "from those of the motion")));
}

TEST(Dynamics, WhatIsContradictedOfTheMotionMissesABoundAndRangesAreSaid) {
  const Pendulum pendulum;
  const auto said = [](const model::Model& model, const GivenMotion& given) {
    return dynamics(model, given).value().remarks;
  };
  const auto clean = said(pendulum.model, {.motion = pendulum.motion(2e-3)});
  EXPECT_TRUE(clean.passed());
  EXPECT_THAT(clean.warnings, Not(Contains(HasSubstr("its range in the model"))));
  const auto other =
      said(pendulum.model, {.motion = pendulum.motion(2e-3), .contradicted = {"the knee spins"}});
  EXPECT_FALSE(other.passed());
  EXPECT_THAT(other.warnings, Contains("the knee spins"));
  auto narrow = pendulum.model.description();
  narrow.coordinates[0].range_min = 2.0, narrow.coordinates[0].range_max = 2.5;
  const auto ranged = said(model::Model::compile(narrow).value(), {.motion = pendulum.motion(2e-3)});
  EXPECT_THAT(ranged.warnings, Contains(HasSubstr("its range in the model, 114.6 to 143.2 deg")));
  EXPECT_TRUE(ranged.passed()) << "a model may have narrower ones";
}

TEST(Dynamics, APointOnATurningBodyGoesRoundTheHinge) {
  const Pendulum pendulum;
  DynamicsOptions options;
  options.body_idx = {0};
  options.points = {{.name = "tip", .body_idx = 0, .x_in_body = {0.0, -0.5, 0.0}}};
  const auto found = dynamics(pendulum.model, {.motion = pendulum.motion()}, options).value();
  const auto& bodies = found.bodies.value();
  ASSERT_EQ(bodies.columns(), 6 + 3 + 3);
  EXPECT_THAT(found.motion.tau, IsEmpty()) << "nobody asked for torques";
  for (auto f = kEdge; f < bodies.time.frames - kEdge; ++f) {
    const double t = bodies.time.time_s(f), q = pendulum.q(t), qd = pendulum.qd(t), qdd = pendulum.qdd(t);
    const Eigen::Vector3d down(std::sin(q), -std::cos(q), 0.0), along(std::cos(q), std::sin(q), 0.0);
    const auto is = [&](int order, std::int64_t column, const Eigen::Vector3d& x, double within) {
      const Eigen::Map<const Eigen::Vector3d> value(bodies.value.data() + bodies.index(f, order, column));
      ASSERT_LT((value - x).norm(), within) << order << " " << column << " " << f;
    };
    for (const auto& [column, radius_m] :
         {std::pair(0, pendulum.length_m), std::pair(6, pendulum.length_m), std::pair(9, 0.5)}) {
      is(0, column, radius_m * down, 1e-12);
      is(1, column, radius_m * qd * along, 0.005);
      is(2, column, radius_m * (qdd * along - qd * qd * down), 0.1);
    }
    is(1, 3, {0.0, 0.0, qd}, 0.01);
  }
}

TEST(Dynamics, AForceOnItsOwnClockActsWhereItIs) {
  const Pendulum pendulum;
  const auto given = pendulum.motion();
  DynamicsOptions options;
  options.torques = true;
  options.error_bars = false;
  const auto free = dynamics(pendulum.model, {.motion = given}, options).value();
  options.torques = false;  // forces imply it
  const auto pushed =
      dynamics(pendulum.model, {.motion = given, .forces = steady_force(given, 30.0)}, options).value();
  for (std::size_t f = 0; f < given.q.size(); ++f)
    ASSERT_NEAR(pushed.motion.tau[f], free.motion.tau[f] - 0.1 * 30.0, 1e-9) << f;
  EXPECT_THAT(pushed.facts, Contains(Pair("force of push", HasSubstr("on rod 0.000 to 5.990 s"))));
  EXPECT_THAT(pushed.motion.tau_sd, IsEmpty());
}

TEST(Dynamics, AMotionFromMarkersIsFollowedWithoutAFile) {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  const auto subject =
      simulation::simulate_subject(model, {.duration_s = 1.0, .rate_hz = 60.0, .seed = 3}).value();
  const auto solved = ik(model, {.trial = {.markers = subject.markers}}, {.estimator = Estimator::smoother});
  GivenMotion given{.motion = solved.value().result.motion};
  const auto knee = given.motion.find("knee_angle_r");
  ASSERT_GE(knee, 0);
  const auto i = given.motion.index(30, knee);
  given.motion.determined[i] = 0;
  given.motion.tau.assign(given.motion.q.size(), 1e9);  // of somebody else
  DynamicsOptions options;
  options.body_idx = {model.description().find_body("pelvis"), model.description().find_body("tibia_r")};
  const auto found = dynamics(model, given, options).value();
  const auto truth = dynamics(model, {.motion = subject.truth}, options).value();
  const auto& bodies = found.bodies.value();
  double squares = 0.0;
  for (std::int64_t f = 0; f < bodies.time.frames; ++f)
    for (std::int64_t axis = 0; axis < 3; ++axis) {
      const auto k = bodies.index(f, 0, axis);
      const double error = (bodies.value[k] - truth.bodies->value[k]) / bodies.sd[k];
      squares += error * error / static_cast<double>(3 * bodies.time.frames);
    }
  EXPECT_LT(std::sqrt(squares), 1.5) << "of the pelvis, in deviations";
  EXPECT_THAT(found.motion.tau, IsEmpty());
  EXPECT_TRUE(std::isnan(found.sd[0][i])) << "what is not determined has no deviation";
  EXPECT_TRUE(std::isfinite(found.sd[0][given.motion.index(31, knee)]));
  EXPECT_TRUE(std::isnan(bodies.sd[bodies.index(30, 0, 6)]));
  EXPECT_TRUE(std::isfinite(bodies.sd[bodies.index(30, 0, 0)]));
}

TEST(Dynamics, WhatNobodyMeasuredIsNotThere) {
  const Pendulum pendulum;
  GivenMotion given{.motion = pendulum.motion()};
  given.is_filled.assign(given.motion.q.size(), 0);
  given.is_filled[100] = 1;
  DynamicsOptions options;
  options.torques = true;
  const auto found = dynamics(pendulum.model, given, options).value();
  for (const auto* values : {&found.motion.q, &found.motion.qd, &found.motion.qdd, &found.motion.tau,
                             &found.motion.tau_sd, found.sd.data(), &found.sd[1], &found.sd[2]}) {
    EXPECT_TRUE(std::isnan((*values)[100]));
    EXPECT_TRUE(std::isfinite((*values)[101]));
  }
  EXPECT_TRUE(std::isnan(found.bodies->value[found.bodies->index(100, 0, 0)]));
}

TEST(Dynamics, ALowPassLeavesNoDeviations) {
  const Pendulum pendulum;
  DynamicsOptions options;
  options.cutoff_hz = 6.0;
  const auto found = dynamics(pendulum.model, {.motion = pendulum.motion(0.01)}, options).value();
  EXPECT_LT(rms(600,
                [&](std::int64_t f) {
                  return found.motion.q[static_cast<std::size_t>(f)] -
                         pendulum.q(0.01 * static_cast<double>(f));
                }),
            0.006)
      << "of 0.01 rad";
  for (const auto& sd : found.sd) EXPECT_THAT(sd, IsEmpty());
  EXPECT_THAT(found.bodies->sd, IsEmpty());
  EXPECT_THAT(found.motion.q_sd, IsEmpty());
  EXPECT_THAT(found.facts, Contains(Pair("deviations", "none")));
  EXPECT_THAT(
      found.remarks.warnings,
      Contains("coordinates were low-passed at 6 Hz: what that leaves of their noise is not known, and no "
               "deviations are written"));
  options.cutoff_hz = 0.0;
  const auto plain = dynamics(pendulum.model, {.motion = pendulum.motion()}, options).value();
  EXPECT_THAT(plain.remarks.warnings, Not(Contains(HasSubstr("coordinates were low-passed at"))));
  EXPECT_THAT(plain.facts, Contains(Pair("deviations", "from the noise found in each coordinate")));
  EXPECT_THAT(plain.facts, Not(Contains(Pair("low-pass", HasSubstr("Hz")))));
}

TEST(Dynamics, FramesThatWereMadeBetweenOthersHaveNoRates) {
  const Pendulum pendulum;
  GivenMotion given{.motion = pendulum.motion(1e-3)};
  auto& q = given.motion.q;
  given.motion.time.frames = 597;  // the last one is measured
  q.resize(597);
  for (std::size_t f = 0; f + 1 < q.size(); ++f)
    if (f % 4 != 0)
      q[f] = q[f - f % 4] + static_cast<double>(f % 4) / 4.0 * (q[f - f % 4 + 4] - q[f - f % 4]);
  given.motion.q_sd.clear();
  EXPECT_THAT(
      refused(pendulum.model, given),
      HasSubstr("the motion: 3 of every 4 frames were interpolated between the others, which come at 25 Hz"));
  DynamicsOptions options;
  options.cutoff_hz = 6.0;
  EXPECT_EQ(refused(pendulum.model, given, options), "");
}

TEST(Dynamics, RefusesInOneSentence) {
  const Pendulum pendulum;
  GivenMotion given{.motion = pendulum.motion(), .names = {.motion = "swing.mot", .forces = "push.c3d"}};
  DynamicsOptions options;
  options.cutoff_hz = 60.0;
  EXPECT_EQ(refused(pendulum.model, given, options),
            "a cut-off of 60 Hz needs more than 120 Hz; the motion has 100");
  for (const double cutoff_hz : {-1.0, kNaN, double{INFINITY}}) {
    options.cutoff_hz = cutoff_hz;
    EXPECT_THAT(refused(pendulum.model, given, options), HasSubstr("Hz; need 0 (none) or more"));
  }
  auto of_another = given;
  of_another.motion.coordinates = {"slide"};
  EXPECT_EQ(refused(pendulum.model, of_another),
            "swing.mot: its coordinates are not those of model 'pendulum'");
  auto broken = given;
  broken.motion.q[3] = kNaN;
  EXPECT_THAT(refused(pendulum.model, broken), HasSubstr("swing.mot: coordinate 'swing' of frame 3"));
  auto unclear = given;
  unclear.is_filled = {1};
  EXPECT_EQ(refused(pendulum.model, unclear), "swing.mot: 1 of its 600 numbers are said to be filled or not");
  auto short_one = given;
  short_one.motion.time.frames = 7;
  short_one.motion.q.resize(7);
  EXPECT_THAT(refused(pendulum.model, short_one), HasSubstr("swing.mot: the motion has 7 frames"));
  auto across = given;
  across.forces = steady_force(given.motion, -30.0);
  EXPECT_THAT(refused(pendulum.model, across), HasSubstr("push.c3d: the forces push along -y on average"));
  auto on_nothing = given;
  on_nothing.forces = steady_force(given.motion, 30.0);
  on_nothing.forces->items[0].body = "tail";
  EXPECT_THAT(refused(pendulum.model, on_nothing), HasSubstr("push.c3d: wrench 'push' names body 'tail'"));
  on_nothing.forces->items[0].force.pop_back();
  EXPECT_THAT(refused(pendulum.model, on_nothing), HasSubstr("push.c3d: "));
}

}  // namespace
}  // namespace kinemark::workflow
