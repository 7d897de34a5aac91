// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/marker_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::Side;
using testing::KnownWalk;

struct Stated {
  MarkerEvents found;
  std::vector<std::string> sentences;
  [[nodiscard]] bool says(std::string_view words) const {
    return std::ranges::any_of(sentences,
                               [&](const auto& one) { return one.find(words) != std::string::npos; });
  }
};
Stated tell(const data::Trajectories& markers) {
  const auto which = find_gait_markers(markers).value();
  auto smoother = GaitSmoother::create(markers, which, 0.0).value();
  Stated out{.found = find_marker_events(smoother, which).value()};
  out.sentences = findings_of(smoother, out.found);
  return out;
}

// Of the walker's events away from the ends: how many have one of the markers within 0.1 s.
int found_of(const KnownWalk& walk, const MarkerEvents& found, Side side, int& all) {
  int out = 0;
  for (const auto& event : walk.events()) {
    if (event.side != side || event.time_s < 0.15 || event.time_s > walk.duration_s - 0.15) continue;
    ++all;
    out += std::ranges::any_of(found.events, [&](const data::GaitEvent& one) {
      return one.side == side && one.what == event.what && std::abs(one.time_s - event.time_s) < 0.1;
    });
  }
  return out;
}

TEST(MarkerEvents, EveryEventIsFoundAtAnyRateAndNoise) {
  for (const double rate : {25.0, 60.0, 100.0, 240.0, 1000.0})
    for (const double noise : {0.0002, 0.005}) {
      KnownWalk walk;
      walk.rate_hz = rate;
      const auto stated = tell(walk.markers(noise, 3));
      int all = 0;
      for (const Side side : data::kBothSides) {
        int of_side = 0;
        EXPECT_EQ(found_of(walk, stated.found, side, of_side), of_side) << rate << " Hz " << noise;
        all += of_side;
      }
      EXPECT_NEAR(static_cast<double>(stated.found.events.size()), all, 3.0) << rate << " Hz " << noise;
    }
}

TEST(MarkerEvents, NothingIsSaidOfACleanWalk) {
  EXPECT_TRUE(tell(KnownWalk{}.markers(0.0003, 3)).sentences.empty());
}

TEST(MarkerEvents, HowDetectorsUsuallyLieApartIsCommonAndOwnIsWhatAnEventAdds) {
  const auto usual_walk = tell(KnownWalk{}.markers(0.0003, 3)).found;
  KnownWalk slow;
  slow.stride_s = 2.4;
  slow.speed_m_per_s = 0.3;
  const auto found = tell(slow.markers(0.0003, 3)).found;
  for (const auto what : data::kFootEvents) {
    const auto worst = [what](const MarkerEvents& of, auto part) {
      double out = 0.0;
      for (std::size_t i = 0; i < of.events.size(); ++i)
        if (of.events[i].what == what && !of.edges[i].at_end) out = std::max(out, part(of.fused[i].error));
      return out;
    };
    const auto kind = [](const data::EventError& error) { return error.kind_s; };
    const auto own = [](const data::EventError& error) { return error.own_s; };
    // All steps of the slow walk are alike: the detectors contradict each other in the same way in each.
    EXPECT_GT(worst(found, kind), 1.2 * worst(usual_walk, kind));
    EXPECT_LT(worst(found, own), 0.5 * worst(found, kind));
  }
}

TEST(MarkerEvents, AHiddenFootIsSaidAndTheOtherKeepsItsEvents) {
  const KnownWalk walk;
  auto markers = walk.markers(0.0003, 3);
  for (std::int64_t f = 120; f < 360; ++f)
    for (const std::int64_t m : {0, 1}) markers.set_missing(f, m);
  const auto stated = tell(markers);
  EXPECT_TRUE(stated.says("left foot: hidden from 1.20 to 3.59 s, events there cannot be found"));
  EXPECT_FALSE(stated.says("right foot"));
  int all = 0;
  EXPECT_EQ(found_of(walk, stated.found, Side::right, all), all);
}

TEST(MarkerEvents, AFootHeldStillIsSaid) {
  auto markers = KnownWalk{}.markers(0.0003, 3);
  for (std::int64_t f = 121; f < 360; ++f)
    for (const std::int64_t m : {2, 3}) markers.x(f, m) = Eigen::Vector3d(markers.x(120, m));
  const auto stated = tell(markers);
  EXPECT_TRUE(stated.says("right foot: a marker is held still")) << stated.sentences.size();
  EXPECT_TRUE(stated.says("right foot: hidden from 1.21 to 3.59 s"));
}

