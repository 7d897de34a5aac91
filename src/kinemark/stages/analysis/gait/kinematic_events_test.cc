// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/kinematic_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinemark/stages/analysis/gait/swings.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using testing::KnownWalk;

GaitPaths first_paths(const data::Trajectories& markers) {
  return GaitSmoother::create(markers, find_gait_markers(markers).value(), 0.0).value().paths();
}

struct EdgesIn {
  GaitPaths paths;
  Ground ground;
  Steps steps;
  std::vector<SwingEdge> edges;
};
EdgesIn edges_in(const data::Trajectories& markers) {
  EdgesIn out{.paths = first_paths(markers)};
  out.ground = ground_velocity(out.paths);
  out.steps = find_steps(out.paths, out.ground.velocity);
  out.edges =
      find_edges(out.paths, out.steps, out.ground.velocity, progress_of(out.paths, out.ground.velocity));
  return out;
}

TEST(KinematicEvents, EveryDetectorFindsEveryEventOverGroundAndOnATreadmill) {
  for (const bool treadmill : {false, true}) {
    KnownWalk walk;
    walk.treadmill = treadmill;
    const auto found = edges_in(walk.markers(0.0003, 3));
    for (const auto& event : walk.events()) {
      if (event.time_s < 0.5 || event.time_s > walk.duration_s - 0.5) continue;
      const auto edge = std::ranges::find_if(found.edges, [&](const SwingEdge& one) {
        return one.side == event.side && one.what == event.what &&
               std::abs(found.paths.time_s(one.frame) - event.time_s) < 0.15;
      });
      ASSERT_NE(edge, found.edges.end()) << event.time_s;
      EXPECT_TRUE(edge->seen && !edge->at_gap && !edge->at_end);
      for (const double after : edge->after_s) EXPECT_LT(std::abs(after), 0.15);
    }
  }
}

/// Means over walkers, at every strike or leaving: how a foot stands and moves, smoothed.
struct FootMoves {
  double pitch = 0.0, pitch_rate = 0.0, toe_up_m = 0.0;
  Eigen::Vector2d heel{0.0, 0.0}, toe{0.0, 0.0};  // m/s, forward and up
};
void add_moves(const KnownWalk& walk, const GaitPaths& paths, FootEvent what, std::vector<FootMoves>& out) {
  const Eigen::RowVector3d way(std::cos(walk.heading_rad), std::sin(walk.heading_rad), 0.0);
  for (const auto& event : walk.events()) {
    if (event.what != what || event.time_s < 0.5 || event.time_s > walk.duration_s - 0.5) continue;
    const auto& foot = paths.foot(event.side);
    const auto f = static_cast<std::int64_t>(std::llround(event.time_s * walk.rate_hz));
    const auto moves = [&](const math::SeriesMatrix& x) {
      const Eigen::RowVector3d v = 0.5 * walk.rate_hz * (x.row(f + 1) - x.row(f - 1));
      return Eigen::Vector2d(v.dot(way), v.z());
    };
    const auto pitch = [&](std::int64_t frame) {
      const Eigen::RowVector3d along = foot.toe.row(frame) - foot.heel.row(frame);
      return std::atan2(along.z(), along.head<2>().norm()) + 0.005 / walk.foot_m;  // 0: flat
    };
    out.push_back({.pitch = pitch(f),
                   .pitch_rate = 0.5 * walk.rate_hz * (pitch(f + 1) - pitch(f - 1)),
                   .toe_up_m = foot.toe(f, 2) - 0.03,
                   .heel = moves(foot.heel),
                   .toe = moves(foot.toe)});
  }
}
FootMoves mean_moves(FootEvent what) {
  std::vector<FootMoves> all;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed, 11);
    const auto walk = KnownWalk::draw(random);
    auto smoother =
        GaitSmoother::create(walk.markers(0.0003, seed), find_gait_markers(walk.markers(0.0, 1)).value(), 0.0)
            .value();
    EXPECT_TRUE(smoother.smooth_at(cut_off_of(walk.stride_s)));
    add_moves(walk, smoother.paths(), what, all);
  }
  FootMoves out;
  const auto n = static_cast<double>(all.size());
  for (const auto& one : all) {
    out.pitch += one.pitch / n, out.pitch_rate += one.pitch_rate / n, out.toe_up_m += one.toe_up_m / n;
    out.heel += one.heel / n, out.toe += one.toe / n;
  }
  return out;
}

