// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Exercise machines, on which nobody goes anywhere, and people who stand before, between and after walks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/marker_events.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;

MarkerEvents events_of(const data::Trajectories& markers) {
  const auto which = find_gait_markers(markers).value();
  auto smoother = GaitSmoother::create(markers, which, 0.0).value();
  return find_marker_events(smoother, which).value();
}
GaitKind kind_of(const data::Trajectories& markers) { return events_of(markers).kind; }

// Somebody whose feet are led by a machine: each goes on an ellipse, half a turn after the other, and
// pitches.
struct Machine {
  double along_m = 0.17, up_m = 0.17;  // half axes
  double turns_per_s = 1.2;            // backwards below
  double pitch_rad = 0.2, pitch_late = 0.5;
  double sway_m = 0.01;    // of the pelvis, to the sides
  double travels_m = 0.0;  // of the pelvis, along: a rower
  double saddle_m = 0.95;  // height of the pelvis
  double second = 0.0;     // share of a second harmonic
  double noise_m = 0.0005, rate_hz = 100.0, duration_s = 8.0, heading_rad = 0.4;

  [[nodiscard]] data::Trajectories markers(std::uint64_t seed) const {
    Random random(seed, 0x6d616368);
    auto out = data::Trajectories::all_missing(
        {"LHEE", "LTOE", "RHEE", "RTOE", "SACR"},
        {.rate_hz = rate_hz, .frames = static_cast<std::int64_t>(std::llround(duration_s * rate_hz))});
    const auto put = [&](std::int64_t f, std::int64_t m, double along, double left, double up) {
      const double c = std::cos(heading_rad), s = std::sin(heading_rad);
      const Eigen::Vector3d x(c * along - s * left, s * along + c * left, up);
      for (int axis = 0; axis < 3; ++axis) out.x(f, m)[axis] = x[axis] + noise_m * random.gaussian();
      out.state[out.index(f, m)] = data::SampleState::measured;
    };
    for (std::int64_t f = 0; f < out.frames(); ++f) {
      const double turn = 2.0 * std::numbers::pi * turns_per_s * out.time.time_s(f);
      for (const std::int64_t foot : {0, 1}) {
        const double at = turn + (foot == 1 ? std::numbers::pi : 0.0);
        const double pitch = pitch_rad * std::sin(at + pitch_late) - 0.1, line = foot == 0 ? 0.1 : -0.1;
        const double x = along_m * (std::sin(at) + second * std::sin(2.0 * at)),
                     z = 0.3 + up_m * (std::cos(at) + second * std::cos(2.0 * at));
        put(f, 2 * foot, x - 0.18 * std::cos(pitch), line, z - 0.18 * std::sin(pitch));
        put(f, 2 * foot + 1, x, line, z);
      }
      put(f, 4, travels_m * std::sin(turn) - 0.2, sway_m * std::sin(turn), saddle_m + 0.3 * up_m);
    }
    return out;
  }
};

TEST(Machines, PedalsAreNoBelt) {
  Random random(11, 2);
  for (int k = 0; k < 60; ++k) {
    Machine machine{.turns_per_s = random.uniform(0.7, 2.0),
                    .pitch_rad = random.uniform(0.0, 0.4),
                    .pitch_late = random.uniform(-3.0, 3.0),
                    .sway_m = random.uniform(0.0, 0.04),
                    .noise_m = k % 2 == 0 ? 0.003 : 0.0005,
                    .rate_hz = k % 5 == 0 ? 50.0 : 100.0};
    if (k % 3 == 0) {  // cranks, of children and adults
      machine.along_m = machine.up_m = random.uniform(0.07, 0.18);
    } else {  // elliptical trainers, backwards too, on paths that are no pure ellipses
      machine.along_m = random.uniform(0.2, 0.3), machine.up_m = machine.along_m * random.uniform(0.25, 0.5);
      if (k % 3 == 1) machine.second = random.uniform(-0.1, 0.1), machine.turns_per_s *= -1.0;
    }
    const auto kind = kind_of(machine.markers(static_cast<std::uint64_t>(k) + 1));
    EXPECT_THAT(kind.not_gait,
                HasSubstr("the feet go round as on pedals: where they go back, their velocity turns at "))
        << k << " " << kind.sentence();
  }
}