TEST(MarkerEvents, LeapsAreCountedAndCostNoEvent) {
  const KnownWalk walk;
  auto markers = walk.markers(0.0003, 3);
  for (std::int64_t f = 40; f < markers.frames(); f += 150) markers.x(f, 0).x() += 0.3;
  const auto stated = tell(markers);
  EXPECT_TRUE(stated.says("there and back"));
  int all = 0;
  const int left = found_of(walk, stated.found, Side::left, all);
  EXPECT_EQ(left + found_of(walk, stated.found, Side::right, all), all);
}

TEST(MarkerEvents, ExchangedSidesAreSaidAndRightOnesAreNot) {
  auto markers = KnownWalk{}.body_markers(0.0003, 3);
  EXPECT_FALSE(tell(markers).says("the names of the sides are exchanged, or the recording is mirrored"));
  for (auto& name : markers.names)
    if (name != "SACR") name.front() = name.front() == 'L' ? 'R' : 'L';
  EXPECT_TRUE(tell(markers).says("the names of the sides are exchanged, or the recording is mirrored"));
}

TEST(MarkerEvents, OneFootAloneIsFound) {
  const KnownWalk walk;
  auto markers = walk.markers(0.0003, 3);
  markers.names = {"LHEE", "LTOE", "X1", "X2", "SACR"};
  const auto stated = tell(markers);
  int all = 0;
  EXPECT_EQ(found_of(walk, stated.found, Side::left, all), all);
  for (const auto& event : stated.found.events) EXPECT_EQ(event.side, Side::left);
}

TEST(MarkerEvents, SidesWithoutNamesAreThoseOfTheWay) {
  const KnownWalk walk;
  const auto known = walk.markers(0.0003, 3);
  // No names tell; a head makes the body tall.
  auto markers = data::Trajectories::all_missing({"m1", "m2", "m3", "m4", "m5", "m6", "m7"}, known.time);
  for (std::int64_t f = 0; f < known.frames(); ++f)
    for (std::int64_t m = 0; m < 7; ++m) {
      const Eigen::Vector3d pelvis = known.x(f, 4);
      markers.x(f, m) = m < 5 ? Eigen::Vector3d(known.x(f, (m + 2) % 5))
                              : Eigen::Vector3d(pelvis + Eigen::Vector3d(0.0, m == 5 ? 0.02 : -0.02, 0.7));
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto which = find_gait_markers(markers);
  ASSERT_TRUE(which) << which.error().message;
  EXPECT_FALSE(which->sides_known);
  const auto stated = tell(markers);
  for (const Side side : data::kBothSides) {
    int all = 0;
    EXPECT_GE(found_of(walk, stated.found, side, all), 7);
  }
}

TEST(MarkerEvents, SdsAreCommonAndOwn) {
  const auto found = tell(KnownWalk{}.markers(0.0003, 3)).found;
  ASSERT_EQ(found.events.size(), found.edges.size());
  ASSERT_EQ(found.events.size(), found.fused.size());
  for (std::size_t i = 0; i < found.events.size(); ++i) {
    EXPECT_NEAR(found.events[i].sd_s, found.fused[i].error.sd_s(), 1e-12);
    EXPECT_TRUE(found.fused[i].error.kind_s > 0.012 && found.fused[i].error.kind_s < 0.018);
  }
  EXPECT_EQ(sd_factor(GaitDirection::forward), 1.0);
  EXPECT_EQ(sd_factor(GaitDirection::unknown), 1.0);
  EXPECT_EQ(sd_factor(GaitDirection::sideways), 1.5);
}

// Slow with small steps: detectors contradict each other in all events alike, and what they differ by is the
// error of all.
TEST(MarkerEvents, AGaitThatNoneWasLearntFromHasTheSdOfWhatItsDetectorsDifferBy) {
  double worst = 0.0;
  for (const double stride_s : {2.4, 3.0}) {
    KnownWalk walk;
    walk.stride_s = stride_s, walk.speed_m_per_s = 0.5 / stride_s, walk.duration_s = 14.0;
    walk.stance = {0.78, 0.78};
    const auto found = tell(walk.markers(0.0003, 3)).found;
    ASSERT_GT(found.events.size(), 14u);
    double kind_s = 0.0;
    for (std::size_t i = 0; i < found.events.size(); ++i) {
      const auto& event = found.events[i];
      double error_s = INFINITY;
      for (const auto& truth : walk.events())
        if (const double later = event.time_s - truth.time_s;
            truth.side == event.side && truth.what == event.what && std::abs(later) < std::abs(error_s))
          error_s = later;
      if (event.time_s > 0.2 && event.time_s < walk.duration_s - 0.2)
        worst = std::max(worst, std::abs(error_s) / event.sd_s);
      kind_s = std::max(kind_s, found.fused[i].error.kind_s);
    }
    EXPECT_GT(kind_s, 0.03) << stride_s;
  }
  EXPECT_LT(worst, 4.0);
}

}  // namespace
}  // namespace kinemark::analysis