// Mean and SD of feet of nine laboratories at the instants of their plates, smoothed alike:
// docs/theory/gait.md.
TEST(KnownWalks, MoveTheirFeetAtStrikesAndLeavingsAsFeetOnPlatesDo) {
  const auto strike = mean_moves(FootEvent::strike), off = mean_moves(FootEvent::off);
  EXPECT_NEAR(strike.pitch, 0.27, 0.07);
  EXPECT_NEAR(strike.pitch_rate, -4.0, 1.1);
  EXPECT_NEAR(strike.heel.x(), 0.21, 0.10);
  EXPECT_NEAR(strike.heel.y(), -0.06, 0.06);
  EXPECT_NEAR(strike.toe.y(), -0.79, 0.23);
  EXPECT_NEAR(off.pitch, -1.09, 0.13);
  EXPECT_NEAR(off.pitch_rate, -5.2, 1.8);
  EXPECT_NEAR(off.toe_up_m, 0.020, 0.009);
  EXPECT_NEAR(off.heel.x(), 2.09, 0.46);
  EXPECT_NEAR(off.heel.y(), 1.05, 0.23);
  EXPECT_NEAR(off.toe.x(), 1.17, 0.44);
  EXPECT_NEAR(off.toe.y(), 0.50, 0.19);
}

TEST(KinematicEvents, ProgressIsThatOfTheBodyOverTheGround) {
  for (const bool treadmill : {false, true}) {
    KnownWalk walk;
    walk.treadmill = treadmill;
    const auto found = edges_in(walk.markers(0.0003, 3));
    const auto progress = progress_of(found.paths, found.ground.velocity);
    EXPECT_NEAR(std::atan2(progress.direction(300, 1), progress.direction(300, 0)), 0.4, 0.02);
    EXPECT_NEAR(progress.velocity.row(300).norm(), 1.3, 0.1);
  }
}

TEST(KinematicEvents, ThereIsNoTellingWhereTheFootIsNotSeen) {
  const KnownWalk walk;
  auto markers = walk.markers(0.0003, 3);
  for (std::int64_t f = 200; f < 330; ++f) markers.set_missing(f, 0), markers.set_missing(f, 1);
  const auto found = edges_in(markers);
  for (const auto& edge : found.edges)
    EXPECT_FALSE(edge.side == Side::left && edge.seen && edge.frame > 200.0 && edge.frame < 329.0)
        << edge.frame;
  // The other foot keeps all of its own.
  int right = 0;
  for (const auto& edge : found.edges) right += edge.side == Side::right && edge.seen;
  EXPECT_GE(right, 9);
}

TEST(KinematicEvents, EdgesAtAnEndOrAGapAreMarked) {
  const KnownWalk walk;
  const auto markers = walk.markers(0.0003, 3);
  const auto whole = edges_in(markers);
  const auto strike = std::ranges::find_if(whole.edges, [](const SwingEdge& one) {
    return one.side == Side::left && one.what == FootEvent::strike && one.frame > 150.0;
  });
  auto cut = markers;
  const auto from = static_cast<std::int64_t>(strike->frame) + 4;
  for (std::int64_t f = from; f < from + 40; ++f) cut.set_missing(f, 0);
  const auto again = edges_in(cut);
  const auto beside = std::ranges::find_if(again.edges, [&](const SwingEdge& one) {
    return one.side == Side::left && one.what == FootEvent::strike &&
           std::abs(one.frame - strike->frame) < 3.0;
  });
  ASSERT_NE(beside, again.edges.end());
  EXPECT_TRUE(beside->at_gap);
  EXPECT_FALSE(strike->at_gap);
}

TEST(KinematicEvents, OnTheSamePathsTheyAreTheSameAgain) {
  const auto found = edges_in(KnownWalk{}.markers(0.0003, 3));
  const auto again = find_edges_again(found.paths, found.steps, found.ground.velocity, found.edges);
  ASSERT_EQ(again.size(), found.edges.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].side, found.edges[i].side);
    EXPECT_NEAR(again[i].frame, found.edges[i].frame, 1e-9);
    for (std::size_t k = 0; k < kDetectors; ++k)
      if (std::isfinite(found.edges[i].after_s[k])) {
        EXPECT_NEAR(again[i].after_s[k], found.edges[i].after_s[k], 1e-9);
      }
  }
}

}  // namespace
}  // namespace kinemark::analysis
