// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/tasks.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing_body::angle_rms;
using testing_body::record;

model::Model body() { return model::Model::compile(testing_body::description()).value(); }

TEST(Track, FollowsCleanMarkersToTheTrueAngles) {
  const auto model = body();
  const auto markers = record(model, 150);
  const auto result = track_markers(model, markers);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LT(angle_rms(model, result->motion), 1e-3);
  EXPECT_LT(result->fit.rms_error_m, 5e-4);
  EXPECT_EQ(result->flagged_frames, 0);
  EXPECT_EQ(result->restarts, 0);
  EXPECT_TRUE(result->locked_coordinates.empty());
  EXPECT_TRUE(result->undetermined_coordinates.empty());
  EXPECT_EQ(result->free_speeds, 12);
  EXPECT_EQ(result->rank, std::vector<int>(150, 12));
  EXPECT_THAT(result->fit.findings, IsEmpty());
  EXPECT_THAT(result->fit.warnings, IsEmpty());
  EXPECT_THAT(result->fit.excluded, IsEmpty());
  EXPECT_TRUE(result->motion.validate());
  for (const auto status : result->motion.status) EXPECT_EQ(status, data::FrameStatus::converged);
}

TEST(Track, WithNoiseItIsAsGoodAsLeastSquaresOnTheSameGoals) {
  const auto model = body();
  const auto markers = record(model, 300, 1e-3, 4);
  const auto goals = control_goals(markers).value();
  const auto ik = solve_ik(model, goals, {.error_bars = false}).value();
  const auto track = track_markers(model, markers, {.step_s = 1e-3}).value();
  EXPECT_LT(angle_rms(model, track.motion), 1.02 * angle_rms(model, ik.motion));
  EXPECT_LT(track.rms_goal_error_m, 0.7e-3);
}

/// Sentence of the failure, or "" when there was none.
std::string refusal(const model::Model& model, const data::Trajectories& markers,
                    const TrackOptions& options) {
  const auto result = track_markers(model, markers, options);
  return result ? std::string() : result.error().message;
}