TEST(Machines, FeetThatRiseAndFallOrStayAreNoGait) {
  Random random(12, 2);
  for (int k = 0; k < 20; ++k) {
    Machine stepper{.along_m = random.uniform(0.0, 0.03),
                    .up_m = random.uniform(0.05, 0.15),
                    .turns_per_s = random.uniform(0.5, 1.5),
                    .pitch_rad = random.uniform(0.0, 0.2)};
    EXPECT_NE(kind_of(stepper.markers(static_cast<std::uint64_t>(k) + 1)).not_gait, "") << k;
    const Machine rower{.along_m = 0.0,
                        .up_m = 0.0,
                        .turns_per_s = random.uniform(0.3, 0.7),
                        .pitch_rad = 0.1,
                        .travels_m = random.uniform(0.2, 0.4)};
    EXPECT_NE(kind_of(rower.markers(static_cast<std::uint64_t>(k) + 1)).not_gait, "") << k;
  }
}

// Two stances in 10 mm of noise do not tell a belt from pedals; a circle is one even then.
TEST(Machines, FewStancesAccuseNobody) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    KnownWalk walk;
    walk.treadmill = true, walk.duration_s = 1.9, walk.rate_hz = 60.0;
    EXPECT_THAT(
        kind_of(walk.markers(0.01, seed)).not_gait,
        Not(HasSubstr("the feet go round as on pedals: where they go back, their velocity turns at ")))
        << seed;
    EXPECT_THAT(kind_of(Machine{.duration_s = 1.7}.markers(seed)).not_gait,
                HasSubstr("the feet go round as on pedals: where they go back, their velocity turns at "))
        << seed;
  }
}

// Slow and fast, noisy and on few frames: who walks on a belt is on no pedals.
TEST(Machines, BeltsAreNoPedals) {
  Random random(13, 2);
  for (int k = 0; k < 40; ++k) {
    auto walk = KnownWalk::draw(random);
    walk.treadmill = true, walk.rate_hz = k % 2 == 0 ? 50.0 : 100.0;
    if (k % 4 == 0) walk.speed_m_per_s = random.uniform(0.4, 0.8), walk.stride_s = 1.5;
    const auto kind = kind_of(walk.markers(k % 3 == 0 ? 0.005 : 0.0005, static_cast<std::uint64_t>(k) + 1));
    EXPECT_THAT(
        kind.not_gait,
        Not(HasSubstr("the feet go round as on pedals: where they go back, their velocity turns at ")))
        << k;
    EXPECT_TRUE(kind.belt && kind.not_gait.empty()) << k << kind.not_gait;
    EXPECT_LT(kind.arc, 0.1) << k;
  }
}

