// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/kinematic_events.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using testing::KnownWalk;

GaitPaths paths_of(const data::Trajectories& markers) {
  return GaitSmoother::create(markers, find_gait_markers(markers.names).value(), 0.0).value().paths();
}

// Found and missed of the walker's events between 0.5 s and half a second before the end; the largest error.
struct Score {
  int found = 0, missed = 0;
  double worst_s = 0.0;
};
Score score(const KnownWalk& walk, const GaitPaths& paths, FootEvent what, EventMethod method) {
  Score out;
  const std::array<FootSwings, 2> swings{find_swings(paths, Side::left), find_swings(paths, Side::right)};
  const auto ground = ground_velocity(paths, swings).velocity;
  for (const auto& event : walk.events()) {
    if (event.what != what || event.time_s < 0.5 || event.time_s > walk.duration_s - 0.5) continue;
    double best = 1.0;
    for (const double frame :
         find_in_windows(paths, event.side, what, method, swings[data::index_of(event.side)], ground))
      if (const double d = std::abs(paths.time_s(frame) - event.time_s); d < best) best = d;
    best < 0.15 ? ++out.found : ++out.missed;
    if (best < 0.15) out.worst_s = std::max(out.worst_s, best);
  }
  return out;
}

TEST(KinematicEvents, EveryMethodFindsEveryEventOverGroundAndOnATreadmill) {
  for (const bool treadmill : {false, true})
    for (const auto method : kEventMethods)
      for (const auto what : data::kFootEvents) {
        KnownWalk walk;
        walk.treadmill = treadmill;
        const auto result = score(walk, paths_of(walk.markers(0.0003, 3)), what, method);
        const auto where = std::string(to_string(method)) + " " + std::string(data::to_string(what));
        EXPECT_GE(result.found, 8) << where;
        EXPECT_EQ(result.missed, 0) << where << " treadmill " << treadmill;
        EXPECT_LT(result.worst_s, 0.1) << where;
      }
}

TEST(KinematicEvents, PreferredMethodsAreWithinTwentyMilliseconds) {
  for (const double rate : {60.0, 100.0, 240.0}) {
    KnownWalk walk;
    walk.rate_hz = rate;
    const auto paths = paths_of(walk.markers(0.0005, 10));
    EXPECT_LT(score(walk, paths, FootEvent::strike, EventMethod::foot_velocity).worst_s, 0.02) << rate;
    EXPECT_LT(score(walk, paths, FootEvent::off, EventMethod::coordinates).worst_s, 0.02) << rate;
  }
}

TEST(KinematicEvents, DoNotDependOnHowTheLaboratoryStands) {
  const KnownWalk walk;
  auto markers = walk.markers(0.0003, 7);
  const auto upright = paths_of(markers);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const Eigen::Vector3d x = markers.x(f, m);
      markers.x(f, m) = Eigen::Vector3d(x.y(), x.z(), x.x());  // y up
    }
  const auto turned = paths_of(markers);
  const std::array<FootSwings, 2> swings{find_swings(upright, Side::left), find_swings(upright, Side::right)};
  const std::array<FootSwings, 2> again{find_swings(turned, Side::left), find_swings(turned, Side::right)};
  for (const auto method : kEventMethods) {
    const auto a = find_in_windows(upright, Side::left, FootEvent::strike, method, swings[0],
                                   ground_velocity(upright, swings).velocity),
               b = find_in_windows(turned, Side::left, FootEvent::strike, method, again[0],
                                   ground_velocity(turned, again).velocity);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      if (std::isfinite(a[i])) EXPECT_NEAR(a[i], b[i], 1e-6);
  }
}

TEST(KinematicEvents, GroundMovesOnATreadmillAlone) {
  KnownWalk walk;
  for (const bool treadmill : {false, true}) {
    walk.treadmill = treadmill;
    const auto paths = paths_of(walk.markers(0.0003, 3));
    const auto ground =
        ground_velocity(paths, {find_swings(paths, Side::left), find_swings(paths, Side::right)});
    EXPECT_LT(ground.sd, 0.01);
    EXPECT_NEAR(ground.velocity.norm(), treadmill ? walk.speed_m_per_s : 0.0, 0.005);
  }
}

