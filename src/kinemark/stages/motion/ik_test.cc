// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/ik.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/frame_solver.h"
#include "kinemark/stages/motion/testing/body.h"
#include "support/allocations.h"

namespace kinemark::motion {
namespace {

using data::FrameStatus;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace testing_body;

model::Model body() { return model::Model::compile(description()).value(); }

double largest_error(const model::Model& model, const IkResult& result) {
  double worst = 0.0;
  for (std::int64_t f = 0; f < result.motion.frames(); ++f) {
    const Eigen::VectorXd truth = coordinates(model, result.fit.first_frame + f);
    for (int c = 0; c < truth.size(); ++c)
      if (result.motion.determined.empty() || result.motion.determined[result.motion.index(f, c)])
        worst = std::max(worst, std::abs(result.motion.q[result.motion.index(f, c)] - truth[c]));
  }
  return worst;
}

TEST(SolveIk, RecoversEveryCoordinateFromPerfectMarkers) {
  const auto model = body();
  const auto result = solve_ik(model, record(model, 200)).value();
  EXPECT_LT(largest_error(model, result), 1e-9);
  EXPECT_LT(result.fit.max_error_m, 1e-10);
  for (const auto status : result.motion.status) EXPECT_EQ(status, FrameStatus::converged);
  EXPECT_LE(result.iterations, 12 * 40 + 200 * 4) << "a few Newton steps a frame";
}

/// The body whose elbow the model prescribes as it moves in record().
model::Model prescribed_body() {
  auto described = description();
  described.coordinates[9].prescribed =
      math::ScalarFunction::sine(0.5, 2.0 * (0.4 + 0.07 * 9), 0.9 * 9, 0.15 * 9 - 0.6);
  described.coordinates[9].default_value = -2.0;
  return model::Model::compile(described).value();
}

TEST(SolveIk, APrescribedCoordinateFollowsItsFunctionOfTime) {
  const auto model = prescribed_body();
  auto markers = record(model, 150, 0.003);
  for (std::int64_t f = 70; f < 75; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.set_missing(f, m);
  const auto result = solve_ik(model, markers, {.first_time_s = 0.2}).value();
  ASSERT_EQ(result.fit.first_frame, 20);
  for (std::int64_t f = 0; f < result.motion.frames(); ++f) {
    const auto i = result.motion.index(f, 9);
    EXPECT_NEAR(result.motion.q[i], coordinates(model, f + 20)[9], 1e-12) << f;
    EXPECT_EQ(result.motion.status[static_cast<std::size_t>(f)] == FrameStatus::no_markers,
              f >= 50 && f < 55);
    if (f >= 50 && f < 55) continue;
    EXPECT_EQ(result.motion.q_sd[i], 0.0) << f;
    EXPECT_TRUE(result.motion.determined[i]) << f;
  }
  EXPECT_LT(result.fit.rms_error_m, 0.006);
  EXPECT_THAT(result.fit.warnings,
              testing::Contains(HasSubstr("'elbow' follows the function of time that the model prescribes")));
  for (const char* absent : {"follows the function of time that the model prescribes"})
    EXPECT_THAT(solve_ik(body(), markers).value().fit.warnings,
                testing::Not(testing::Contains(HasSubstr(absent))));
}

TEST(SolveIk, ACoordinateThatFollowsAnotherIsNotPrescribed) {
  auto described = description();
  described.coordinates[12].prescribed = math::ScalarFunction::constant(1.0);  // the kneecap
  const auto model = model::Model::compile(described).value();
  const auto result = solve_ik(model, record(model, 20)).value();
  EXPECT_LT(largest_error(model, result), 1e-9) << "its coupling rules";
  EXPECT_THAT(result.fit.warnings, testing::Not(testing::Contains(HasSubstr("prescribes"))));
}

TEST(SolveIk, AFunctionWithoutAValueIsOneSentence) {
  auto described = description();
  described.coordinates[9].prescribed = math::ScalarFunction::polynomial({0.0, 1e308, 1e308, 1e308});
  const auto model = model::Model::compile(described).value();
  auto markers = record(body(), 5);
  markers.time.t0_s = 10.0;
  EXPECT_THAT(solve_ik(model, markers).error().message,
              HasSubstr("the function that prescribes coordinate 'elbow' has no finite value at 10 s"));
}

TEST(SolveIk, FindsTheFirstFrameFromAnyStartingPose) {
  Random random(11, 0);
  for (int trial = 0; trial < 20; ++trial) {
    auto moved = description();
    for (std::size_t c = 0; c < moved.coordinates.size(); ++c)
      moved.coordinates[c].default_value = c >= 3 && c < 6 ? random.uniform(-3, 3) : random.uniform(-2, 2);
    const auto model = model::Model::compile(moved).value();
    const auto result = solve_ik(model, record(model, 3)).value();
    EXPECT_LT(result.fit.max_error_m, 1e-8) << trial;
  }
}

TEST(SolveIk, ResultIsAMinimumOfTheStatedCost) {
  const auto model = body();
  const auto markers = record(model, 5, 0.01);
  IkOptions options;
  options.marker_weights = {{"T1", 5.0}, {"F2", 0.2}, {"S3", 0.0}};
  options.coordinate_tasks = {{.coordinate = "hip", .weight = 0.01, .value = 0.3},
                              {.coordinate = "list", .weight = 0.002}};
  const auto result = solve_ik(model, markers, options).value();
  const int n = model.coordinate_count();
  Eigen::MatrixXd q(5, n);
  for (int f = 0; f < 5; ++f)
    for (int c = 0; c < n; ++c) q(f, c) = result.motion.q[result.motion.index(f, c)];
  const double best = calc_ik_cost(model, markers, options, q).value();
  EXPECT_NEAR(best, result.cost, 1e-12);
  for (int c = 0; c + 1 < n; ++c)
    for (const double step : {1e-4, -1e-4}) {
      Eigen::MatrixXd other = q;
      other.col(c).array() += step;
      EXPECT_GT(calc_ik_cost(model, markers, options, other).value(), best) << c;
    }
  // The cost as OpenSim writes it, by hand for one frame.
  model::Workspace w(model);
  model::kinematics(model, w, model::state_from_coordinates(model, q.row(0).transpose()));
  double sum = 0.0, weights = 0.0;
  for (int m = 0; m < model.marker_count(); ++m) {
    const auto& name = markers.names[static_cast<std::size_t>(m)];
    const double weight = name == "T1" ? 5.0 : name == "F2" ? 0.2 : name == "S3" ? 0.0 : 1.0;
    sum += weight * (markers.x(0, m) - w.marker.col(m)).squaredNorm();
    weights += weight;
  }
  const double by_hand = sum / weights + 0.01 * std::pow(q(0, 10) - 0.3, 2) + 0.002 * q(0, 1) * q(0, 1);
  auto first = markers;
  first.time.frames = 1;
  first.x_in_world.resize(static_cast<std::size_t>(3 * model.marker_count()));
  first.state.resize(static_cast<std::size_t>(model.marker_count()));
  EXPECT_NEAR(calc_ik_cost(model, first, options, q.topRows(1)).value(), by_hand, 1e-15);
}

TEST(SolveIk, MissingMarkersInAnyPatternDoNotHurtWhatTheOthersFix) {
  const auto model = body();
  auto markers = record(model, 300);
  Random random(3, 0);
  for (std::int64_t f = 0; f < 300; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (random.uniform() < 0.4) markers.set_missing(f, m);
  const auto result = solve_ik(model, markers).value();
  EXPECT_LT(largest_error(model, result), 1e-6);
  EXPECT_GT(
      std::count(result.motion.status.begin(), result.motion.status.end(), FrameStatus::underdetermined), 10);
  for (std::size_t i = 0; i < result.motion.q.size(); ++i)
    EXPECT_EQ(std::isnan(result.motion.q_sd[i]), result.motion.determined[i] == 0);
}

TEST(SolveIk, ACoordinateWithoutMarkersIsNotDeterminedAndIsHeld) {
  const auto model = body();
  auto markers = record(model, 100);
  for (std::int64_t f = 40; f < 60; ++f)
    for (const char* name : {"F1", "F2"}) markers.set_missing(f, markers.find(name));
  const auto result = solve_ik(model, markers).value();
  const auto elbow = result.motion.find("elbow");
  for (std::int64_t f = 0; f < 100; ++f) {
    const bool hidden = f >= 40 && f < 60;
    EXPECT_EQ(result.motion.determined[result.motion.index(f, elbow)], hidden ? 0 : 1) << f;
    EXPECT_EQ(result.motion.status[static_cast<std::size_t>(f)],
              hidden ? FrameStatus::underdetermined : FrameStatus::converged);
    if (hidden) {
      EXPECT_NEAR(result.motion.q[result.motion.index(f, elbow)],
                  result.motion.q[result.motion.index(39, elbow)], 1e-6);
    }
  }
  EXPECT_LT(largest_error(model, result), 1e-8);
}

TEST(SolveIk, ATaskDoesNotMakeACoordinateDetermined) {
  const auto model = body();
  auto markers = record(model, 10);
  for (std::int64_t f = 0; f < 10; ++f)
    for (const char* name : {"F1", "F2"}) markers.set_missing(f, markers.find(name));
  IkOptions options;
  options.coordinate_tasks = {{.coordinate = "elbow", .weight = 10.0, .value = 0.25}};
  const auto result = solve_ik(model, markers, options).value();
  const auto elbow = result.motion.find("elbow");
  EXPECT_NEAR(result.motion.q[result.motion.index(5, elbow)], 0.25, 1e-9) << "the task places it";
  EXPECT_EQ(result.motion.determined[result.motion.index(5, elbow)], 0) << "but the markers do not know it";
  EXPECT_TRUE(std::isnan(result.motion.q_sd[result.motion.index(5, elbow)]));
}

TEST(SolveIk, FramesWithoutAnyMarkerAreHeldAndSaidSo) {
  const auto model = body();
  auto markers = record(model, 20);
  for (std::int64_t m = 0; m < markers.markers(); ++m)
    for (std::int64_t f : {0, 1, 9, 19}) markers.set_missing(f, m);
  const auto result = solve_ik(model, markers).value();
  for (std::int64_t f : {0, 1, 9, 19})
    EXPECT_EQ(result.motion.status[static_cast<std::size_t>(f)], FrameStatus::no_markers);
  EXPECT_EQ(result.motion.q[result.motion.index(9, 7)], result.motion.q[result.motion.index(8, 7)]);
  EXPECT_TRUE(result.motion.validate());
  EXPECT_LT(largest_error(model, result), 1e-8);
}

TEST(SolveIk, LimitsHoldAndLockedCoordinatesStay) {
  auto limited = description();
  limited.coordinates[9].range_max = 0.4;  // the elbow moves beyond
  limited.coordinates[10].locked = true;
  limited.coordinates[10].default_value = 0.123;
  const auto model = model::Model::compile(limited).value();
  const auto markers = record(body(), 300);
  const auto result = solve_ik(model, markers).value();
  double highest = -10.0;
  for (std::int64_t f = 0; f < 300; ++f) {
    highest = std::max(highest, result.motion.q[result.motion.index(f, 9)]);
    EXPECT_EQ(result.motion.q[result.motion.index(f, 10)], 0.123);
    EXPECT_EQ(result.motion.q_sd[result.motion.index(f, 10)], 0.0);
  }
  EXPECT_NEAR(highest, 0.4, 1e-12);
  const auto leaning = std::ranges::find(result.fit.findings, "elbow", &data::Finding::subject);
  ASSERT_NE(leaning, result.fit.findings.end());
  EXPECT_EQ(leaning->kind, data::FindingKind::at_limit);
  EXPECT_GT(leaning->size, 0.1);
  IkOptions free;
  free.limits = false;
  const auto beyond = solve_ik(model, markers, free).value();
  double top = -10.0;
  for (std::int64_t f = 0; f < 300; ++f) top = std::max(top, beyond.motion.q[beyond.motion.index(f, 9)]);
  EXPECT_GT(top, 0.5);
}

TEST(SolveIk, TheRootPassesThroughNinetyDegreesWithoutASingularity) {
  const auto model = body();
  auto markers = record(model, 100);
  model::Workspace w(model);
  Eigen::VectorXd q = coordinates(model, 0);
  for (std::int64_t f = 0; f < 100; ++f) {
    q[0] = 0.2;
    q[1] = 0.03 * static_cast<double>(f);  // the middle angle runs from 0 through 90 to 170 deg
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.x(f, m) = w.marker.col(m);
  }
  const auto result = solve_ik(model, markers).value();
  EXPECT_LT(result.fit.max_error_m, 1e-9);
  for (std::int64_t f = 0; f < 100; ++f)
    EXPECT_NEAR(result.motion.q[result.motion.index(f, 1)], 0.03 * static_cast<double>(f), 1e-7);
}

TEST(SolveIk, RobustLossesAndJudgedSamplesShrugOffAMarkerThatJumps) {
  const auto model = body();
  auto markers = record(model, 50, 0.001);
  for (std::int64_t f = 20; f < 30; ++f) markers.x(f, markers.find("U1")) += Eigen::Vector3d(0.0, 0.15, 0.1);
  const auto worst_in = [&](Loss loss, bool judged = false) {
    IkOptions options;
    options.judge_samples = judged;
    options.loss = loss;
    options.loss_scale_m = 0.005;
    const auto result = solve_ik(model, markers, options).value();
    double worst = 0.0;
    for (std::int64_t f = 20; f < 30; ++f)
      for (int c = 6; c < 10; ++c)
        worst =
            std::max(worst, std::abs(result.motion.q[result.motion.index(f, c)] - coordinates(model, f)[c]));
    return worst;
  };
  const double square = worst_in(Loss::square), huber = worst_in(Loss::huber),
               cauchy = worst_in(Loss::cauchy);
  EXPECT_GT(square, 0.15);
  EXPECT_LT(huber, 0.5 * square);
  EXPECT_LT(cauchy, 0.1 * square);
  EXPECT_LT(worst_in(Loss::square, true), 0.2 * square) << "the samples are left out";
}

TEST(SolveIk, ClosedLoopsClose) {
  // The hand holds the thigh: a point constraint between forearm and thigh.
  auto looped = description();
  const auto open_model = body();
  model::Workspace w(open_model);
  model::kinematics(open_model, w, model::state_from_coordinates(open_model, coordinates(open_model, 0)));
  const auto forearm = static_cast<std::size_t>(open_model.body_of(2)),
             thigh = static_cast<std::size_t>(open_model.body_of(3));
  const Eigen::Vector3d hand = w.position[forearm] + w.rotation[forearm] * Eigen::Vector3d(0, -0.3, 0);
  looped.point_constraints = {{.name = "hold",
                               .body_a_idx = 2,
                               .body_b_idx = 3,
                               .point_in_a = {0, -0.3, 0},
                               .point_in_b = w.rotation[thigh].transpose() * (hand - w.position[thigh])}};
  const auto model = model::Model::compile(looped).value();
  const auto markers = record(open_model, 30);  // the recording does not hold on: the loop must win
  const auto result = solve_ik(model, markers).value();
  EXPECT_LT(result.fit.max_loop_gap_m, 1e-9);
  EXPECT_GT(result.fit.max_error_m, 1e-3);
  for (const auto status : result.motion.status) EXPECT_EQ(status, FrameStatus::converged);
}

TEST(SolveIk, SameBitsForAnyNumberOfThreads) {
  const auto model = body();
  const auto markers = record(model, 150, 0.002);
  IkOptions options;
  const auto one = solve_ik(model, markers, options).value();
  for (const int threads : {2, 3, 0}) {
    options.threads = threads;
    const auto many = solve_ik(model, markers, options).value();
    EXPECT_EQ(one.motion.q, many.motion.q);
    EXPECT_EQ(one.motion.q_sd, many.motion.q_sd);
  }
}

TEST(SolveIk, MatchesNamesBehindASubjectPrefixAndListsWhatIsLeftOver) {
  const auto model = body();
  auto markers = record(model, 5);
  for (auto& name : markers.names) name = "Ann:" + name;
  markers.names[0] = "Ann:other";
  const auto result = solve_ik(model, markers).value();
  EXPECT_EQ(result.fit.markers.front().name_in_data, "Ann:T2");
  EXPECT_THAT(result.fit.excluded_as(data::kNotInRecording), ElementsAre("T1"));
  EXPECT_THAT(result.fit.excluded_as(data::kNotInModel), ElementsAre("Ann:other"));
  EXPECT_LT(largest_error(model, result), 1e-9);
}

TEST(SolveIk, AMarkerThatIsNeverSeenIsLeftOutAndSaid) {
  const auto model = body();
  auto markers = record(model, 5);
  for (std::int64_t f = 0; f < 5; ++f) markers.set_missing(f, 2);
  const auto result = solve_ik(model, markers).value();
  EXPECT_EQ(result.fit.excluded.size(), 1U);
  EXPECT_THAT(result.fit.excluded_as(data::kNeverSeen), ElementsAre("T3"));
}

TEST(SolveIk, AnUnseenMarkerOfWeightZeroIsCalledUnseenAndASeenOneIsNot) {
  const auto model = body();
  auto markers = record(model, 5);
  for (std::int64_t f = 0; f < 5; ++f) markers.set_missing(f, 2);
  IkOptions options;
  options.marker_weights = {{"T2", 0.0}, {"T3", 0.0}};
  const auto result = solve_ik(model, markers, options).value();
  EXPECT_EQ(result.fit.excluded.size(), 2U);
  EXPECT_THAT(result.fit.excluded_as(data::kNoWeight), ElementsAre("T2"));
  EXPECT_THAT(result.fit.excluded_as(data::kNeverSeen), ElementsAre("T3"));
}

std::string sentence(const data::Trajectories& markers, const IkOptions& options = {}) {
  const auto result = solve_ik(body(), markers, options);
  return result ? "" : result.error().message;
}

TEST(SolveIk, NamesThatDifferAreProposedAsAnOption) {
  auto described = description();
  described.markers[0].name = "R.Heel";
  described.markers[1].name = "L.Heel";
  const auto model = model::Model::compile(described).value();
  auto markers = record(model, 5);
  EXPECT_THAT(solve_ik(model, markers)->fit.warnings,
              testing::Not(testing::Contains(HasSubstr(" of the model, not in the recording, "))));
  markers.names[0] = "RHEE";
  EXPECT_THAT(
      solve_ik(model, markers)->fit.warnings,
      testing::Contains("1 marker of the model, not in the recording, may be there under another name: "
                        "--rename RHEE=R.Heel"));
  markers.names[1] = "Left Heel";
  EXPECT_THAT(
      solve_ik(model, markers)->fit.warnings,
      testing::Contains("2 markers of the model, not in the recording, may be there under other names: "
                        "--rename 'RHEE=R.Heel,Left Heel=L.Heel'"));
  // Of the other side, nothing.
  markers.names[0] = "LHEE";
  markers.names[1] = "T_one";
  EXPECT_THAT(solve_ik(model, markers)->fit.warnings,
              testing::Contains(HasSubstr("1 marker of the model, not in the recording, may be there under "
                                          "another name: --rename LHEE=L.Heel")));
  for (auto& name : markers.names) name += "_x";
  markers.names[0] = "RHEE";
  EXPECT_THAT(
      solve_ik(model, markers).error().message,
      testing::AllOf(HasSubstr("no marker in common"), testing::EndsWith("; likely: --rename RHEE=R.Heel")));
}

TEST(SolveIk, BadInputIsOneClearSentence) {
  const auto good = record(body(), 5);
  auto strangers = good;
  for (auto& name : strangers.names) name += "_x";
  EXPECT_THAT(sentence(strangers),
              testing::AllOf(HasSubstr("no marker in common"), HasSubstr("T1, T2"), HasSubstr("T1_x, T2_x")));
  auto millimetres = good;
  for (auto& x : millimetres.x_in_world) x *= 1000.0;
  EXPECT_THAT(sentence(millimetres), HasSubstr("wrong unit"));
  auto twice = good;
  twice.names[1] = "T1";
  EXPECT_THAT(sentence(twice), HasSubstr("'T1' occurs twice"));
  EXPECT_THAT(sentence(good, {.marker_weights = {{"T1", std::nan("")}}}),
              HasSubstr("weight of marker 'T1' is nan"));
  EXPECT_THAT(sentence(good, {.marker_weights = {{"nobody", 1.0}}}), HasSubstr("'nobody'"));
  EXPECT_THAT(sentence(good, {.coordinate_tasks = {{.coordinate = "tail"}}}), HasSubstr("'tail'"));
  EXPECT_THAT(sentence(good, {.coordinate_tasks = {{.coordinate = "hip", .values = {1.0}}}}),
              HasSubstr("1 values for 5 frames"));
  EXPECT_THAT(sentence(good, {.first_time_s = 10.0}), HasSubstr("no frame in the time range"));
  EXPECT_THAT(sentence(good, {.first_time_s = 10.0}), HasSubstr("from 10 s to the end"));
  EXPECT_THAT(sentence(good, {.default_marker_weight = 0.0}), HasSubstr("has the weight 0"));
  EXPECT_THAT(sentence(good, {.first_time_s = 2.0, .last_time_s = 1.0}), HasSubstr("empty"));
  auto blank = description();
  blank.markers.clear();
  EXPECT_THAT(solve_ik(model::Model::compile(blank).value(), good).error().message,
              HasSubstr("has no markers"));
}

TEST(SolveIk, TheCallerCanStopIt) {
  const auto model = body();
  const auto result =
      solve_ik(model, record(model, 2500), {}, [](std::int64_t, std::int64_t) { return false; });
  EXPECT_EQ(result.error().code, Code::cancelled);
}

TEST(SolveIk, TheTimeRangeSelectsFrames) {
  const auto model = body();
  const auto result = solve_ik(model, record(model, 100), {.first_time_s = 0.2, .last_time_s = 0.5}).value();
  EXPECT_EQ(result.fit.first_frame, 20);
  EXPECT_EQ(result.motion.frames(), 31);
  EXPECT_DOUBLE_EQ(result.motion.time.t0_s, 0.2);
}

TEST(FrameSolver, AllocatesNothingPerFrame) {
  if (!testing_support::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const bool looped : {false, true}) {
    auto described = description();
    if (looped) described.point_constraints = {{.name = "hold", .body_a_idx = 2, .body_b_idx = 3}};
    const auto model = model::Model::compile(described).value();
    const auto markers = record(model, 20, 0.003);
    IkOptions options;
    options.coordinate_tasks = {{.coordinate = "hip", .weight = 0.01},
                                {.coordinate = "list", .weight = 0.01}};
    const auto problem = internal::make_problem(model, markers, options).value();
    internal::FrameSolver solver(problem, options);
    Eigen::Matrix3Xd y(3, model.marker_count());
    Eigen::VectorXd weight(model.marker_count()), x = problem.model.default_state();
    for (std::int64_t f = 0; f < 20; ++f) {
      const auto before = testing_support::allocations_on_this_thread();
      problem.observe(markers, f, y, weight);
      solver.solve(y, weight, f, x);
      EXPECT_EQ(testing_support::allocations_on_this_thread(), before) << f;
    }
  }
}

}  // namespace
}  // namespace kinemark::motion
