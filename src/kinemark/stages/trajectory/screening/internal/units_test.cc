// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Units that slip by a thousand: in time, of one marker, of the whole recording.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"
#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Trajectories;

void rescale(Trajectories& t, std::int64_t marker, std::int64_t first, std::int64_t last, double by) {
  for (std::int64_t f = first; f <= last; ++f) t.x(f, marker) *= by;
}

Defects slips_in(const Trajectories& t) {
  Defects out;
  find_unit_slips(t, out);
  for (const Defect& d : out) {
    EXPECT_EQ(d.kind, FindingKind::unit_slip);
    EXPECT_TRUE(as_finding(d, t).validate()) << d.description;
  }
  return out;
}

/// Exactly one slip, with those frames and that factor.
void expect_one(const Trajectories& t, std::int64_t marker, std::int64_t first, std::int64_t last,
                double size) {
  const Defects found = slips_in(t);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].marker, marker);
  EXPECT_EQ(found[0].first_frame, first);
  EXPECT_EQ(found[0].last_frame, last);
  EXPECT_EQ(found[0].size, size);
}

TEST(UnitSlips, AStretchOfAnyMarkerInEitherDirection) {
  Random random(8, 2);
  for (std::int64_t m = 1; m < 8; ++m)
    for (const double factor : {1000.0, 0.001}) {
      Trajectories t = testing::walker({.frames = 200});
      const auto first = static_cast<std::int64_t>(random.uniform(1.0, 150.0));
      const auto last = first + static_cast<std::int64_t>(random.uniform(0.0, 48.0));
      rescale(t, m, first, last, factor);
      expect_one(t, m, first, last, factor);
    }
}

TEST(UnitSlips, MostOfTheMarkerIsRightWhereverItLies) {
  // The wrong part comes first, last, or twice.
  Trajectories start = testing::walker({.frames = 200}), end = start, twice = start;
  rescale(start, 3, 0, 49, 1000.0);
  expect_one(start, 3, 0, 49, 1000.0);
  rescale(end, 3, 120, 199, 0.001);
  expect_one(end, 3, 120, 199, 0.001);
  rescale(twice, 3, 20, 39, 1000.0);
  rescale(twice, 3, 100, 149, 0.001);
  const Defects found = slips_in(twice);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].first_frame, 20);
  EXPECT_EQ(found[0].last_frame, 39);
  EXPECT_EQ(found[0].size, 1000.0);
  EXPECT_EQ(found[1].first_frame, 100);
  EXPECT_EQ(found[1].last_frame, 149);
  EXPECT_EQ(found[1].size, 0.001);
}

TEST(UnitSlips, ASlipAcrossAGapBeginsWhereTheMarkerIsSeenAgain) {
  Trajectories t = testing::walker({.frames = 200});
  rescale(t, 2, 150, 199, 1000.0);
  for (std::int64_t f = 146; f < 150; ++f) t.set_missing(f, 2);
  expect_one(t, 2, 150, 199, 1000.0);
}

/// A walk with marker 3 at the origin in frame 50, where it makes 9 mm a frame.
Trajectories through_the_origin() {
  Trajectories t = testing::walker({.frames = 200});
  const Eigen::Vector3d there = testing::position(3, 0.5);
  for (std::int64_t f = 0; f < 200; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m) -= there;
  return t;
}

TEST(UnitSlips, NearTheOriginStepsTellWhereASlipBegins) {
  const Trajectories right = through_the_origin();
  for (std::int64_t begin = 45; begin <= 56; ++begin) {
    if (begin == 50 || begin == 51) continue;  // a sample beside the slip is at the origin itself
    for (const double factor : {1000.0, 0.001}) {
      Trajectories first = right, last = right;
      rescale(first, 3, begin, begin + 60, factor);
      expect_one(first, 3, begin, begin + 60, factor);
      rescale(last, 3, begin - 40, begin - 1, factor);
      expect_one(last, 3, begin - 40, begin - 1, factor);
    }
  }
}

TEST(UnitSlips, WhereOneEndIsNotFoundNoOtherFramesAreNamed) {
  // A sample beside the slip is at the origin itself, the same in any unit.
  for (const double factor : {1000.0, 0.001}) {
    for (const std::int64_t length : {20, 60}) {  // less than half of the recording
      for (const std::int64_t begin : {50, 51}) {
        Trajectories t = through_the_origin();
        t.x(50, 3).setZero();
        rescale(t, 3, begin, begin + length, factor);
        for (const Defect& found : slips_in(t)) {
          EXPECT_LE(std::abs(found.first_frame - begin), 1) << factor << " " << length;
          EXPECT_EQ(found.last_frame, begin + length);
        }
      }
    }
  }
}

TEST(UnitSlips, NearTheOriginAJumpIsNoSlip) {
  // A spike, a visit of another marker's path, a return after a gap: not another unit.
  for (const double away : {0.05, 0.3, 1.0, 3.0, 8.0}) {
    Trajectories spike = through_the_origin(), visit = spike, moved = spike;
    spike.x(51, 3).y() += away;
    EXPECT_TRUE(slips_in(spike).empty()) << away;
    for (std::int64_t f = 52; f < 90; ++f) visit.x(f, 3) = visit.x(f, 6);
    EXPECT_TRUE(slips_in(visit).empty());
    for (std::int64_t f = 51; f < 200; ++f) moved.x(f, 3).x() += away;
    EXPECT_TRUE(slips_in(moved).empty()) << away;
  }
}