TEST(Track, BoundsHoldWhereTheyAreGivenAndNoneIsGivenElsewhere) {
  const auto model = body();
  const auto markers = record(model, 200, 1e-3, 9);
  const std::vector<std::vector<TrackLevel>> cases{
      {},
      {{.markers = {"T1", "T2", "T3", "T4"}}, {.markers = {"*"}}},
      {{.markers = {"T1", "F2"}}, {.markers = {"S2"}}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto track =
        track_markers(model, markers,
                      {.levels = cases[i], .strict = true, .step_s = 2e-3, .lock = LockMode::off})
            .value();
    const auto& motion = track.motion;
    std::int64_t bounded = 0;
    for (std::int64_t f = 20; f < 180; ++f) {
      const Eigen::VectorXd q = testing_body::coordinates(model, f);
      for (std::int64_t c = 6; c < motion.size(); ++c) {
        const auto at = motion.index(f, c);
        EXPECT_EQ(std::isnan(motion.q_bound[at]), motion.determined[at] == 0);
        EXPECT_EQ(std::isnan(motion.q_sd[at]), motion.determined[at] == 0);
        if (std::isnan(motion.q_bound[at])) continue;
        ++bounded;
        EXPECT_LE(std::abs(motion.q[at] - q[c]), motion.q_bound[at]) << i << ' ' << f << ' ' << c;
      }
    }
    if (i < 2) {
      EXPECT_EQ(bounded, 160 * 7);
      EXPECT_EQ(track.rank[100], 12);
    } else {
      EXPECT_EQ(track.rank[100], 9);
      EXPECT_LT(bounded, 40);  // three markers fix hardly anything of this body
      EXPECT_EQ(track.undetermined_coordinates.size(), 13U);
      EXPECT_EQ(motion.status[100], data::FrameStatus::underdetermined);
    }
  }
}

TEST(Track, DeviationsCoverTheTruth) {
  const auto model = body();
  const auto track = track_markers(model, record(model, 400, 1e-3, 3), {.step_s = 2e-3}).value();
  const auto& motion = track.motion;
  std::int64_t inside = 0, all = 0;
  for (std::int64_t f = 30; f < 370; ++f) {
    const Eigen::VectorXd q = testing_body::coordinates(model, f);
    for (std::int64_t c = 6; c < motion.size(); ++c, ++all)
      inside += std::abs(motion.q[motion.index(f, c)] - q[c]) <= 2.0 * motion.q_sd[motion.index(f, c)];
  }
  const double share = static_cast<double>(inside) / static_cast<double>(all);
  EXPECT_GT(share, 0.90);
  EXPECT_LT(share, 0.995);
}

TEST(Track, AMarkerThatVanishesAndReturnsLeavesNoJump) {
  const auto model = body();
  const auto markers = record(model, 200, 1e-3, 5);
  const auto whole = track_markers(model, markers, {.step_s = 2e-3}).value().motion;
  for (const std::int64_t m : {3, 7, 12}) {
    auto gappy = markers;
    for (std::int64_t f = 80; f < 130; ++f) gappy.set_missing(f, m);
    const auto track = track_markers(model, gappy, {.step_s = 2e-3}).value().motion;
    for (std::int64_t f = 60; f < 150; ++f)
      for (std::int64_t c = 6; c < track.size(); ++c) {
        const double jump = (track.q[track.index(f, c)] - track.q[track.index(f - 1, c)]) -
                            (whole.q[whole.index(f, c)] - whole.q[whole.index(f - 1, c)]);
        EXPECT_LT(std::abs(jump), 0.5 * 0.01745) << m << ' ' << f << ' ' << c;
      }
  }
}

// F2 is the only marker that the elbow moves. After half a second without it the forearm is anywhere.
TEST(Track, AMarkerThatAloneMovesACoordinateReturnsWithoutAJerk) {
  auto description = testing_body::description();
  std::erase_if(description.markers, [](const auto& m) { return m.name == "F1"; });
  const auto model = model::Model::compile(std::move(description)).value();
  auto markers = record(model, 200, 1e-3, 5);
  for (std::int64_t f = 80; f < 130; ++f) markers.set_missing(f, markers.find("F2"));
  const auto track = track_markers(model, markers, {.step_s = 2e-3}).value();
  const auto& motion = track.motion;
  const auto elbow = motion.find("elbow");
  const auto at = [&](std::int64_t f) { return motion.index(f, elbow); };
  const double off = std::abs(motion.q[at(130)] - testing_body::coordinates(model, 130)[9]);
  ASSERT_GT(off, 0.1);
  double most = 0.0;
  for (std::int64_t f = 130; f < 150; ++f) most = std::max(most, std::abs(motion.qdd[at(f)]));
  EXPECT_LT(most, 15.0 * off / (0.1 * 0.1));  // a pull of omega = 100 / s begins with 100 times off / 0.1^2
  EXPECT_NEAR(motion.q[at(150)], testing_body::coordinates(model, 150)[9], 0.02);
  // Undetermined in the gap; on the way back the deviation says how far there is to go.
  for (std::int64_t f = 82; f < 128; ++f) EXPECT_EQ(motion.determined[at(f)], 0) << f;
  std::int64_t on_the_way = 0;
  for (std::int64_t f = 130; f < 150; ++f) {
    if (motion.determined[at(f)] == 0) continue;
    const double miss = std::abs(motion.q[at(f)] - testing_body::coordinates(model, f)[9]);
    EXPECT_LE(miss, motion.q_bound[at(f)]) << f;
    EXPECT_LE(miss, 5.0 * motion.q_sd[at(f)]) << f;
    on_the_way += miss > 0.05;
  }
  EXPECT_GT(on_the_way, 2);
}

TEST(Track, EquationSixteenHoldsForExactGoalsAtEveryLevel) {
  const auto model = body();
  const auto markers = record(model, 120);
  const std::vector<std::vector<TrackLevel>> cases{
      {}, {{.markers = {"T1", "T2", "T3", "T4"}}, {.markers = {"U1", "U2", "H1"}}, {.markers = {"*"}}}};
  for (const auto& levels : cases) {
    const auto track = track_markers(model, markers,
                                     {.levels = levels,
                                      .strict = true,
                                      .step_s = 2e-3,
                                      .settle = false,
                                      .cutoff_hz = 0.0,
                                      .lock = LockMode::off,
                                      .marker_noise_sd_m = 1e-9})
                           .value();
    const auto& motion = track.motion;
    ASSERT_EQ(track.goal_bound.size(), motion.q.size());
    double largest = 0.0;
    for (std::int64_t f = 2; f < 118; ++f) {
      const Eigen::VectorXd q = testing_body::coordinates(model, f);
      for (std::int64_t c = 6; c < motion.size(); ++c) {
        const auto i = motion.index(f, c);
        const double miss = std::abs(motion.q[i] - q[c]);
        largest = std::max(largest, miss);
        EXPECT_LE(miss, 1.001 * track.goal_bound[i] + 1e-7) << levels.size() << ' ' << f << ' ' << c;
        // Equation 15 without the norms of equation 16 is never wider.
        EXPECT_LE(motion.q_bound[i], track.goal_bound[i] + 1e-6);
        EXPECT_GE(motion.q_bound[i], 0.0);
      }
    }
    EXPECT_GT(largest, 1e-7);
  }
}

TEST(Track, HoldsWhatNoMarkerMoves) {
  const auto model = body();
  auto description = testing_body::description();
  std::erase_if(description.markers, [](const auto& m) { return m.name[0] == 'F'; });  // none on the forearm
  const auto less = model::Model::compile(std::move(description)).value();
  const auto track = track_markers(less, record(model, 100), {.step_s = 2e-3}).value();
  EXPECT_EQ(track.locked_coordinates, std::vector<std::string>{"elbow"});
  EXPECT_EQ(track.free_speeds, 11);
  const auto elbow = track.motion.find("elbow");
  for (std::int64_t f = 0; f < 100; ++f) {
    EXPECT_EQ(track.motion.q[track.motion.index(f, elbow)], 0.0);
    EXPECT_EQ(track.motion.determined[track.motion.index(f, elbow)], 0);
  }
}

TEST(Track, FramesAreSettledOnTheBestFitOfTheirGoals) {
  const auto model = body();
  // Markers that no pose fits: each 20 mm off, and more than the speed of the body can hide.
  auto markers = record(model, 120, 2e-3, 8);
  for (std::int64_t f = 0; f < 120; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) markers.x(f, m)[m % 3] += m % 2 == 0 ? 0.02 : -0.02;
  const auto goals = control_goals(markers).value();
  const auto ik = solve_ik(model, goals, {.judge_samples = false, .error_bars = false}).value();
  const auto distance = [&](const TrackOptions& options) {
    const auto track = track_markers(model, markers, options).value();
    EXPECT_EQ(track.flagged_frames, 0);
    double most = 0.0;
    for (std::int64_t f = 0; f < 120; ++f)
      for (std::int64_t c = 6; c < track.motion.size(); ++c)
        most = std::max(
            most, std::abs(track.motion.q[track.motion.index(f, c)] - ik.motion.q[ik.motion.index(f, c)]));
    return most;
  };
  EXPECT_LT(distance({.settle = true, .judge_samples = false}), 1e-5);
  EXPECT_LT(distance({.omega_rad_s = 40.0, .step_s = 0.01, .settle = true, .judge_samples = false}), 1e-5)
      << "one step per frame";
  EXPECT_GT(distance({.settle = false, .judge_samples = false}), 1e-3) << "the law alone lags";
}

TEST(Track, EquationFifteenIsTheDistanceToTheGoalsOfALaggingBody) {
  const auto model = body();
  const auto markers = record(model, 150);
  const auto track =
      track_markers(model, markers,
                    {.settle = false, .feed_forward = false, .cutoff_hz = 0.0, .judge_samples = false})
          .value();
  double most = 0.0;
  for (std::int64_t f = 30; f < 150; ++f) {
    const Eigen::VectorXd q = testing_body::coordinates(model, f);
    for (std::int64_t c = 6; c < track.motion.size(); ++c) {
      const auto i = track.motion.index(f, c);
      const double way = q[c] - track.motion.q[i];
      most = std::max(most, std::abs(way));
      EXPECT_NEAR(track.goal_error[i], way, 0.1 * std::abs(way) + 2e-3) << f << ' ' << c;
      EXPECT_LE(std::abs(way), 1.05 * track.goal_bound[i] + 2e-3) << f << ' ' << c;
    }
  }
  EXPECT_GT(most, 0.02) << "it lags by degrees";
}

TEST(Track, ABodyThatLostItsGoalsSaysSoAndIsBackWithinAFifthOfASecond) {
  const auto model = body();
  auto markers = record(model, 200);
  // The subject leaves the volume, and comes back turned round.
  const Eigen::AngleAxisd half(3.0, Eigen::Vector3d::UnitY());
  for (std::int64_t f = 80; f < 200; ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      if (f < 100)
        markers.set_missing(f, m);
      else
        markers.x(f, m) = half * Eigen::Vector3d(markers.x(f, m)) + Eigen::Vector3d(2.0, 0.0, 1.0);
    }
  for (const double step_s : {1e-3, 1e-2}) {
    const auto track =
        track_markers(
            model, markers,
            {.omega_rad_s = step_s > 5e-3 ? 40.0 : 100.0, .step_s = step_s, .marker_noise_sd_m = 1e-3})
            .value();
    EXPECT_LT(angle_rms(model, track.motion, 121), 2e-3) << step_s;
    for (std::int64_t f = 100; f < 121; ++f) {
      double off = 0.0;
      const Eigen::VectorXd q = testing_body::coordinates(model, f);
      for (std::int64_t c = 6; c < track.motion.size(); ++c)
        off = std::max(off, std::abs(track.motion.q[track.motion.index(f, c)] - q[c]));
      if (off > 0.2) {
        EXPECT_NE(track.motion.status[static_cast<std::size_t>(f)], data::FrameStatus::converged)
            << step_s << ' ' << f << ' ' << off;
      }
    }
    for (std::int64_t f = 121; f < 200; ++f)
      EXPECT_EQ(track.motion.status[static_cast<std::size_t>(f)], data::FrameStatus::converged) << f;
  }
}

TEST(Track, BadSamplesAreLeftOutNamedAndDoNoHarm) {
  const auto model = body();
  const auto markers = record(model, 120, 0.5e-3, 3);
  const TrackOptions judging;
  const auto clean = track_markers(model, markers, judging).value();
  const TrackOptions believing{.judge_samples = false};
  EXPECT_EQ(clean.motion.q, track_markers(model, markers, believing)->motion.q)
      << "a clean recording gives the same bits";
  auto bad = markers;
  bad.x(60, 6) += Eigen::Vector3d(0.2, -0.1, 0.1);
  const auto judged = track_markers(model, bad, judging).value();
  const auto believed = track_markers(model, bad, believing).value();
  const auto off = [&](const TrackResult& track) {
    double most = 0.0;
    for (std::size_t i = 0; i < clean.motion.q.size(); ++i)
      most = std::max(most, std::abs(track.motion.q[i] - clean.motion.q[i]));
    return most;
  };
  EXPECT_LT(off(judged), 0.02);
  EXPECT_GT(off(believed), 0.04);
  ASSERT_EQ(judged.fit.findings.size(), 1U);
  EXPECT_EQ(judged.fit.findings[0].kind, data::FindingKind::outlier);
  EXPECT_EQ(judged.fit.findings[0].subject, markers.names[6]);
  EXPECT_EQ(judged.fit.findings[0].first_frame, 60);
  EXPECT_EQ(judged.fit.markers[6].rejected_frames, 1);
  const auto at = static_cast<std::size_t>(60 * markers.markers() + 6);
  EXPECT_EQ(judged.motion.marker_state[at], data::SampleState::rejected);
  EXPECT_TRUE(std::isnan(judged.motion.marker_error[3 * at]));
  EXPECT_TRUE(believed.motion.marker_state.empty());
  EXPECT_GT(judged.motion.q_sd[judged.motion.index(60, 9)], clean.motion.q_sd[clean.motion.index(60, 9)])
      << "a sample less: a wider deviation";
}

TEST(Track, TorquesDoTheWork) {
  const auto model = body();
  const auto motion = track_markers(model, record(model, 100), {.step_s = 2e-3}).value().motion;
  // Rates belong to the coordinates: v by central differences of q, a of v.
  for (std::int64_t f = 20; f < 80; ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto rate = [&](const Array<double>& x) {
        return 50.0 * (x[motion.index(f + 1, c)] - x[motion.index(f - 1, c)]);
      };
      EXPECT_NEAR(rate(motion.q), motion.qd[motion.index(f, c)], 0.01) << c;
      EXPECT_NEAR(rate(motion.qd), motion.qdd[motion.index(f, c)], 0.15) << c;
    }
  // The vertical force of the root carries the weight on average.
  const auto ty = motion.find("ty");
  double sum = 0.0;
  for (std::int64_t f = 0; f < 100; ++f) sum += motion.tau[motion.index(f, ty)];
  EXPECT_NEAR(sum / 100.0, 6.0 * 9.81, 20.0);
  EXPECT_TRUE(std::isnan(motion.tau[motion.index(5, motion.find("kneecap_angle"))]));
}

TEST(Track, TheTimeRangeIsKept) {
  const auto model = body();
  const auto markers = record(model, 200);
  const auto track = track_markers(model, markers, {.first_time_s = 0.5, .last_time_s = 1.2}).value();
  EXPECT_EQ(track.fit.first_frame, 50);
  EXPECT_EQ(track.motion.frames(), 71);
  EXPECT_NEAR(track.motion.q[track.motion.index(30, 9)], testing_body::coordinates(model, 80)[9], 2e-3);
}

TEST(Track, StopsWhenAsked) {
  const auto model = body();
  const auto stopped = track_markers(model, record(model, 300), {}, [](auto, auto) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
}

TEST(Track, FrameWithoutMarkersAreMarkedAndTheBodyStaysSane) {
  const auto model = body();
  auto markers = record(model, 200);
  for (std::int64_t f = 80; f < 120; ++f)
    for (std::int64_t m = 0; m < 14; ++m) markers.set_missing(f, m);
  const auto track = track_markers(model, markers, {.step_s = 2e-3}).value();
  EXPECT_EQ(track.motion.status[100], data::FrameStatus::no_markers);
  EXPECT_EQ(track.rank[100], 0);
  EXPECT_EQ(track.restarts, 0);
  EXPECT_NEAR(track.motion.q[track.motion.index(180, 9)], testing_body::coordinates(model, 180)[9], 2e-3);
}

TEST(Track, ABlankStretchIsAFailureAndNoPerfectFit) {
  const auto model = body();
  auto markers = record(model, 200);
  for (std::int64_t f = 80; f < 120; ++f)
    for (std::int64_t m = 0; m < 14; ++m) markers.set_missing(f, m);
  const std::string blank = refusal(model, markers, {.first_time_s = 0.85, .last_time_s = 1.15});
  EXPECT_THAT(blank, HasSubstr("no tracked marker is seen between 0.85 and 1.15 s"));
  EXPECT_THAT(blank, Not(HasSubstr("seen in enough frames in a row to be followed")));
  // One frame alone cannot be followed either.
  markers.x(100, 3) = Eigen::Vector3d(0.1, 0.2, 0.3);
  markers.state[markers.index(100, 3)] = data::SampleState::measured;
  EXPECT_THAT(refusal(model, markers, {.first_time_s = 0.85, .last_time_s = 1.15}),
              HasSubstr("no tracked marker is seen in enough frames in a row to be followed between"));
  EXPECT_EQ(refusal(model, markers, {.first_time_s = 0.5, .last_time_s = 1.15}), "");
}

TEST(Track, ACoordinateAtItsLimitIsDeterminedAllTheSame) {
  auto description = testing_body::description();
  for (auto& c : description.coordinates)
    if (c.name == "elbow") c.range_max = 0.5;  // the recorded elbow goes to 1.2 rad
  const auto limited = model::Model::compile(std::move(description)).value();
  const auto track =
      track_markers(limited, record(body(), 200), {.step_s = 2e-3, .marker_noise_sd_m = 1e-3}).value();
  const auto& motion = track.motion;
  const auto elbow = motion.find("elbow");
  std::int64_t at_limit = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    const auto* determined = motion.determined.data() + motion.index(f, 0);
    const bool all = std::all_of(determined, determined + motion.size(), [](auto d) { return d != 0; });
    EXPECT_EQ(motion.status[static_cast<std::size_t>(f)],
              all ? data::FrameStatus::converged : data::FrameStatus::underdetermined)
        << f;
    at_limit += all && std::abs(motion.q[motion.index(f, elbow)] - 0.5) < 1e-6;
  }
  EXPECT_GT(at_limit, 10);
}

TEST(Track, TheSmallestPivotIsSaidOnlyWhenItIsComputed) {
  const auto model = body();
  auto markers = record(model, 60);
  for (std::int64_t f = 20; f < 40; ++f)
    for (std::int64_t m = 0; m < 14; ++m) markers.set_missing(f, m);
  const auto fast = track_markers(model, markers, {.error_bars = false}).value();
  const auto bars = track_markers(model, markers).value();
  EXPECT_TRUE(std::isnan(fast.smallest_singular[10]));
  EXPECT_EQ(fast.smallest_singular[30], 0.0);
  EXPECT_GT(bars.smallest_singular[10], 0.03);
  EXPECT_EQ(bars.smallest_singular[30], 0.0);
}

TEST(Track, AGoalThatDoesNotSayHowSureItIsGivesNoDeviation) {
  const auto model = body();
  const TimeBase time{.rate_hz = 100.0, .t0_s = 0.0, .frames = 40};
  const auto track =
      track_markers(
          model, record(model, 40),
          {.levels = {{.markers = {"T1", "T2", "T3", "T4", "U1", "U2", "H1", "H2", "S1", "S2", "S3"},
                       .tasks = {coordinate_task("elbow", {0.4}, time)}}},
           .marker_noise_sd_m = 1e-3})
          .value();
  const auto& motion = track.motion;
  const auto elbow = motion.index(20, motion.find("elbow")), knee = motion.index(20, motion.find("knee"));
  EXPECT_EQ(motion.determined[elbow], 1);
  EXPECT_TRUE(std::isnan(motion.q_sd[elbow]));
  EXPECT_TRUE(std::isfinite(motion.q_bound[elbow]));
  EXPECT_EQ(motion.determined[knee], 1);
  EXPECT_GT(motion.q_sd[knee], 0.0);
}

TEST(Track, GoalsOutOfReachAreFlaggedAndNeverAnExplosion) {
  const auto model = body();
  auto markers = record(model, 120);
  for (std::int64_t f = 50; f < 60; ++f)
    for (std::int64_t m = 0; m < 7; ++m) markers.x(f, m) += Eigen::Vector3d(40.0, -30.0, 5.0);
  const auto track =
      track_markers(model, markers, {.step_s = 2e-3, .judge_samples = false, .marker_noise_sd_m = 1e-3})
          .value();
  EXPECT_GT(track.flagged_frames, 5);
  EXPECT_EQ(track.motion.status[55], data::FrameStatus::not_converged);
  EXPECT_EQ(track.motion.status[110], data::FrameStatus::converged);
  ASSERT_EQ(track.fit.findings.size(), 1U);
  EXPECT_EQ(track.fit.findings[0].kind, data::FindingKind::flagged);
  EXPECT_EQ(track.fit.findings[0].size, static_cast<double>(track.flagged_frames));
  EXPECT_THAT(track.fit.findings[0].detail,
              HasSubstr("the goals were out of reach, or the body ran away and was started anew ("));
  for (const double v : track.motion.qd) ASSERT_LT(std::abs(v), 2e3);
  EXPECT_NEAR(track.motion.q[track.motion.index(115, 9)], testing_body::coordinates(model, 115)[9], 5e-3);
}

TEST(Track, GoalsThatTheModelCannotReachAreApproached) {
  const auto model = body();
  auto markers = record(model, 100);
  // A hand 0.25 m further off than the arm is long: below what is flagged.
  for (std::int64_t f = 0; f < 100; ++f)
    for (const char* name : {"F1", "F2"}) markers.x(f, markers.find(name)).y() -= 0.25;
  const auto track = track_markers(model, markers, {.step_s = 2e-3}).value();
  EXPECT_EQ(track.restarts, 0);
  EXPECT_EQ(track.flagged_frames, 0);
  EXPECT_GT(track.max_goal_error_m, 0.02);
  for (const double v : track.motion.qd) ASSERT_LT(std::abs(v), 100.0);
}

TEST(Track, SaysWhatIsWrong) {
  const auto model = body();
  const auto markers = record(model, 5);
  auto strangers = markers;
  for (auto& name : strangers.names) name = "X" + name;
  EXPECT_THAT(refusal(model, strangers, {}), HasSubstr("no marker in common"));
  EXPECT_THAT(refusal(model, markers, {.levels = {{.markers = {"T1"}}, {}}}),
              HasSubstr("level 2 has no tasks"));
  EXPECT_THAT(refusal(model, markers, {.levels = {{.markers = {"T1"}}, {.markers = {"T1"}}}}),
              HasSubstr("'T1' is named in level 1 and again in level 2"));
  EXPECT_THAT(refusal(model, markers, {.levels = {{.markers = {"nose"}}}}),
              HasSubstr("level 1 names marker 'nose', which the model does not have"));
  EXPECT_THAT(refusal(model, markers, {.step_s = 0.01}), HasSubstr("unstable for the step"));
  EXPECT_THAT(refusal(model, markers, {.step_s = 1e-9}), HasSubstr("more than 100000 steps"));
  EXPECT_THAT(refusal(model, markers, {.kp = 100.0}), HasSubstr("give both"));
  EXPECT_THAT(refusal(model, markers, {.omega_rad_s = -1.0}), HasSubstr("omega is -1"));
  for (const double cutoff : {1e-300, 1e-6, 0.119})
    EXPECT_THAT(refusal(model, markers, {.cutoff_hz = cutoff}),
                HasSubstr("Hz; it must be 0 (none) or at least 0.12 Hz"));
  EXPECT_TRUE(TrackOptions{.cutoff_hz = 0.12}.check());
  EXPECT_TRUE(TrackOptions{.cutoff_hz = 0.0}.check());
  EXPECT_THAT(refusal(model, markers, {.damping = std::nan("")}), HasSubstr("damping is nan"));
  EXPECT_THAT(refusal(model, markers, {.posture_kp = 1e9}), HasSubstr("posture's gains are unstable"));
  EXPECT_THAT(refusal(model, markers, {.rest_pose = {{.coordinate = "wing"}}}), HasSubstr("'wing'"));
  EXPECT_THAT(refusal(model, markers, {.locked = {"wing"}}), HasSubstr("'wing'"));
  EXPECT_THAT(refusal(model, markers, {.locked = {"tx"}}), HasSubstr("cannot be locked"));
  EXPECT_THAT(refusal(model, markers, {.first_time_s = 0.04}), HasSubstr("one frame"));
}

TEST(Track, SaysWhyAMarkerIsNotTracked) {
  const auto model = body();
  auto markers = record(model, 20);
  for (std::int64_t f = 0; f < 20; ++f) markers.set_missing(f, markers.find("F1"));
  const auto track =
      track_markers(model, markers,
                    {.levels = {{.markers = {"T1", "T2", "T3", "F1", "F2"}}}, .error_bars = false})
          .value();
  EXPECT_THAT(track.fit.warnings,
              Contains("marker 'F1' of level 1 is not in the recording, never seen, or weighs 0"));
  EXPECT_THAT(track.fit.warnings,
              Each(Not(HasSubstr("marker 'F2' of level 1 is not in the recording, never"))));
  EXPECT_THAT(track.fit.excluded_as("in no level"), Contains("T4"));
  EXPECT_THAT(track.fit.excluded_as("its body is welded to the ground"), IsEmpty());
}

TEST(Track, NeedsMassesAndMarkersThatCanMove) {
  auto massless = testing_body::description();
  for (auto& b : massless.bodies) {
    b.mass = 0.0;
    b.inertia_about_com.setZero();
  }
  const auto markers = record(body(), 5);
  EXPECT_THAT(refusal(model::Model::compile(std::move(massless)).value(), markers, {}),
              HasSubstr("no mass behind"));

  auto welded = testing_body::description();
  welded.bodies.push_back({.name = "plate", .mass = 1.0, .inertia_about_com = Eigen::Matrix3d::Identity()});
  welded.joints.push_back({.name = "bolt", .child_body_idx = 6});
  welded.markers[0].body_idx = 6;
  const auto model = model::Model::compile(std::move(welded)).value();
  EXPECT_THAT(refusal(model, markers, {.levels = {{.markers = {"T1"}}, {.markers = {"*"}}}}),
              HasSubstr("marker 'T1' sits on a body that is welded to the ground"));
  const auto track = track_markers(model, markers, {.error_bars = false});
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->fit.markers.size(), 13U);
  EXPECT_THAT(track->fit.warnings,
              ElementsAre("marker 'T1' sits on a body that is welded to the ground and is left out"));
  EXPECT_THAT(track->fit.excluded_as("its body is welded to the ground"), ElementsAre("T1"));
}

}  // namespace
}  // namespace kinemark::motion
