// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/swings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/gait/belt.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using testing::KnownWalk;

GaitPaths smoothed_at_first(const data::Trajectories& markers) {
  return GaitSmoother::create(markers, find_gait_markers(markers).value(), 0.0).value().paths();
}

TEST(Swings, GroundMovesOnATreadmillAlone) {
  KnownWalk walk;
  for (const bool treadmill : {false, true}) {
    walk.treadmill = treadmill;
    const auto paths = smoothed_at_first(walk.markers(0.0003, 3));
    const auto ground = ground_velocity(paths);
    EXPECT_LT(ground.sd, 0.02);
    EXPECT_NEAR(ground.velocity.norm(), treadmill ? walk.speed_m_per_s : 0.0, 0.02);
    const auto belt = belt_velocity(paths, find_steps(paths, ground.velocity), ground);
    EXPECT_NEAR(belt.velocity.norm(), treadmill ? walk.speed_m_per_s : 0.0, 0.005);
    EXPECT_EQ(belt_velocity(paths, {}, ground).velocity, ground.velocity);
    // From near it, the same.
    EXPECT_NEAR((ground_velocity(paths, ground.velocity).velocity - ground.velocity).norm(), 0.0, 1e-3);
  }
}

TEST(Swings, ThereIsOneForEachStepOfTheWalker) {
  for (const bool treadmill : {false, true}) {
    KnownWalk walk;
    walk.treadmill = treadmill;
    const auto paths = smoothed_at_first(walk.markers(0.0003, 3));
    const auto steps = find_steps(paths, ground_velocity(paths).velocity);
    EXPECT_NEAR(steps.stride_s, walk.stride_s, 0.02);
    for (const Side side : data::kBothSides) {
      int offs = 0, strikes = 0, truth_offs = 0, truth_strikes = 0;
      for (const auto& swing : steps.foot(side).swings) {
        offs += swing.leaves.has_value(), strikes += swing.lands.has_value();
        if (swing.leaves && swing.lands) {
          EXPECT_LT(*swing.leaves, *swing.lands);
        }
      }
      for (const auto& event : walk.events())
        if (event.side == side) ++(event.what == FootEvent::off ? truth_offs : truth_strikes);
      EXPECT_NEAR(offs, truth_offs, 1);  // one may lie at an end
      EXPECT_NEAR(strikes, truth_strikes, 1);
    }
  }
}

TEST(Swings, AFootThatMovesByLessThanEightCentimetresDoesNotSwing) {
  auto markers = KnownWalk{}.markers(0.001, 3);
  for (std::int64_t f = 1; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      markers.x(f, m) = markers.x(0, m) + 5e-3 * (markers.x(f, m) - markers.x(0, m));
  const auto paths = smoothed_at_first(markers);
  const auto steps = find_steps(paths, ground_velocity(paths).velocity);
  EXPECT_TRUE(steps.feet[0].swings.empty() && steps.feet[1].swings.empty());
}

TEST(Swings, AGapIsCrossedStraightAndItsEndsAreThoseSeen) {
  auto markers = KnownWalk{}.markers(0.0003, 3);
  for (std::int64_t f = 200; f < 330; ++f) markers.set_missing(f, 0), markers.set_missing(f, 1);
  for (std::int64_t f = 0; f < 40; ++f) markers.set_missing(f, 1);  // LTOE
  const auto paths = smoothed_at_first(markers);
  const auto steps = find_steps(paths, Eigen::RowVector2d(0.0, 0.0));
  const auto& foot = steps.foot(Side::left);
  EXPECT_EQ(foot.seen.first, 40);
  EXPECT_EQ(foot.speed[210], foot.speed[320]);
  EXPECT_NEAR(foot.speed[250], 1.3, 0.6);  // as fast as the body in the mean
}

// Two feet for four seconds at 100 Hz: the left one goes at a speed that falls to nothing within `falls_s`
// and swings from 2 to 2.5 s at 1.5 m/s; the right one stands.
GaitPaths beginning(double speed_m_per_s, double falls_s) {
  constexpr std::int64_t kFrames = 400;
  GaitPaths out{.rate_hz = 100.0, .start_s = 0.0, .feet = {}, .pelvis = math::SeriesMatrix::Zero(kFrames, 3)};
  for (auto& foot : out.feet) {
    foot.heel = foot.toe = math::SeriesMatrix::Zero(kFrames, 3);
    foot.known.assign(static_cast<std::size_t>(kFrames), true);
  }
  double way = 0.0;
  for (std::int64_t f = 0; f < kFrames; ++f) {
    const double t = 0.01 * static_cast<double>(f);
    const double swing = t > 2.0 && t < 2.5 ? 1.5 * std::sin(M_PI * (t - 2.0) / 0.5) : 0.0;
    way += 0.01 * (swing + speed_m_per_s * std::max(0.0, 1.0 - t / falls_s));
    out.feet[0].heel(f, 0) = out.feet[0].toe(f, 0) = way;
  }
  return out;
}

TEST(Swings, AFootThatRollsWhereTheRecordingBeginsDidNotSwing) {
  const auto swings = [](double speed_m_per_s) {
    return find_steps(beginning(speed_m_per_s, 0.3), {0.0, 0.0}).foot(Side::left).swings;
  };
  const auto rolls = swings(0.25), lands = swings(1.2);
  ASSERT_EQ(rolls.size(), 1u);
  EXPECT_NEAR(static_cast<double>(rolls[0].peak), 225.0, 2.0);
  ASSERT_EQ(lands.size(), 2u) << "of four fifths of the other swing";
  EXPECT_FALSE(lands[0].leaves.has_value());
  ASSERT_TRUE(lands[0].lands.has_value());
  EXPECT_NEAR(0.01 * static_cast<double>(*lands[0].lands), 0.3 * (1.0 - kStands * 1.5 / 1.2), 0.03);
}

TEST(Swings, SlopesAreCentral) {
  math::SeriesMatrix x(5, 1);
  x << 0.0, 1.0, 4.0, 9.0, 16.0;
  const auto v = slopes(x, 10.0);
  EXPECT_DOUBLE_EQ(v(0, 0), 10.0);
  EXPECT_DOUBLE_EQ(v(2, 0), 40.0);
  EXPECT_DOUBLE_EQ(v(4, 0), 70.0);
}

TEST(Swings, CutOffGoesWithThePace) {
  EXPECT_DOUBLE_EQ(cut_off_of(1.0), 10.0);
  EXPECT_DOUBLE_EQ(cut_off_of(2.4), 6.0);
  EXPECT_DOUBLE_EQ(cut_off_of(0.3), 25.0);
}

}  // namespace
}  // namespace kinemark::analysis