TEST(UnitSlips, AStretchOfAllMarkersIsOneSlipOfTheRecording) {
  Trajectories t = testing::walker({.frames = 200});
  for (std::int64_t m = 0; m < t.markers(); ++m) rescale(t, m, 150, 180, 1000.0);
  expect_one(t, -1, 150, 180, 1000.0);
  // A marker that is not seen there does not speak against it, one that is seen does.
  Trajectories unseen = t;
  for (std::int64_t f = 140; f < 199; ++f) unseen.set_missing(f, 4);
  EXPECT_EQ(std::ranges::count(slips_in(unseen), std::int64_t{-1}, &Defect::marker), 1);
  Trajectories right = t;
  rescale(right, 4, 150, 180, 0.001);
  const Defects found = slips_in(right);
  EXPECT_EQ(found.size(), 7U);
  EXPECT_EQ(std::ranges::count(found, std::int64_t{-1}, &Defect::marker), 0);
  EXPECT_EQ(std::ranges::count(found, std::int64_t{4}, &Defect::marker), 0);
}

TEST(UnitSlips, AMarkerInAnotherUnitThroughoutGoesAlongOnceScaled) {
  for (const double factor : {1000.0, 0.001}) {
    Trajectories t = testing::walker({.frames = 200});
    rescale(t, 5, 0, 199, factor);
    expect_one(t, 5, 0, 199, factor);
  }
}

TEST(UnitSlips, AnotherFactorIsNoUnit) {
  // Inches and feet are not what is looked for: 25.4 and 304.8 stay out of reach of a thousand.
  for (const double factor : {2.0, 10.0, 25.4, 304.8, 3500.0, 1e6}) {
    Trajectories t = testing::walker({.frames = 200});
    rescale(t, 5, 0, 199, factor);
    EXPECT_TRUE(slips_in(t).empty()) << factor;
  }
}

TEST(UnitSlips, AMarkerThatGoesAlongWithNobodyMayBeAnything) {
  Trajectories t = testing::walker({.frames = 200});
  Random random(2, 2);
  for (std::int64_t f = 0; f < 200; ++f)
    for (int axis = 0; axis < 3; ++axis) t.x(f, 5)(axis) = 1000.0 + 100.0 * random.gaussian();
  EXPECT_TRUE(slips_in(t).empty()) << "a force, say";
}

TEST(UnitSlips, OfFewMarkersNoneIsTheOddOne) {
  Trajectories t = testing::walker({.markers = 3, .frames = 200});
  rescale(t, 2, 0, 199, 1000.0);
  EXPECT_TRUE(slips_in(t).empty()) << "which of them would be right?";
}

TEST(UnitSlips, TheWholeRecordingIsJudgedByItsDistance) {
  const Trajectories metres = testing::walker({.frames = 100});
  for (const double factor : {1000.0, 0.0005, 100.0, 0.01}) {
    Trajectories t = metres;
    for (double& x : t.x_in_world) x *= factor;
    double nearest = 1e300, farthest = 0.0;
    for (std::int64_t f = 0; f < t.frames(); ++f)
      for (std::int64_t m = 0; m < t.markers(); ++m) {
        nearest = std::min(nearest, t.x(f, m).norm());
        farthest = std::max(farthest, t.x(f, m).norm());
      }
    const Defects found = slips_in(t);
    if (nearest > 200.0 || farthest < 0.002) {
      ASSERT_EQ(found.size(), 1U) << factor;
      EXPECT_EQ(found[0].marker, -1);
      EXPECT_EQ(found[0].last_frame, 99);
    } else {
      EXPECT_TRUE(farthest < 200.0 && nearest > 0.002) << "the case tells nothing";
      EXPECT_TRUE(found.empty()) << factor;
    }
  }
}

TEST(UnitSlips, AMarkerAtTheOriginOrNeverSeenIsNoSlip) {
  Trajectories t = testing::walker({.frames = 100});
  for (std::int64_t f = 0; f < 100; ++f) {
    t.x(f, 1).setZero();
    t.set_missing(f, 2);
  }
  EXPECT_TRUE(slips_in(t).empty());
  for (std::int64_t f = 0; f < 100; ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) t.x(f, m).setZero();
  EXPECT_TRUE(slips_in(t).empty());
  EXPECT_TRUE(slips_in(testing::walker({.frames = 0})).empty());
  EXPECT_TRUE(slips_in(testing::walker({.frames = 1})).empty());
}

TEST(UnitSlips, WhatWasFoundBeforeIsKept) {
  Trajectories t = testing::walker({.frames = 100});
  rescale(t, 3, 40, 50, 1000.0);
  Defects out{{.kind = FindingKind::zero, .marker = 1}};
  find_unit_slips(t, out);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0].kind, FindingKind::zero);
  EXPECT_EQ(out[1].kind, FindingKind::unit_slip);
}

}  // namespace
}  // namespace kinemark::trajectory::internal