TEST(KinematicEvents, WhoStandsDoesNotStep) {
  KnownWalk walk;
  auto markers = walk.markers(0.001, 3);
  for (std::int64_t f = 1; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      markers.x(f, m) = markers.x(0, m) + 1e-3 * (markers.x(f, m) - markers.x(0, m));
  const auto paths = paths_of(markers);
  EXPECT_EQ(find_swings(paths, Side::left).cycle, 0.0);
  EXPECT_TRUE(find_swings(paths, Side::left).of(FootEvent::strike).empty());
}

TEST(KinematicEvents, WhatWasNotSeenHasNone) {
  const KnownWalk walk;
  auto markers = walk.markers(0.0003, 3);
  for (std::int64_t f = 200; f < 330; ++f) markers.set_missing(f, 0);  // LHEE
  const auto paths = paths_of(markers);
  const std::array<FootSwings, 2> swings{find_swings(paths, Side::left), find_swings(paths, Side::right)};
  for (const auto method : kEventMethods)
    for (const double frame : find_in_windows(paths, Side::left, FootEvent::strike, method, swings[0],
                                              ground_velocity(paths, swings).velocity))
      EXPECT_FALSE(frame > 211.0 && frame < 319.0) << to_string(method);
}

TEST(GaitSmoother, RefusesWhatCannotBeMeasured) {
  KnownWalk walk;
  auto markers = walk.markers(0.0003, 3);
  const auto which = find_gait_markers(markers.names).value();
  auto slow = markers;
  slow.time.rate_hz = 10.0;
  EXPECT_EQ(GaitSmoother::create(slow, which, 0.0).error().message,
            "10 frames a second are too few for events of walking; need 20");
  for (std::int64_t f = 5; f < markers.frames(); ++f) markers.set_missing(f, 3);
  EXPECT_EQ(GaitSmoother::create(markers, which, 0.0).error().message,
            "RTOE was measured in 5 frames; need 20 at least");
}

TEST(GaitSmoother, APelvisMarkerThatIsNeverSeenStandsForNothing) {
  auto markers = KnownWalk{}.markers(0.0003, 3);
  for (std::int64_t f = 0; f < markers.frames(); ++f) markers.set_missing(f, 4);  // SACR
  const auto which = find_gait_markers(markers.names).value();
  EXPECT_NE(GaitSmoother::create(markers, which, 0.0).error().message.find("which way is up"),
            std::string::npos);
  auto more = data::Trajectories::all_missing({"LHEE", "LTOE", "RHEE", "RTOE", "SACR", "CLAV"}, markers.time);
  for (std::int64_t f = 0; f < more.frames(); ++f)
    for (std::int64_t m = 0; m < 6; ++m) {
      if (m == 4) continue;
      more.x(f, m) = m == 5 ? Eigen::Vector3d(markers.x(f, 0) + Eigen::Vector3d(0, 0, 1.4))
                            : Eigen::Vector3d(markers.x(f, m));
      more.state[more.index(f, m)] = data::SampleState::measured;
    }
  const auto smoother = GaitSmoother::create(more, find_gait_markers(more.names).value(), 0.0);
  ASSERT_TRUE(smoother);
  EXPECT_EQ(smoother->paths().pelvis.rows(), 0);
}

TEST(GaitSmoother, NoiseIsThatOfItsNumberAndSmall) {
  const KnownWalk walk;
  const auto markers = walk.markers(0.001, 3);
  const auto smoother = GaitSmoother::create(markers, find_gait_markers(markers.names).value(), 0.0).value();
  const auto a = smoother.with_noise(1, 4), b = smoother.with_noise(1, 4), c = smoother.with_noise(1, 5);
  EXPECT_EQ(a.feet[0].heel, b.feet[0].heel);
  const auto difference = a.feet[0].heel - smoother.paths().feet[0].heel;
  const double rms = std::sqrt(difference.squaredNorm() / static_cast<double>(difference.size()));
  EXPECT_GT((a.feet[0].heel - c.feet[0].heel).norm(), 0.0);
  EXPECT_NEAR(rms, 0.0004, 0.0001);  // of 1 mm, what a 7 Hz low-pass at 100 Hz leaves
}

}  // namespace
}  // namespace kinemark::analysis
