// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/screening/internal/defects.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/stages/trajectory/screening/testing/walker.h"

namespace kinemark::trajectory::internal {
namespace {

using data::SampleState;

TEST(Defect, NamesItsMarkersAndKeepsTheRest) {
  const auto t = testing::walker();
  const auto swap = as_finding({.kind = FindingKind::label_swap,
                                .marker = 3,
                                .other_marker = 5,
                                .first_frame = 7,
                                .last_frame = 9,
                                .size = 0.25,
                                .confidence = 0.5,
                                .description = "they swap"},
                               t);
  EXPECT_EQ(swap.kind, FindingKind::label_swap);
  EXPECT_EQ(swap.subject, "M3");
  EXPECT_EQ(swap.partner, "M5");
  EXPECT_EQ(swap.first_frame, 7);
  EXPECT_EQ(swap.last_frame, 9);
  EXPECT_EQ(swap.size, 0.25);
  EXPECT_EQ(swap.confidence, 0.5);
  EXPECT_EQ(swap.description, "they swap");
  EXPECT_TRUE(swap.validate());
  const auto all = as_finding({.kind = FindingKind::duplicated_frame}, t);
  EXPECT_EQ(all.subject + all.partner, "") << "all markers";
}

TEST(Defect, TakesTheSamplesOfItsKind) {
  const auto whole = testing::walker();
  struct Case {
    FindingKind kind;
    std::int64_t marker, other, lost;
  };
  for (const auto& [kind, marker, other, lost] : {Case{FindingKind::spike, 2, -1, 3},
                                                  {FindingKind::swap_within, 2, 4, 3},
                                                  {FindingKind::label_swap, 2, 4, 6},
                                                  {FindingKind::duplicated_frame, -1, -1, 3 * 8},
                                                  {FindingKind::clock_jump, -1, -1, 0}}) {
    auto t = whole;
    reject({.kind = kind, .marker = marker, .other_marker = other, .first_frame = 10, .last_frame = 12}, t);
    EXPECT_EQ(t.count_missing(), lost) << to_string(kind);
    EXPECT_TRUE(t.validate());
    if (lost > 0) {
      EXPECT_EQ(t.state[t.index(11, 2)], SampleState::rejected);
      EXPECT_TRUE(t.present(9, 2) && t.present(13, 2)) << to_string(kind);
    }
  }
}

TEST(Defect, WhatWasMissingBeforeKeepsItsState) {
  auto t = testing::walker();
  t.set_missing(11, 2);
  reject({.kind = FindingKind::stuck, .marker = 2, .first_frame = 10, .last_frame = 12}, t);
  EXPECT_EQ(t.state[t.index(11, 2)], SampleState::missing);
  EXPECT_EQ(t.state[t.index(12, 2)], SampleState::rejected);
}

TEST(Words, OneFrameIsNoRange) {
  EXPECT_EQ(describe_frames({}, 7, 7), "frame 7");
  EXPECT_EQ(describe_frames({.first_number = 101}, 7, 9), "frames 108 to 110");
}

TEST(Confidence, GrowsWithTheRatioAndIsNeverCertain) {
  EXPECT_EQ(confidence_of(0.0, 5.0), 0.0);
  EXPECT_DOUBLE_EQ(confidence_of(5.0, 5.0), 0.5);
  EXPECT_DOUBLE_EQ(confidence_of(20.0, 5.0), 0.8);
  EXPECT_EQ(confidence_of(1e12, 5.0), 0.999);
  EXPECT_EQ(confidence_of(HUGE_VAL, 5.0), 0.999);
  double last = -1.0;
  for (double ratio = 0.0; ratio < 100.0; ratio += 0.5) {
    EXPECT_GT(confidence_of(ratio, 5.0), last) << ratio;
    last = confidence_of(ratio, 5.0);
  }
}

TEST(Median, IsTheUpperOneAndLeavesOutWhatIsNoNumber) {
  EXPECT_EQ(median_of({}), 0.0);
  EXPECT_EQ(median_of({3.0}), 3.0);
  EXPECT_EQ(median_of({4.0, 1.0}), 4.0);
  EXPECT_EQ(median_of({9.0, 1.0, 5.0}), 5.0);
  EXPECT_EQ(median_of({kNaN, 2.0, kNaN, 1.0, 3.0}), 2.0);
  EXPECT_EQ(median_of({kNaN}), 0.0);
}

TEST(Rounding, IsTheCoarsestOfTheAxes) {
  auto t = testing::walker({.noise_m = 0.001});
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    t.x(f, 1).x() = 1e-5 * std::round(t.x(f, 1).x() / 1e-5);
    t.x(f, 1).y() = 1e-4 * std::round(t.x(f, 1).y() / 1e-4);
  }
  EXPECT_NEAR(rounding_of(t, 1), 1e-4, 1e-6);
  EXPECT_LT(rounding_of(t, 2), 0.9 * rounding_of(t, 1)) << "another marker is not rounded";
  for (std::int64_t f = 0; f < t.frames(); ++f) t.set_missing(f, 3);
  EXPECT_GT(rounding_of(t, 3), 0.0) << "of a marker that is never seen";
}

}  // namespace
}  // namespace kinemark::trajectory::internal
