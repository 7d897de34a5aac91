// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/kinematic_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