// A walk held still for seconds at its times, which need not be in step.
data::Trajectories standing(const data::Trajectories& walk,
                            const std::vector<std::pair<double, double>>& at_for_s) {
  auto out = walk;
  std::vector<std::int64_t> of;
  for (std::int64_t f = 0; f < walk.frames(); ++f) {
    of.push_back(f);
    for (const auto& [at_s, for_s] : at_for_s)
      if (f == std::llround(at_s * walk.time.rate_hz) ||
          (f == walk.frames() - 1 && at_s > walk.time.time_s(f)))
        of.insert(of.end(), static_cast<std::size_t>(std::llround(for_s * walk.time.rate_hz)), f);
  }
  out = data::Trajectories::all_missing(
      walk.names, {.rate_hz = walk.time.rate_hz, .frames = static_cast<std::int64_t>(of.size())});
  Random random(9, 1);
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t m = 0; m < walk.markers(); ++m) {
      out.x(f, m) = Eigen::Vector3d(walk.x(of[static_cast<std::size_t>(f)], m)) +
                    0.0003 * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

TEST(Standing, BeforeAndAfterAWalkIsNoPartOfIt) {
  for (const bool treadmill : {false, true}) {
    KnownWalk walk;
    walk.treadmill = treadmill, walk.duration_s = 4.0;
    const auto alone = walk.markers(0.0, 3);
    for (const auto& stands : std::vector<std::vector<std::pair<double, double>>>{
             {{0.0, 4.0}, {99.0, 4.0}}, {{0.0, 4.0}}, {{99.0, 6.0}}}) {
      const auto gait = analyze_gait(standing(alone, stands), {}, {.refits = 0});
      ASSERT_TRUE(gait) << gait.error().message;
      EXPECT_EQ(gait->kind.not_gait, "");
      EXPECT_EQ(gait->kind.belt, treadmill);
      EXPECT_EQ(gait->kind.manner, GaitManner::walk);
      EXPECT_FALSE(gait->kind.turning || gait->kind.brief);
      EXPECT_NEAR(gait->kind.speed_m_per_s, 1.3, 0.06);  // held in the middle of a step
      EXPECT_NEAR(gait->kind.stride_s, 1.08, 0.03);
      for (const auto& cycle : gait->cycles) EXPECT_NEAR(cycle.end_s - cycle.start_s, 1.08, 0.1);
    }
  }
}

TEST(Standing, BetweenPassesTurnsAndRunsIsNoPartOfThem) {
  // There, a stand, and back: the second pass is the first one turned about.
  const auto there = KnownWalk{.duration_s = 4.0}.markers(0.0, 3);
  auto both = standing(there, {{0.0, 3.0}, {99.0, 8.0}});
  const auto n = both.frames();
  for (std::int64_t f = n - 400; f < n; ++f)
    for (std::int64_t m = 0; m < both.markers(); ++m) {
      const Eigen::Vector3d x = there.x(f - (n - 400), m), end = there.x(399, 4);
      both.x(f, m) = Eigen::Vector3d(2.0 * end.x() - x.x(), 2.0 * end.y() - x.y() + 0.5, x.z());
    }
  const auto kind = kind_of(both);
  EXPECT_EQ(kind.not_gait, "");
  EXPECT_FALSE(kind.belt);
  EXPECT_TRUE(kind.turning);
  EXPECT_EQ(kind.direction, GaitDirection::forward);
  EXPECT_NEAR(kind.speed_m_per_s, 1.3, 0.05);
  // Standing alone is none.
  const auto stands =
      kind_of(standing(KnownWalk{.duration_s = 0.2}.markers(0.0, 3), {{0.0, 4.0}, {99.0, 4.0}}));
  EXPECT_NE(stands.not_gait, "");
}

// Cut to less than a stride: what is said of it is true of the 1.08 s that it lasts.
TEST(Strides, AreSaidWhereOneWasSeenWhole) {
  int unseen = 0;
  for (double duration = 0.6; duration < 2.4; duration += 0.1)
    for (const double first : {-0.3, 0.0, 0.4, 0.7}) {
      const auto markers = KnownWalk{.duration_s = duration, .first_strike_s = first}.markers(0.0003, 3);
      const auto gait = analyze_gait(markers, {}, {.refits = 0});
      if (!gait) continue;
      if (std::isfinite(gait->kind.longer_than_s)) {
        ++unseen;
        EXPECT_LT(gait->kind.longer_than_s, 1.08) << duration << " " << first;
        EXPECT_THAT(gait->kind.sentence(), HasSubstr("no stride seen whole"));
      } else {
        EXPECT_NEAR(gait->kind.stride_s, 1.08, 0.05) << duration << " " << first;
        EXPECT_THAT(gait->kind.sentence(), HasSubstr("strides of 1."));
      }
    }
  EXPECT_GT(unseen, 5);
}

}  // namespace
}  // namespace kinemark::analysis
